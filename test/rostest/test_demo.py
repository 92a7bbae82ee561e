#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The demo's questions are answered as expected, and it notices if they are not."""
import os
import sys
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'launch'))
import ask_demo  # noqa: E402


class Demo(unittest.TestCase):
    def test_every_answer_is_as_expected(self):
        ask = ask_demo.Services()
        self.assertEqual(ask.wait_until_complete(), '')
        table = ask_demo.ask_all(ask)
        self.assertEqual([row for row in table.rows if row[3] != 'as expected'], [])
        self.assertEqual((len(table.rows), table.wrong), (10, 0))

    def test_another_answer_is_wrong(self):
        ask = ask_demo.Services()
        table = ask_demo.Table()
        table.add('?', ask.get_scene(), '', '', (1.0000000000000002, 1.0))
        self.assertEqual(table.wrong, 1)


if __name__ == '__main__':
    rospy.init_node('test_demo')
    rostest.rosrun('box_query', 'test_demo', Demo)
