#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the tests that CMake has listed, a few at a time, and counts their cases from the result files.

Called by test/run, in the environment of the built package.
"""
import argparse
import ctypes
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree
from collections import namedtuple
from concurrent.futures import ProcessPoolExecutor
from functools import partial

PASSED, FAILED, SKIPPED = 'passed', 'failed', 'skipped'
SKIP_CODE = 77  # what a script returns if it cannot be run here; its last line says why
GRACE = 15.0    # [s] from a time limit's SIGINT to SIGKILL

Test = namedtuple('Test', 'name kind time_limit targets command')
Case = namedtuple('Case', 'name outcome seconds text')


def read_list(path):
    """The tests of a file that CMake has written: name, kind, time limit, targets and command, separated by tabs."""
    with open(path) as lines:
        rows = [line.rstrip('\n').split('\t') for line in lines]
    return [Test(row[0], row[1], float(row[2]), row[3].split(), row[4:]) for row in rows]


def read_case(element):
    """A <testcase> of a result file, in the dialects of gtest and of Python's unittest under ROS."""
    def texts(tag):
        return [(found.text or '').strip() or found.get('message', '') for found in element.iter(tag)]

    name = '.'.join(filter(None, (element.get('classname'), element.get('name'))))
    seconds = float(element.get('time') or 0)
    failures = texts('failure') + texts('error')
    if failures:
        return Case(name, FAILED, seconds, '\n'.join(failures))
    if element.get('status') == 'notrun':
        return Case(name, SKIPPED, seconds, 'disabled in its source')
    if element.get('result') == 'skipped' or element.find('skipped') is not None:
        return Case(name, SKIPPED, seconds, '\n'.join(texts('skipped')))
    return Case(name, PASSED, seconds, '')


def read_results(folder):
    """The cases of all result files of one test.

    rostest writes a case of its own about each test that it has run; such a one counts only if it failed, as it
    does if the test left no result file.
    """
    cases = []
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name)
        if os.path.isdir(path):
            cases += read_results(path)
        elif name.endswith('.xml'):
            try:
                found = [read_case(element) for element in ElementTree.parse(path).iter('testcase')]
            except ElementTree.ParseError as error:
                found = [Case(name, FAILED, 0, '%s cannot be read: %s' % (path, error))]
            if name.startswith('rostest-'):
                found = [case for case in found if case.outcome == FAILED]
            cases += found
    return cases


def chosen(tests, names, left_out):
    """Tests whose name contains one of the names, if there are any, and does not match the expression, if there is one.

    A name or an expression that is that of no test is an error.
    """
    known = ' '.join(test.name for test in tests)
    for name in names:
        if name not in known:
            raise ValueError('no test is named like %s; there are %s' % (name, known))
    if left_out and not any(re.search(left_out, test.name) for test in tests):
        raise ValueError('no test matches %s; there are %s' % (left_out, known))
    return [test for test in tests if (not names or any(name in test.name for name in names)) and
            not (left_out and re.search(left_out, test.name))]


def under(command, tests):
    """The gtests of them, run as arguments of a command, which slows them down."""
    return [test._replace(command=command.split() + test.command, time_limit=10 * test.time_limit)
            for test in tests if test.kind == 'gtest']


def targets_of(tests):
    """What is built for these tests, each once."""
    return sorted({target for test in tests for target in test.targets})


def command_of(test, folder):
    if test.kind == 'gtest':
        return test.command + ['--gtest_output=xml:' + os.path.join(folder, 'gtest.xml')]
    if test.kind == 'rostest':
        package = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
        return ['rostest', '--pkgdir=' + package, '--package=box_query', '--results-filename=' + test.name,
                '--results-base-dir=' + folder] + test.command
    return test.command


def become_subreaper():
    """Lets this process inherit what a test leaves behind."""
    ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)  # PR_SET_CHILD_SUBREAPER


def children():
    """Process ids of the living children of this process."""
    found = []
    for pid in filter(str.isdigit, os.listdir('/proc')):
        try:
            with open('/proc/%s/stat' % pid) as file:
                parent = file.read().rpartition(')')[2].split()[1]
        except OSError:
            continue  # it has ended since
        if int(parent) == os.getpid():
            found.append(int(pid))
    return found


def kill_children():
    """Ends everything that a test has left behind, in a subreaper."""
    while True:
        left = children()
        if not left:
            return
        for pid in left:
            os.kill(pid, signal.SIGKILL)
            os.waitpid(pid, 0)


def execute(test, folder, environment, verbose):
    """Runs the program of a test: its return code (None: out of time) and what it printed."""
    output = os.path.join(folder, 'output.txt')
    with open(output, 'wb') as file:
        process = subprocess.Popen(command_of(test, folder), stdin=subprocess.DEVNULL, stdout=file,
                                   stderr=subprocess.STDOUT, env=environment, cwd=folder, start_new_session=True)
        code = None
        try:
            code = process.wait(test.time_limit)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGINT)  # rostest ends its nodes then
            try:
                process.wait(GRACE)
            except subprocess.TimeoutExpired:
                pass
        finally:
            kill_children()
            process.poll()
    with open(output, errors='replace') as file:
        text = file.read()
    if verbose:
        print(text)
    return code, text


def reports(folder):
    """What the sanitizers have written in any process of the test."""
    text = ''
    for name in sorted(os.listdir(folder)):
        if name.startswith('sanitizer.'):
            with open(os.path.join(folder, name), errors='replace') as file:
                text += file.read()
    return text


def run(test, folder, environment, verbose):
    """The cases of one test. At least one: a test that ran none has failed. In a subreaper that runs no other."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    log = os.path.join(folder, 'sanitizer')
    # ROS is not built with ThreadSanitizer, which would take its accesses for races where it cannot see its locks.
    environment = dict(environment, ROS_HOME=os.path.join(folder, 'ros_home'),
                       ASAN_OPTIONS='log_path=' + log, UBSAN_OPTIONS='print_stacktrace=1:log_path=' + log,
                       TSAN_OPTIONS='ignore_noninstrumented_modules=1:log_path=' + log)
    start = time.monotonic()
    code, output = execute(test, folder, environment, verbose)
    seconds = time.monotonic() - start
    last_lines = '\n'.join(output.splitlines()[-40:])

    if test.kind == 'script' and code == SKIP_CODE:
        cases = [Case(test.name, SKIPPED, seconds, (output.splitlines() or [''])[-1])]
    elif test.kind == 'script' and code == 0:
        cases = [Case(test.name, PASSED, seconds, '')]
    else:
        cases = read_results(folder)
    good_codes = (0, SKIP_CODE) if test.kind == 'script' else (0,)
    problem = None
    if code is None:
        problem = 'not finished after its time limit of %g s' % test.time_limit
    elif code < 0:
        problem = 'ended by signal %d (%s)' % (-code, signal.Signals(-code).name)
    elif code not in good_codes and not any(case.outcome == FAILED for case in cases):
        problem = 'returned %d' % code
    elif not cases:
        problem = 'ran no test case'
    if problem:
        cases.append(Case(test.name, FAILED, seconds, problem + '; its last lines:\n' + last_lines))
    report = reports(folder)
    if report:
        cases.append(Case(test.name + ' (sanitizer)', FAILED, seconds, report))
    return cases


def run_all(tests, folder, environment, verbose, jobs):
    """Pairs of test and cases in the order of the tests, of which `jobs` run at once, each in its folder."""
    with ProcessPoolExecutor(jobs, initializer=become_subreaper) as pool:
        yield from zip(tests, pool.map(partial(run, environment=environment, verbose=verbose), tests,
                                       [os.path.join(folder, test.name) for test in tests]))


def without_unexpected_skips(cases, allowed):
    """The same cases, failed where one was skipped with a name and text that do not match `allowed`."""
    return [case._replace(outcome=FAILED, text='must not be skipped here: ' + case.text)
            if case.outcome == SKIPPED and not re.search(allowed, case.name + ' ' + case.text) else case
            for case in cases]


def closing_line(cases):
    """N passed, N failed[, N skipped]"""
    count = {outcome: sum(case.outcome == outcome for case in cases) for outcome in (PASSED, FAILED, SKIPPED)}
    line = '%d passed, %d failed' % (count[PASSED], count[FAILED])
    return line + (', %d skipped' % count[SKIPPED] if count[SKIPPED] else '')


def main():
    parser = argparse.ArgumentParser(prog='test/run')
    parser.add_argument('--build-dir', required=True)
    parser.add_argument('--verbose', action='store_true', help='print also what the tests print')
    parser.add_argument('--jobs', type=int, default=len(os.sched_getaffinity(0)), metavar='N', help='tests that run at once')
    parser.add_argument('--allow-skips', default='', metavar='REGEX',
                        help='a skip counts as failed unless this matches its name and reason')
    parser.add_argument('--leave-out', metavar='REGEX', help='not the tests whose name it matches')
    parser.add_argument('--without-scripts', action='store_true', help='only programs that were built here')
    parser.add_argument('--under', metavar='COMMAND', help='only gtests, each as arguments of this command')
    parser.add_argument('--targets', action='store_true', help='print what is to be built for these tests; run none')
    parser.add_argument('names', nargs='*', metavar='NAME', help='only tests whose name contains NAME')
    arguments = parser.parse_args()
    tests = [test for test in read_list(os.path.join(arguments.build_dir, 'tests.txt'))
             if test.kind != 'script' or not arguments.without_scripts]
    if arguments.under:
        tests = under(arguments.under, tests)
    try:
        tests = chosen(tests, arguments.names, arguments.leave_out)
    except ValueError as error:
        parser.error(str(error))
    if arguments.targets:
        print('\n'.join(targets_of(tests)))
        return 0

    environment = {key: value for key, value in os.environ.items()
                   if key not in ('ROS_HOSTNAME', 'ROS_NAMESPACE', 'ROS_LOG_DIR', 'ROS_MASTER_URI')}
    # rostest starts a master of its own, on a free port.
    environment['ROS_IP'] = '127.0.0.1'
    cases = []
    with tempfile.TemporaryDirectory() as temporary:
        # rostest splits the path of its results at a space, which the build directory's may have.
        build_dir = os.path.join(temporary, 'build')
        os.symlink(os.path.abspath(arguments.build_dir), build_dir)
        results_dir = os.path.join(build_dir, 'test_results')
        for test, results in run_all(tests, results_dir, environment, arguments.verbose, arguments.jobs):
            for case in without_unexpected_skips(results, arguments.allow_skips):
                label = case.name if test.name in case.name else test.name + ' ' + case.name
                print('%-7s %8.2f s  %s' % (case.outcome, case.seconds, label))
                for line in case.text.splitlines():
                    print('        ' + line)
                sys.stdout.flush()
                cases.append(case)
    print(closing_line(cases))
    outcomes = {case.outcome for case in cases}
    return 0 if PASSED in outcomes and FAILED not in outcomes else 1


if __name__ == '__main__':
    sys.exit(main())
