#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""ThreadSanitizer finds races that are planted in a callback and in a batch, and none where a mutex is."""
import os
import subprocess
import unittest

import roslib.packages
import rostest

REPORTED = 66  # what a program returns of which ThreadSanitizer had something to say


class PlantedRace(unittest.TestCase):
    def run_program(self, *arguments):
        """Its return code and what it printed, with the options that all tests have."""
        program = roslib.packages.find_node('box_query', 'box_query_planted_race')[0]
        options = os.environ.get('TSAN_OPTIONS', '') + ':log_path=stderr'
        done = subprocess.run([program] + list(arguments), env=dict(os.environ, TSAN_OPTIONS=options), timeout=60,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        return done.returncode, done.stdout

    def expect_found(self, where):
        code, output = self.run_program(where)
        self.assertEqual(code, REPORTED, output)
        self.assertRegex(output, r'SUMMARY: ThreadSanitizer: data race \S*planted_race\.cpp:\d+ in .*count')
        self.assertEqual(output.count('SUMMARY'), 1, output)

    def expect_silence(self, where):
        code, output = self.run_program(where, 'guarded')
        self.assertEqual(code, 0, output)
        self.assertNotIn('ThreadSanitizer', output)

    def test_is_found_in_a_callback(self):
        self.expect_found('callback')

    def test_is_found_in_a_batch(self):
        self.expect_found('batch')

    def test_a_mutex_in_a_callback_is_seen(self):
        self.expect_silence('callback')

    def test_a_mutex_in_a_batch_is_seen(self):
        self.expect_silence('batch')


if __name__ == '__main__':
    rostest.rosrun('box_query', 'test_planted_race', PlantedRace)
