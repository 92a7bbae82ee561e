# SPDX-License-Identifier: BSD-3-Clause
"""The node and the master end, and come again."""
import os
import signal
import time

import rospy

from world import NODE, check


def fault_master_restarted(world, report):
    """The master is killed and comes again."""
    world.launch('fixed_frame:=map', 'box_topics:=[{topic: boxes, timeout: 0.5}, {topic: carts, required: false}]')
    parameters = rospy.get_param(NODE)
    streaming = world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 1, 2)
    world.until(lambda: world.answers(4, 2), 'boxes')
    report.begin()

    world.master.kill()
    world.master.wait()
    check(world.scene() is None, 'a new client is answered without a master')
    back = world.start_master()
    report.right_again(back, 4, 2, "the master's return")
    check(rospy.get_param(NODE) == parameters, 'parameters are', rospy.get_param(NODE), 'and were', parameters)
    world.speak('boxes', 'carts', 'MarkerArray', 'map', 2, 3)
    world.until(lambda: world.answers(2, 3), 'the boxes of a new publisher, beside one that streams on')
    streaming.end()
    report.during(world.await_reason('/boxes is stale'))
    back = world.speak('boxes', 'boxes', 'Marker', 'map', 1, 7)
    report.right_again(back.since, 1, 2, "a publisher's return to the new master")
