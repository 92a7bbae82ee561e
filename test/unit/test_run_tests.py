#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What test/run counts."""
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..'))
import run_tests  # noqa: E402
from run_tests import FAILED, PASSED, SKIPPED, Test  # noqa: E402

GTEST = '''<?xml version="1.0" encoding="UTF-8"?>
<testsuites tests="5" failures="1" disabled="1" errors="0" time="0.5" name="AllTests">
  <testsuite name="Box" tests="5" failures="1" disabled="1" skipped="1" errors="0" time="0.5">
    <testcase name="Good" status="run" result="completed" time="0.25" classname="Box" />
    <testcase name="Bad" status="run" result="completed" time="0." classname="Box">
      <failure message="box.cpp:7&#x0A;1 is not 2" type=""><![CDATA[box.cpp:7
1 is not 2]]></failure>
    </testcase>
    <testcase name="NotHere" status="run" result="skipped" time="0." classname="Box">
      <skipped message="box.cpp:9&#x0A;no data"><![CDATA[box.cpp:9
no data]]></skipped>
    </testcase>
    <testcase name="NotHereEither" status="run" result="skipped" time="0." classname="Box" />
    <testcase name="DISABLED_Off" status="notrun" result="suppressed" time="0." classname="Box" />
  </testsuite>
</testsuites>'''

PYTHON = '''<?xml version="1.0" encoding="utf-8"?>
<testsuite errors="1" failures="0" name="node" tests="2" time="1.5">
  <testcase classname="node.Node" name="test_up" time="1.0"></testcase>
  <testcase classname="node.Node" name="test_down" time="0.5"><error type="KeyError">trace</error></testcase>
  <system-out><![CDATA[]]></system-out>
</testsuite>'''

ROSTEST = '''<?xml version="1.0" encoding="utf-8"?>
<testsuite errors="0" failures="%d" name="outer" tests="1" time="2">
  <testcase classname="rostest.runner.RosTest" name="testnode" time="2">%s</testcase>
</testsuite>'''


class RunTests(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def write(self, name, text):
        path = os.path.join(self.folder.name, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, 'w') as file:
            file.write(text)

    def cases(self):
        return run_tests.read_results(self.folder.name)

    def run_command(self, kind, *command, limit=30.0):
        """What the runner says of a command: it is python code with the result folder as its argument."""
        test = Test('a_test', kind, limit, [], [sys.executable, '-c'] + list(command))
        return run_tests.run(test, os.path.join(self.folder.name, 'of a_test'), dict(os.environ), False)

    def test_reads_every_outcome_of_gtest(self):
        self.write('gtest.xml', GTEST)
        self.assertEqual([(case.name, case.outcome, case.seconds, case.text) for case in self.cases()],
                         [('Box.Good', PASSED, 0.25, ''),
                          ('Box.Bad', FAILED, 0.0, 'box.cpp:7\n1 is not 2'),
                          ('Box.NotHere', SKIPPED, 0.0, 'box.cpp:9\nno data'),
                          ('Box.NotHereEither', SKIPPED, 0.0, ''),
                          ('Box.DISABLED_Off', SKIPPED, 0.0, 'disabled in its source')])

    def test_counts_each_case_of_a_rostest_once(self):
        self.write('box_query/rosunit-node.xml', PYTHON)
        self.write('box_query/rostest-node.xml', ROSTEST % (0, ''))
        self.assertEqual(run_tests.closing_line(self.cases()), '1 passed, 1 failed')

    def test_a_rostest_without_results_has_failed(self):
        self.write('box_query/rostest-node.xml', ROSTEST % (1, '<failure>no test results</failure>'))
        self.assertEqual([(case.outcome, case.text) for case in self.cases()], [(FAILED, 'no test results')])

    def test_a_result_file_that_is_cut_off_has_failed(self):
        self.write('gtest.xml', GTEST[:300])
        self.assertEqual([case.outcome for case in self.cases()], [FAILED])

    def test_closing_line_names_skipped_only_if_there_are_any(self):
        self.write('gtest.xml', GTEST)
        self.assertEqual(run_tests.closing_line(self.cases()), '1 passed, 1 failed, 3 skipped')
        self.assertEqual(run_tests.closing_line([]), '0 passed, 0 failed')

    def test_a_skip_that_is_not_expected_has_failed(self):
        self.write('gtest.xml', GTEST)
        outcomes = [case.outcome for case in run_tests.without_unexpected_skips(self.cases(), 'no data|Off')]
        self.assertEqual(outcomes, [PASSED, FAILED, SKIPPED, FAILED, SKIPPED])

    def test_stale_results_do_not_count(self):
        self.write('of a_test/gtest.xml', GTEST)
        cases = self.run_command('gtest', 'pass')
        self.assertEqual([case.outcome for case in cases], [FAILED])
        self.assertIn('ran no test case', cases[0].text)

    def test_a_crash_has_failed_and_shows_the_last_lines(self):
        cases = self.run_command('gtest', 'import os; print("about to", flush=True); os.abort()')
        self.assertEqual([case.outcome for case in cases], [FAILED])
        self.assertIn('SIGABRT', cases[0].text)
        self.assertIn('about to', cases[0].text)

    def test_a_crash_after_good_results_has_failed(self):
        code = 'import sys, os; open(sys.argv[1][19:], "w").write(%r); os.abort()' % PYTHON.replace('error', 'passed')
        cases = self.run_command('gtest', code)
        self.assertEqual([case.outcome for case in cases], [PASSED, PASSED, FAILED])

    def test_a_test_that_does_not_end_is_ended_with_all_its_processes(self):
        code = ('import subprocess, signal, time; signal.signal(signal.SIGINT, signal.SIG_IGN);'
                'child = subprocess.Popen(["sleep", "1000"], start_new_session=True);'
                'print(child.pid, flush=True); child.wait()')
        run_tests.become_subreaper()
        run_tests.GRACE = 0.5
        cases = self.run_command('gtest', code, limit=2.0)
        self.assertEqual([case.outcome for case in cases], [FAILED])
        self.assertIn('time limit', cases[0].text)
        pid = cases[0].text.splitlines()[-1]
        self.assertFalse(os.path.exists('/proc/' + pid), pid)

    def test_as_many_tests_run_at_once_as_there_are_jobs(self):
        wait_for_the_other = ('import os, sys, time\n'
                              'open(sys.argv[1], "w").close()\n'
                              'while not os.path.exists(sys.argv[2]):\n'
                              '    time.sleep(0.01)')
        tests = [Test(own, 'script', 20.0, [], [sys.executable, '-c', wait_for_the_other] +
                      [os.path.join(self.folder.name, name) for name in (own, other)])
                 for own, other in (('first', 'second'), ('second', 'first'))]
        results = list(run_tests.run_all(tests, self.folder.name + '/results', dict(os.environ), False, 2))
        self.assertEqual([(test.name, case.outcome) for test, cases in results for case in cases],
                         [('first', PASSED), ('second', PASSED)])

    def test_what_runs_under_a_command_is_given_to_it(self):
        tests = [Test('one', kind, 3.0, [], ['program', 'argument']) for kind in ('gtest', 'rostest', 'script')]
        self.assertEqual(run_tests.under('tool --option', tests),
                         [Test('one', 'gtest', 30.0, [], ['tool', '--option', 'program', 'argument'])])

    def test_a_script_is_one_case(self):
        self.assertEqual([case.outcome for case in self.run_command('script', 'pass')], [PASSED])
        self.assertEqual([case.outcome for case in self.run_command('script', 'exit(3)')], [FAILED])
        skipped = self.run_command('script', 'print("first"); print("no such tool"); exit(77)')
        self.assertEqual([(case.outcome, case.text) for case in skipped], [(SKIPPED, 'no such tool')])

    def test_a_report_of_a_sanitizer_has_failed(self):
        code = 'import os; open(os.environ["ASAN_OPTIONS"][9:] + ".123", "w").write("leak")'
        self.assertEqual([case.outcome for case in self.run_command('script', code)], [PASSED, FAILED])

    def test_a_bad_end_after_skips_has_failed(self):
        code = 'import sys; open(sys.argv[1][19:], "w").write(%r); exit(1)' % (
            '<testsuite><testcase name="a" result="skipped"/></testsuite>')
        self.assertEqual([case.outcome for case in self.run_command('gtest', code)], [SKIPPED, FAILED])

    def test_only_what_is_named_is_built(self):
        self.write('tests.txt', 'test_a\tgtest\t300\tp_test_a\t/bin/a\n'
                                'test_b\trostest\t300\tall p_test_b\t/b.test\n'
                                'lint\tscript\t9\tall tests\t/bin/lint\t--strict\n')
        tests = run_tests.read_list(os.path.join(self.folder.name, 'tests.txt'))
        self.assertEqual(tests[2], Test('lint', 'script', 9.0, ['all', 'tests'], ['/bin/lint', '--strict']))
        self.assertEqual(run_tests.targets_of(tests[:2]), ['all', 'p_test_a', 'p_test_b'])
        self.assertEqual(run_tests.targets_of(tests[:1]), ['p_test_a'])

    def test_tests_are_chosen_by_name_and_left_out_by_expression(self):
        def names(*arguments):
            return [test.name for test in run_tests.chosen(tests, *arguments)]

        tests = [Test(name, 'gtest', 9.0, [], []) for name in ('test_a', 'test_ab', 'test_b')]
        self.assertEqual(names([], None), ['test_a', 'test_ab', 'test_b'])
        self.assertEqual(names(['a'], None), ['test_a', 'test_ab'])
        self.assertEqual(names([], 'b$'), ['test_a'])
        self.assertEqual(names(['a'], 'b$'), ['test_a'])
        self.assertRaisesRegex(ValueError, 'like c; there are test_a', names, ['a', 'c'], None)
        self.assertRaisesRegex(ValueError, 'matches c; there are test_a', names, [], 'c')

    def refusal(self, *arguments):
        """What test/run says of arguments that it refuses before it does anything."""
        run = os.path.join(os.path.dirname(run_tests.__file__), 'run')
        done = subprocess.run([run] + list(arguments), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              universal_newlines=True, timeout=60)
        self.assertEqual(done.returncode, 2, done.stdout)
        return done.stdout

    def test_unknown_options_are_refused_before_anything_is_built(self):
        self.assertEqual(self.refusal('--bogus'), 'test/run knows no option --bogus; see test/run --help\n')
        self.assertIn('--bogus', self.refusal('--yes', 'sanitize', '--verbose', '--bogus'))
        self.assertIn('regular expression', self.refusal('--allow-skips'))
        self.assertIn('a number', self.refusal('--jobs', 'many'))
        self.assertIn('no benchmark bogus', self.refusal('benchmark', 'bogus'))


if __name__ == '__main__':
    unittest.main()
