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


def fault_node_killed(world, report):
    """The node is killed, and its launch file starts it again."""
    world.launch('respawn:=true', 'box_topics:=[{topic: boxes, timeout: 1.0}]')
    world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 1, 2)
    world.until(lambda: world.answers(4, 2), 'boxes')
    report.begin()
    killed = world.node_pid()
    os.kill(killed, signal.SIGKILL)
    ended = time.monotonic()
    world.until(lambda: not os.path.exists('/proc/%d' % killed), 'the end of the node')
    report.during('no answer, until it is back')
    report.right_again(ended, 4, 2, 'the node was killed')
    check(world.node_pid() != killed, 'the node was not killed')


def batch_ends_by(number, world, report):
    world.start_node(box_topics=['row'])
    world.speak('many', 'row', 20000, 'map', 'row')
    world.until(lambda: world.answers(4.25, 20000), 'boxes')
    report.begin()
    client = world.long_batch()
    world.node.send_signal(number)
    ended = time.monotonic()
    check(world.node.wait(60) == 0, 'the node ended with', world.node.returncode)
    print('  the node ended, with 0, %.2f s after the signal' % (time.monotonic() - ended))
    answer = client.communicate(timeout=60)[0].strip()
    check(answer in (b'refused: the node shuts down: ask again when it is back', b'the connection was closed'), answer)
    report.during('the client got: ' + answer.decode())
    began = time.monotonic()
    world.start_node()
    report.right_again(began, 4.25, 20000, 'it was started again')


def fault_batch_and_sigint(world, report):
    """SIGINT during a batch of minutes."""
    batch_ends_by(signal.SIGINT, world, report)


def fault_batch_and_sigterm(world, report):
    """SIGTERM during a batch of minutes."""
    batch_ends_by(signal.SIGTERM, world, report)


def fault_master_hangs(world, report):
    """The master is stopped, and goes on."""
    world.start_node(box_topics=[{'topic': 'boxes', 'timeout': 1.0}])
    world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 1, 2)
    world.until(lambda: world.answers(4, 2), 'boxes')
    report.begin()
    with world.connected():  # a new client would wait for the master
        world.master.send_signal(signal.SIGSTOP)
        time.sleep(2.0)  # the node asks the master now
        report.stays(4, 2, 'complete, to clients that are connected')
        world.master.send_signal(signal.SIGCONT)
    report.right_again(time.monotonic(), 4, 2)


def fault_master_hangs_as_the_node_ends(world, report):
    """The master is stopped, and then SIGINT sent to the node."""
    world.start_node(box_topics=['boxes'])
    world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 1, 2)
    world.until(lambda: world.answers(4, 2), 'boxes')
    report.begin()
    world.master.send_signal(signal.SIGSTOP)
    world.node.send_signal(signal.SIGINT)
    began = time.monotonic()
    try:
        check(world.node.wait(60) == 0, 'the node ended with', world.node.returncode)
    finally:
        world.master.send_signal(signal.SIGCONT)
    print('  the node ended, with 0, %.1f s after the signal' % (time.monotonic() - began))
    began = time.monotonic()
    world.start_node()
    report.right_again(began, 4, 2, 'it was started again')
