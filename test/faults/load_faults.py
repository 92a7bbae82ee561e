# SPDX-License-Identifier: BSD-3-Clause
"""More than there should be: of boxes, of questions, of patience."""
import time

from box_query.srv import CastRays, CastRaysRequest
from geometry_msgs.msg import Point, Vector3

from connection import Viewer
from world import check


def fault_flood_without_transform(world, report):
    """Messages of 10,000 boxes, of a frame that nobody knows, come fifty times a second."""
    world.start_node(box_topics=['boxes', 'flood'], max_waiting_boxes=20000, waiting_timeout=1.0)
    world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 1, 2)
    first = world.speak('boxes', 'flood', 'Marker', 'map', 5, 1)
    world.until(lambda: world.answers(4, 3), 'boxes')
    first.end()
    report.begin()
    flood = world.speak('many', 'flood', 10000, 'nowhere', 'flood')
    time.sleep(3.0)
    report.during(world.await_reason('/flood', "'nowhere'"))
    report.stays(4, 3, 'incomplete, with all that could be placed', complete=False)
    flood.end()
    back = world.speak('boxes', 'flood', 'Marker', 'map', 5, 1, 2)
    report.right_again(back.since, 4, 4, 'another publisher took its place')


def fault_flood_faster_than_can_be_taken_in(world, report):
    """Messages of 20,000 markers, of a frame that nobody knows, come from four publishers as fast as they can."""
    world.start_node(box_topics=['boxes', 'flood'], max_waiting_boxes=20000, waiting_timeout=1.0,
                     max_backlog_memory=30)
    world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 1, 2)
    first = world.speak('boxes', 'flood', 'Marker', 'map', 5, 1)
    world.until(lambda: world.answers(4, 3), 'boxes')
    first.end()
    report.begin()
    flood = [world.speak('torrent', 'flood', 20000, 'nowhere') for _ in range(4)]
    report.during(world.await_reason('Messages on topic /flood were dropped', '~max_backlog_memory'))
    report.stays(4, 3, 'incomplete, with all that could be placed', complete=False)
    time.sleep(3.0)
    for one in flood:
        one.end()
    back = world.speak('boxes', 'flood', 'MarkerArray', 'map', 5, 1, 2)
    report.right_again(back.since, 4, 4, 'another publisher took its place')
    report.growth = 128.0
    report.most = 128.0  # what waits, a message of 4 MB that each connection reads, and one that is taken in


def fault_million_boxes(world, report):
    """Messages of a million boxes, as many as are allowed."""
    world.start_node(box_topics=['boxes'])

    def million():
        many = world.speak('many', 'boxes', 1000000, 'map', 'once')
        report.right_again(many.since, 1, None, 'a million boxes came')
        many.end()
        few = world.speak('boxes', 'boxes', 'Marker', 'map', 4, 1, 2)
        report.right_again(few.since, 4, 2, 'few took their place')
        few.end()

    million()
    report.begin()
    report.growth = 512.0  # a past scene of a million is kept, as ~max_kept_boxes says
    million()


def fault_message_over_the_limit(world, report):
    """A message of more boxes than are allowed."""
    world.start_node(box_topics=['boxes'], max_boxes_per_message=1000)
    few = world.speak('boxes', 'boxes', 'Marker', 'map', 4, 1, 2)
    world.until(lambda: world.answers(4, 2), 'boxes')
    few.end()
    report.begin()
    many = world.speak('many', 'boxes', 1001, 'map', 'once')
    report.during(world.await_reason('/boxes', 'refused', 'more than 1000 boxes'))
    many.end()
    few = world.speak('boxes', 'boxes', 'Marker', 'map', 3, 1)
    report.right_again(few.since, 3, 1, 'a message within it came')


def fault_batch_over_the_limit(world, report):
    """A batch of more rays than are allowed."""
    world.start_node(box_topics=['boxes'], max_queries_per_call=100000)
    world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 1, 2)
    world.until(lambda: world.answers(4, 2), 'boxes')
    report.begin()
    batch = CastRaysRequest(origins=[Point()], directions=[Vector3(1, 0, 0)] * 100001)
    batch.header.frame_id = 'map'
    answer = world.call('cast_rays', CastRays, batch)
    check(answer and not answer.success and '100001' in answer.message, answer)
    print('  meanwhile: refused: ' + answer.message)
    report.right_again(time.monotonic(), 4, 2, 'the refusal')
    batch.directions.pop()
    answer = world.call('cast_rays', CastRays, batch)
    check(answer and answer.success and answer.ranges == (3.5,) * 100000, 'as many as are allowed are not answered')


def clients(world, report, role, count):
    world.start_node(box_topics=['boxes'])
    world.speak('boxes', 'boxes', 'MarkerArray', 'map', 4, 1, 2)
    world.until(lambda: world.answers(4, 2), 'boxes')
    report.begin()
    strange = [world.client(role) for _ in range(count)]
    report.stays(4, 2, 'complete: other clients do not notice')
    for client in strange:
        client.kill()
        client.wait()
    report.right_again(time.monotonic(), 4, 2, 'they were killed')


def fault_clients_that_send_half(world, report):
    """Clients send half a request, and nothing more; then they are killed."""
    clients(world, report, 'silent', 4)


def fault_clients_that_do_not_read(world, report):
    """Clients ask for megabytes and do not read them; then they are killed."""
    clients(world, report, 'deaf', 4)


def fault_viewer_that_does_not_read(world, report):
    """What shows ~markers hangs while 10,000 boxes move, and while rays are cast after that; then it reads on."""
    world.start_node(box_topics=['boxes', 'late'], max_kept_boxes=10000)
    few = world.speak('boxes', 'boxes', 'Marker', 'map', 4, 1)
    world.until(lambda: world.answers(4, 1, complete=False), 'boxes')
    few.end()
    viewer = Viewer()
    viewer.read()
    check(('status', 0) in viewer.shown, 'it is not said that a topic is not heard:', viewer.shown)
    report.begin()
    report.growth = report.most = 150.0  # two messages of 14 MB, one that is made, and what the boxes take
    many = world.speak('many', 'boxes', 10000, 'map', 'moves')
    time.sleep(2.0)
    world.speak('boxes', 'late', 'Marker', 'map', 9, 1)
    time.sleep(2.0)
    many.end()
    few = world.speak('boxes', 'boxes', 'Marker', 'map', 4, 1, 2, 3)
    report.right_again(few.since, 4, 4, 'its successor spoke')
    end = time.monotonic() + 2.0
    while time.monotonic() < end:
        check(world.answers(4, None), 'no answer')
    since = time.monotonic()
    while viewer.shown.get(('boxes//boxes', 0)) != 3 * 36 or ('status', 0) in viewer.shown:
        viewer.read()
    print('  shown again %.2f s after it read on' % (time.monotonic() - since))


def fault_client_vanishes_during_its_batch(world, report):
    """A client is killed while its batch of minutes is worked on."""
    world.start_node(box_topics=['row'])
    world.speak('many', 'row', 20000, 'map', 'row')
    world.until(lambda: world.answers(4.25, 20000), 'boxes')
    report.begin()
    client = world.long_batch()
    client.kill()
    client.wait()
    report.right_again(time.monotonic(), 4.25, None, 'the client was killed')
    report.growth += 128.0  # the batch is still worked on
