# SPDX-License-Identifier: BSD-3-Clause
"""Transforms and /clock end, and come again."""
import time

import rospy


def fault_tf_publisher_killed(world, report):
    """What publishes the transform that boxes need is killed and comes again."""
    world.start_node(box_topics=[{'topic': 'boxes', 'timeout': 1.0}], transform_history=2.0)
    tf = world.speak('tf', 'map', 'cart', 3)
    world.speak('boxes', 'boxes', 'MarkerArray', 'cart', 4, 1, 2)
    world.until(lambda: world.answers(7, 2), 'boxes of a frame that moves')
    report.begin()
    tf.end()
    time.sleep(0.5)  # boxes always wait a little for the transform that is later than they
    report.during(world.await_reason('/boxes', "transform from frame 'cart'"))
    report.stays(7, 2, 'incomplete, with the boxes where they were', complete=False)
    tf = world.speak('tf', 'map', 'cart', 5)
    report.right_again(tf.since, 9, 2, 'it spoke')


def simulated(world):
    """A node on simulated time, that has heard boxes: what publishes the clock."""
    rospy.set_param('/use_sim_time', True)
    clock = world.speak('clock', 1000)
    world.start_node(box_topics=[{'topic': 'boxes', 'timeout': 1.0}])
    world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 1, 2)
    world.until(lambda: world.answers(4, 2), 'boxes')
    return clock


def fault_clock_killed(world, report):
    """What publishes /clock is killed and comes again."""
    clock = simulated(world)
    report.begin()
    clock.end()
    report.during(world.await_reason('Nobody publishes /clock any more'))
    clock = world.speak('clock', 1020)
    report.right_again(clock.since, 4, 2, 'it spoke')


def jumps(world, report, seconds, *words):
    """The clock jumps while nobody speaks, then somebody does."""
    rospy.set_param('/use_sim_time', True)
    clock = world.speak('clock', 1000)
    world.start_node(box_topics=[{'topic': 'boxes', 'timeout': 20.0}])
    boxes = world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 1, 2)
    world.until(lambda: world.answers(4, 2), 'boxes')
    boxes.end()
    report.begin()
    clock.end()
    world.speak('clock', seconds)
    report.during(world.await_reason(*words))
    boxes = world.speak('boxes', 'boxes', 'MarkerArray', 'map', 2, 3)
    report.right_again(boxes.since, 2, 1, 'boxes came')


def fault_clock_jumps_back(world, report):
    """/clock jumps back, as for a bag that starts again."""
    jumps(world, report, 100, 'No boxes have come on topic /boxes')


def fault_clock_jumps_ahead(world, report):
    """/clock jumps ahead."""
    jumps(world, report, 5000, 'Topic /boxes is stale')
