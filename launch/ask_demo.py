#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Asks the services about the demo's warehouse and prints the answers as a table.

Every expected value is worked out by hand from launch/scenes/warehouse.csv, as a fraction, and an answer must be
the double nearest to it. Only the moving cart is read from the snapshot that the answer names.
"""
import argparse
import math
import sys
from fractions import Fraction

import rosgraph
import rospy
from box_query.srv import (CastRay, CastRayRequest, CastRays, CastRaysRequest, CheckSegment, CheckSegmentRequest,
                           CheckSegments, CheckSegmentsRequest, FindIntersections, FindIntersectionsRequest, GetScene)
from geometry_msgs.msg import Point, Vector3
from std_msgs.msg import Header

NODE = 'box_query'
STANDING = ['carton', 'conveyor', 'pallet', 'rack', 'shelf', 'tote']  # all but the forklift and what moves


def square_root(value):
    """Of a fraction, to 100 decimal digits and more."""
    return Fraction(math.isqrt(value.numerator * value.denominator << 800), value.denominator << 400)


class Services:
    def __init__(self):
        self.cast_ray = self.proxy('cast_ray', CastRay)
        self.cast_rays = self.proxy('cast_rays', CastRays)
        self.check_segment = self.proxy('check_segment', CheckSegment)
        self.check_segments = self.proxy('check_segments', CheckSegments)
        self.find_intersections = self.proxy('find_intersections', FindIntersections)
        self.get_scene = self.proxy('get_scene', GetScene)

    @staticmethod
    def proxy(name, service):
        rospy.wait_for_service(NODE + '/' + name, 30.0)
        return rospy.ServiceProxy(NODE + '/' + name, service)

    def wait_until_complete(self):
        """Returns an empty string, or what the scene lacks after 30 s."""
        for _ in range(300):
            scene = self.get_scene()
            if scene.complete:
                return ''
            rospy.rostime.wallsleep(0.1)
        return scene.reason


class Table:
    def __init__(self):
        self.rows = []
        self.wrong = 0

    def add(self, question, response, answer, box, *checks):
        """Each check is a pair: what was answered, and what is expected."""
        bad = ['%r instead of %r' % (got, expected) for got, expected in checks if got != expected]
        if not response.success:
            bad = [response.message]
        self.wrong += bool(bad)
        self.rows.append((question, answer, box, 'WRONG: ' + '; '.join(bad) if bad else 'as expected'))

    def print(self):
        header = ('question', 'answer', 'box', '')
        widths = [max(len(row[i]) for row in self.rows + [header]) for i in range(3)]
        for row in [header, tuple('-' * width for width in widths) + ('',)] + self.rows:
            print('  '.join(field.ljust(width) for field, width in zip(row, widths + [0])).rstrip())


def label(name, namespace):
    return '%s (%s)' % (name, namespace) if name else ''


def frame(name):
    return Header(frame_id=name)


def ask_rays(ask, table):
    # The belt's center is (16, 0, 1.25) and its quaternion (0, -1, 0, 8) * 127 / 1024: it rises with sine 16/65. Its
    # upper face, 1/16 above the center's plane, is at height 5/4 + 65/1008 + 16/63 (x - 16). At the lidar's height
    # of 5/8 that is x = 16 - 695/256. The lidar is at x = -3/2. The direction need not be of unit length.
    ray = ask.cast_ray(CastRayRequest(header=frame('lidar'), direction=Vector3(2, 0, 0)))
    table.add('What is straight ahead of the lidar?', ray,
              '%.12g m, normal (%.3f, %.3f, %.3f)' % (ray.range, ray.normal.x, ray.normal.y, ray.normal.z),
              label(ray.box_label, ray.box_namespace),
              (ray.box_label, 'conveyor_belt'), (ray.range, float(16 - Fraction(695, 256) + Fraction(3, 2))))

    # The cart is where the snapshot says that it is; its front is half its length before its center.
    ray = ask.cast_ray(CastRayRequest(header=frame('map'), origin=Point(0, -0.625, 0.25), direction=Vector3(1, 0, 0)))
    scene = ask.get_scene(scene_id=ray.scene_id)
    cart = scene.box_labels.index('cart_b')
    front = Fraction(scene.poses[cart].position.x) - Fraction(scene.sizes[cart].x) / 2
    table.add('What comes in the right lane?', ray, '%.12g m (scene %d)' % (ray.range, ray.scene_id),
              label(ray.box_label, ray.box_namespace), (ray.box_label, 'cart_b'), (ray.range, float(front)))

    # All fronts of the northern rack lie in the plane y = 3/2; the first post begins at x = -1/16.
    ray = ask.cast_ray(CastRayRequest(header=frame('map'), origin=Point(-1, 1.5, 1.1875), direction=Vector3(1, 0, 0)))
    table.add('Does a ray along the faces of the rack touch?', ray, '%.12g m' % ray.range,
              label(ray.box_label, ray.box_namespace),
              (ray.box_label, 'north_post_0_front'), (ray.range, float(Fraction(15, 16))))

    ray = ask.cast_ray(CastRayRequest(header=frame('map'), origin=Point(-1, 1.4999999999999998, 1.1875),
                                      direction=Vector3(1, 0, 0)))
    table.add('... and one double nearer to the aisle?', ray, 'a miss' if not ray.hit else '%.12g m' % ray.range,
              label(ray.box_label, ray.box_namespace), (ray.hit, False), (ray.range, math.inf))

    # Its carton stands on z = 1/8 and is 3/4 high; the ray starts at z = 1/2.
    ray = ask.cast_ray(CastRayRequest(header=frame('map'), origin=Point(0.8125, 2.0625, 0.5),
                                      direction=Vector3(0, 0, 1)))
    table.add('How far is it out of a carton?', ray, '%.12g m, started inside' % ray.exit_range,
              label(ray.box_label, ray.box_namespace), (ray.box_label, 'carton_north_0_0_0'),
              (ray.started_inside, True), (ray.range, 0.0), (ray.exit_range, float(Fraction(3, 8))))


def ask_fan(ask, table):
    """A batch answers as single calls do."""
    angles = [math.radians(degrees) for degrees in range(-66, 67, 3)]
    directions = [Vector3(math.cos(angle), math.sin(angle), 0.0) for angle in angles]
    fan = ask.cast_rays(CastRaysRequest(header=frame('lidar'), origins=[Point()], directions=directions,
                                        max_ranges=[14.0], namespaces=STANDING, want_boxes=True))
    single = [ask.cast_ray(CastRayRequest(header=frame('lidar'), direction=direction, max_range=14.0,
                                          namespaces=STANDING)) for direction in directions]
    nearest = min(range(len(single)), key=lambda i: single[i].range)
    labels = [fan.box_labels[box] if box >= 0 else '' for box in fan.boxes]
    table.add('What does a scan of %d rays see?' % len(directions), fan,
              '%d hits, nearest %.12g m' % (sum(fan.hits), min(fan.ranges, default=math.nan)),
              label(single[nearest].box_label, single[nearest].box_namespace),
              (fan.ranges, tuple(ray.range for ray in single)), (labels, [ray.box_label for ray in single]),
              (0 < sum(fan.hits) < len(directions), True))


def ask_segments(ask, table):
    # A pallet sticks out to y = -19/16 and is 1/8 high; 1/4 above the floor it is sqrt((19/16)^2 + (1/8)^2) away.
    clearance = float(square_root(Fraction(365, 256)))
    segment = CheckSegmentRequest(header=frame('map'), start=Point(0, 0, 0.25), end=Point(10, 0, 0.25), radius=1.125,
                                  namespaces=STANDING)
    check = ask.check_segment(segment)
    table.add('Is the aisle clear by 1.125 m?', check,
              '%s, clearance %.12g m' % ('clear' if check.clear else 'not clear', check.clearance),
              label(check.nearest_label, check.nearest_namespace), (check.clear, True),
              (check.nearest_label, 'pallet_south_2_0_1'), (check.clearance, clearance))

    # It begins at x = 121/16 and is within 5/4 from sqrt((5/4)^2 - 365/256) = sqrt(35/256) before that. The segment is
    # 10 m long. The answer may be up to 4 ulp early, never late.
    segment.radius = 1.25
    check = ask.check_segment(segment)
    first = (Fraction(121, 16) - square_root(Fraction(35, 256))) / 10
    early = (first - Fraction(check.blocked_at)) / Fraction(1, 2 ** 53) if check.blocked else -1
    table.add('... and by 1.25 m?', check,
              '%s from %.12g of the way' % ('blocked' if check.blocked else 'not blocked', check.blocked_at),
              label(check.blocking_label, check.blocking_namespace), (check.clear, False), (check.blocked, True),
              (check.blocking_label, 'pallet_south_2_0_1'), (0 <= early <= 4, True))

    # Up the aisle, into the carton on the left, and on. The third leg is not looked at any more.
    path = ask.check_segments(CheckSegmentsRequest(
        header=frame('map'), shape=CheckSegmentsRequest.PATH, radii=[0.25], namespaces=STANDING,
        points=[Point(0, 0, 0.5), Point(3.8125, 0, 0.5), Point(3.8125, 2.0625, 0.5), Point(9, 0, 0.5)],
        stop_at_blocked=True, want_boxes=True))
    words = ['not evaluated', 'clear', 'blocked', 'unknown']
    blocking = path.blocking_boxes[path.first_blocked] if path.first_blocked >= 0 else -1
    table.add('Which leg of a path is blocked first?', path, ', '.join(words[state] for state in path.states),
              label(path.box_labels[blocking], path.box_namespaces[blocking]) if blocking >= 0 else '',
              (path.first_blocked, 1), (list(path.states), [1, 2, 0]))


def ask_line(ask, table):
    # Along the faces again: five posts, 1/8 wide and 3 apart, and between each two a shelf that touches both.
    found = ask.find_intersections(FindIntersectionsRequest(
        header=frame('map'), component=FindIntersectionsRequest.LINE, origin=Point(0, 1.5, 1.1875),
        direction=Vector3(1, 0, 0)))
    names = ['north_post_%d_front' % (i // 2) if i % 2 == 0 else 'north_shelf_%d_1' % (i // 2) for i in range(9)]
    enter = [float(3 * Fraction(i // 2) + Fraction(-1 if i % 2 == 0 else 1, 16)) for i in range(9)]
    table.add('What does the line along the rack meet?', found, '%d boxes in order' % len(found.box_labels),
              ' '.join(found.box_labels[:2] + ['...']), (list(found.box_labels), names),
              (list(found.t_enter), enter), (set(found.num_points), {2}))


def ask_all(ask):
    table = Table()
    for questions in (ask_rays, ask_fan, ask_segments, ask_line):
        questions(ask, table)
    return table


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--once', action='store_true', help='end after the answers, with 0 if they are as expected')
    arguments = parser.parse_args(rospy.myargv()[1:])
    for _ in range(300):
        if rosgraph.is_master_online():
            break
        rospy.rostime.wallsleep(0.1)
    rospy.init_node('ask_demo', anonymous=True, disable_signals=True)
    ask = Services()
    missing = ask.wait_until_complete()
    if missing:
        print('The scene is not complete: ' + missing)
        return 1
    table = ask_all(ask)
    table.print()
    print('%d answers, %d not as expected' % (len(table.rows), table.wrong))
    if arguments.once:
        return 1 if table.wrong else 0
    print('The same questions are asked again every 2 s, so that rviz shows them. Ctrl-C ends the demo.')
    sys.stdout.flush()
    try:
        while True:
            rospy.rostime.wallsleep(2.0)
            again = ask_all(ask)
            if again.wrong:
                again.print()
    except KeyboardInterrupt:
        return 0


if __name__ == '__main__':
    try:
        sys.exit(main())
    except (rospy.ROSException, rospy.ServiceException) as error:
        sys.exit('The demo cannot ask: %s' % error)
