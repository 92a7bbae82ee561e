# SPDX-License-Identifier: BSD-3-Clause
"""Publishers of boxes end, by force too, and come again, beside one another, with other types."""
import time


def fault_publisher_killed(world, report):
    """What publishes boxes is killed and comes again, with fewer of them."""
    world.start_node(box_topics=[{'topic': 'boxes', 'timeout': 1.0}])
    publisher = world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 1, 2, 3)
    world.until(lambda: world.answers(4, 3), 'boxes')
    report.begin()
    publisher.end()
    report.during(world.await_reason('Topic /boxes is stale'))
    publisher = world.speak('boxes', 'boxes', 'MarkerArray', 'map', 2, 2)
    report.right_again(publisher.since, 2, 1, 'it spoke')


def fault_topic_changes_its_type(world, report):
    """What publishes boxes is killed; another comes, with another type."""
    world.start_node(box_topics=[{'topic': 'boxes', 'timeout': 1.0}])
    publisher = world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 1, 2)
    world.until(lambda: world.answers(4, 2), 'boxes')
    report.begin()
    publisher.end()
    report.during(world.await_reason('Topic /boxes is stale'))
    publisher = world.speak('boxes', 'boxes', 'Marker', 'map', 2, 7, 8, 9)
    report.right_again(publisher.since, 2, 3, 'it spoke')


def fault_one_of_two_publishers_killed(world, report):
    """Two publishers of one type speak on one topic. One is killed, the other goes on; it comes again, elsewhere."""
    world.start_node(box_topics=[{'topic': 'boxes', 'timeout': 1.0}])
    near = world.speak('boxes', 'boxes', 'MarkerArray', 'map', 2, 1)
    world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 2, 3)
    world.until(lambda: world.answers(2, 3), 'the boxes of both')
    time.sleep(2.0)  # one that ends within a second of another's coming has made way for it
    report.begin()
    near.end()
    report.stays(2, 3, 'complete, with the boxes of both: one topic is one source, and it speaks')
    near = world.speak('boxes', 'boxes', 'MarkerArray', 'map', 1, 1)
    report.right_again(near.since, 1, 3, 'it spoke')


def fault_publishers_of_two_types(world, report):
    """A publisher of another type comes to a topic that has one."""
    world.start_node(box_topics=[{'topic': 'boxes', 'timeout': 1.0}])
    first = world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 1, 2)
    world.until(lambda: world.answers(4, 2), 'boxes')
    report.begin()
    world.speak('boxes', 'boxes', 'Marker', 'map', 2, 7)
    report.during(world.await_reason('Topic /boxes has publishers of two types', 'MarkerArray', 'msgs/Marker:'))
    report.stays(4, 2, 'incomplete, from the first publisher', complete=False)
    ended = time.monotonic()
    first.end()
    report.right_again(ended, 2, 1, 'the first was killed')
