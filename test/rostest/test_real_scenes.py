#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Real scenes through the real node: what its services answer, against fractions, to the last bit.

Scenes are published in the node's own frame, so that nothing is transformed and every answer is exact.
"""

from fractions import Fraction
import math
import os
import random
import sys
import unittest
from xml.sax.saxutils import quoteattr

import rospy
import rostest
from box_query.srv import (CastRay, CastRayRequest, CastRays, CastRaysRequest, CheckSegment, CheckSegmentRequest,
                           CheckSegments, CheckSegmentsRequest, CheckSegmentsResponse, FindIntersections,
                           FindIntersectionsRequest, GetScene, GetSceneRequest)
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from visualization_msgs.msg import Marker, MarkerArray

from exact_boxes import Box, LINE, RAY, SEGMENT, is_rounded, is_rounded_root, neighbour
from scene_queries import Queries, draw_scenes

SCENES = 100
QUERIES = 52       # of each kind and scene; at least 50
TIMEOUT = 10.0     # [s] for whatever is waited for
POINT_ULPS = 4     # of the largest coordinate, as the library promises
INFINITY = float('inf')


def tuple_of(v):
    return v.x, v.y, v.z


def distance(a, b):
    return max(abs(x - y) for x, y in zip(a, b))


def tolerance(box, *points):
    """POINT_ULPS ulps [m] of the largest coordinate of the box and some points."""
    size = math.sqrt(sum(e * e for e in box.half_extents))
    largest = max([abs(c) + size for c in box.center] + [abs(x) for point in points for x in point])
    return POINT_ULPS * (neighbour(largest, 1) - largest)


def exact_point(start, direction, t):
    return [Fraction(x) + t * Fraction(d) for x, d in zip(start, direction)]


class PublishedScene:
    """A scene as the node should know it: its boxes in the order of a snapshot."""

    def __init__(self, rows):
        def name(i):
            return rows[i][0], i  # namespace and id; a snapshot sorts by them
        order = sorted(range(len(rows)), key=name)
        self.names = [name(i) for i in order]
        self.rows = [rows[i] for i in order]
        self.boxes = [Box(c, q, [s / 2 for s in size]) for _, c, q, size in self.rows]

    def message(self, stamp):
        array = MarkerArray([Marker(action=Marker.DELETEALL)])
        array.markers[0].header.stamp = stamp
        for (namespace, number), (_, center, (w, x, y, z), size) in zip(self.names, self.rows):
            marker = Marker(ns=namespace, id=number, type=Marker.CUBE, action=Marker.ADD)
            marker.header.frame_id = 'map'
            marker.header.stamp = stamp
            marker.pose = Pose(Point(*center), Quaternion(x, y, z, w))
            marker.scale = Vector3(*size)
            array.markers.append(marker)
        return array


class TestRealScenes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        def proxy(name, service):
            rospy.wait_for_service('/box_query/' + name, TIMEOUT)
            return rospy.ServiceProxy('/box_query/' + name, service, persistent=True)
        cls.cast_ray = proxy('cast_ray', CastRay)
        cls.cast_rays = proxy('cast_rays', CastRays)
        cls.check_segment = proxy('check_segment', CheckSegment)
        cls.check_segments = proxy('check_segments', CheckSegments)
        cls.find_intersections = proxy('find_intersections', FindIntersections)
        cls.get_scene = proxy('get_scene', GetScene)
        cls.publisher = rospy.Publisher('/boxes', MarkerArray, queue_size=1)
        deadline = rospy.get_time() + TIMEOUT
        while cls.publisher.get_num_connections() == 0:
            if rospy.get_time() > deadline:
                raise RuntimeError('the node does not subscribe to /boxes')
            rospy.sleep(0.02)

    def publish(self, scene, number):
        """Publishes a scene and waits until the node answers from it, and from nothing else."""
        stamp = rospy.Time(number + 1)
        self.publisher.publish(scene.message(stamp))
        deadline = rospy.get_time() + TIMEOUT
        known = self.get_scene(GetSceneRequest())
        while not (known.success and known.header.stamp == stamp):
            self.assertLess(rospy.get_time(), deadline, 'the node does not take in scene %d' % number)
            rospy.sleep(0.005)
            known = self.get_scene(GetSceneRequest())
        self.assertTrue(known.complete, known.reason)
        self.assertEqual(known.header.frame_id, 'map')
        self.assertEqual(list(zip(known.box_namespaces, known.box_ids)), scene.names)
        self.assertEqual(set(known.box_topics), {'/boxes'})
        for pose, size, row in zip(known.poses, known.sizes, scene.rows):
            q = pose.orientation
            self.assertEqual((tuple_of(pose.position), (q.w, q.x, q.y, q.z), tuple_of(size)), row[1:])
        return known.scene_id

    def answered(self, response, scene_id):
        self.assertTrue(response.success, response.message)
        self.assertEqual(response.scene_id, scene_id)
        self.assertTrue(response.complete, response.reason)
        return response

    def named(self, scene, response, index):
        """Index in the scene of an entry of a response's list of boxes."""
        if index < 0:
            return None
        return scene.names.index((response.box_namespaces[index], response.box_ids[index]))

    def test_answers_of_every_scene_are_exact(self):
        rng = random.Random(2018)
        drawn = draw_scenes(DATA, SCENES, rng)
        self.assertEqual(len(drawn), SCENES)
        touchable = 0
        for number, rows in enumerate(drawn):
            self.assertGreater(len(rows), 0)
            scene = PublishedScene(rows)
            queries = Queries(scene.boxes, rng)
            touchable += bool(queries.exact_faces)
            try:
                self.check_scene(scene, queries, number)
            except AssertionError as error:
                raise AssertionError('scene %d: %s' % (number, error)) from error
        self.assertGreater(touchable, SCENES * 3 // 4)

    def check_scene(self, scene, queries, number):
        scene_id = self.publish(scene, number)
        rays, segments = queries.rays(QUERIES), queries.segments(QUERIES)
        for kind in rays, segments:
            yes = sum(query.outcome(answer) for query, answer in kind)
            self.assertGreaterEqual(min(yes, QUERIES - yes), QUERIES // 4)
            if queries.exact_faces:
                touching = sum(query.touches(scene.boxes, answer) for query, answer in kind)
                self.assertGreaterEqual(touching, math.ceil(QUERIES / 10))
        self.check_rays(scene, scene_id, rays)
        self.check_single_rays(scene, scene_id, rays[:4] + rays[-4:])
        self.check_segments_of(scene, scene_id, segments)
        self.check_single_segments(scene, scene_id, segments[:4] + segments[-4:])
        self.check_intersections(scene, scene_id, rays[:4] + rays[-2:])

    def check_ray(self, scene, ray, answer, hit, box, range_, exit_range, point, normal):
        intervals, first = answer
        self.assertEqual(hit, first is not None)
        self.assertEqual(box, first)
        if first is None:
            self.assertEqual(range_, INFINITY)
            self.assertTrue(all(math.isnan(x) for x in (exit_range,) + tuple_of(point) + tuple_of(normal)))
            return
        exact, solid = intervals[first], scene.boxes[first]
        self.assertTrue(is_rounded_root(range_, ray.squared_range(exact.enter)))
        self.assertTrue(is_rounded_root(exit_range, ray.squared_range(exact.leave)))
        where = exact_point(ray.origin, ray.direction, exact.enter)
        self.assertLessEqual(distance(tuple_of(point), where), tolerance(solid, ray.origin))
        axis = min((i for i in range(3) if exact.entered >> (2 * i) & 3), default=None)
        outward = (0.0, 0.0, 0.0)
        if not exact.started_inside:
            side = 1 if exact.entered >> (2 * axis) & 2 else -1
            outward = [side * x / solid.n for x in solid.axes[axis]]
        self.assertLessEqual(distance(tuple_of(normal), outward), 1e-15)

    def check_rays(self, scene, scene_id, rays):
        request = CastRaysRequest(mode=CastRaysRequest.CLOSEST, want_exits=True, want_points=True,
                                  want_normals=True, want_boxes=True)
        request.header.frame_id = 'map'
        request.origins = [Point(*ray.origin) for ray, _ in rays]
        request.directions = [Vector3(*ray.direction) for ray, _ in rays]
        request.max_ranges = [ray.max_range for ray, _ in rays]
        response = self.answered(self.cast_rays(request), scene_id)
        self.assertEqual(len(response.hits), len(rays))
        for i, (ray, answer) in enumerate(rays):
            self.check_ray(scene, ray, answer, response.hits[i], self.named(scene, response, response.boxes[i]),
                           response.ranges[i], response.exit_ranges[i], response.points[i], response.normals[i])
        request.mode = CastRaysRequest.ANY
        any_hit = self.answered(self.cast_rays(request), scene_id)
        self.assertEqual(any_hit.hits, response.hits)

    def check_single_rays(self, scene, scene_id, rays):
        for ray, answer in rays:
            request = CastRayRequest(origin=Point(*ray.origin), direction=Vector3(*ray.direction),
                                     max_range=ray.max_range)
            request.header.frame_id = 'map'
            response = self.answered(self.cast_ray(request), scene_id)
            box = scene.names.index((response.box_namespace, response.box_id)) if response.hit else None
            self.check_ray(scene, ray, answer, response.hit, box, response.range, response.exit_range,
                           response.point, response.normal)
            self.assertEqual(response.box_topic, '/boxes' if response.hit else '')
            self.assertEqual(response.started_inside, response.hit and answer[0][box].started_inside)

    def check_one(self, scene, segment, answer, clear, clearance, nearest, at, blocked_at, blocking):
        """What both services say about a segment; `at` holds the points on segment and box."""
        self.assertEqual(clear, segment.outcome(answer))
        first = min(range(len(answer)), key=lambda i: (answer[i][1], i))
        t, squared = answer[first]
        self.assertEqual(nearest, first)
        self.assertTrue(is_rounded_root(clearance, squared))
        box = scene.boxes[first]
        slack = tolerance(box, segment.start, segment.end)
        way = [Fraction(b) - Fraction(a) for a, b in zip(segment.start, segment.end)]
        self.assertLessEqual(distance(tuple_of(at[0]), exact_point(segment.start, way, t)), slack)
        on_box = tuple_of(at[1])
        self.assertLessEqual(box.nearest(on_box, on_box)[1], 3 * Fraction(slack)**2)
        self.assertLessEqual(abs(math.dist(tuple_of(at[0]), on_box) - clearance), 4 * slack)
        if clear:
            self.assertEqual((blocked_at, blocking), (INFINITY, None))
        elif segment.radius == 0:
            meets = [box.intersect(SEGMENT, segment.start, segment.end) for box in scene.boxes]
            met = [i for i, interval in enumerate(meets) if interval]
            self.assertEqual(blocking, min(met, key=lambda i: (meets[i].enter, i)))
            self.assertTrue(is_rounded(blocked_at, meets[blocking].enter))
        else:
            self.assertTrue(self.is_first_within(scene.boxes[blocking], segment, answer[blocking], blocked_at))
            for box, (place, _) in zip(scene.boxes, answer):  # nothing comes within the radius before
                before = min(Fraction(blocked_at), place)
                squared = box.profile(segment.start, segment.end)(before)
                self.assertTrue(blocked_at == 0 or squared >= Fraction(segment.radius)**2)

    @staticmethod
    def is_first_within(box, segment, nearest, t):
        """Whether the segment first comes within its radius of the box at t or up to 4 doubles later."""
        squared_distance = box.profile(segment.start, segment.end)
        limit, place = Fraction(segment.radius)**2, nearest[0]
        if squared_distance(0) <= limit:
            return t == 0
        after = t
        for _ in range(4):
            after = neighbour(after, 1)
        # Up to its nearest place the segment only approaches.
        return t <= place and squared_distance(t) >= limit and squared_distance(min(Fraction(after), place)) <= limit

    def check_segments_of(self, scene, scene_id, segments):
        request = CheckSegmentsRequest(shape=CheckSegmentsRequest.PAIRS, want_clearances=True, want_points=True,
                                       want_blocked_at=True, want_boxes=True)
        request.header.frame_id = 'map'
        request.points = [Point(*p) for segment, _ in segments for p in (segment.start, segment.end)]
        request.radii = [segment.radius for segment, _ in segments]
        response = self.answered(self.check_segments(request), scene_id)
        self.assertEqual(len(response.states), len(segments))
        for i, (segment, answer) in enumerate(segments):
            state = response.states[i]
            self.assertIn(state, (CheckSegmentsResponse.CLEAR, CheckSegmentsResponse.BLOCKED))
            self.check_one(scene, segment, answer, state == CheckSegmentsResponse.CLEAR, response.clearances[i],
                           self.named(scene, response, response.nearest_boxes[i]),
                           (response.points_on_segment[i], response.points_on_box[i]), response.blocked_at[i],
                           self.named(scene, response, response.blocking_boxes[i]))
        self.assertFalse(response.all_clear)
        blocked = [i for i, (segment, answer) in enumerate(segments) if not segment.outcome(answer)]
        self.assertEqual(response.first_blocked, blocked[0])

    def check_single_segments(self, scene, scene_id, segments):
        for segment, answer in segments:
            request = CheckSegmentRequest(start=Point(*segment.start), end=Point(*segment.end),
                                          radius=segment.radius)
            request.header.frame_id = 'map'
            response = self.answered(self.check_segment(request), scene_id)
            self.assertEqual(response.blocked, not response.clear)
            self.assertTrue(is_rounded(response.nearest_at, min(answer, key=lambda nearest: nearest[1])[0]))
            blocking = (response.blocking_namespace, response.blocking_id)
            self.check_one(scene, segment, answer, response.clear, response.clearance,
                           scene.names.index((response.nearest_namespace, response.nearest_id)),
                           (response.point_on_segment, response.point_on_box), response.blocked_at,
                           scene.names.index(blocking) if response.blocked else None)

    def check_intersections(self, scene, scene_id, rays):
        for ray, _ in rays:
            for kind in LINE, RAY, SEGMENT:
                end = [x + d for x, d in zip(ray.origin, ray.direction)]
                request = FindIntersectionsRequest(component=kind, origin=Point(*ray.origin), end=Point(*end),
                                                   direction=Vector3(*ray.direction))
                request.header.frame_id = 'map'
                response = self.answered(self.find_intersections(request), scene_id)
                other = end if kind == SEGMENT else ray.direction
                exact = [box.intersect(kind, ray.origin, other) for box in scene.boxes]
                order = sorted((i for i, interval in enumerate(exact) if interval), key=lambda i: (exact[i].enter, i))
                self.assertEqual(list(zip(response.box_namespaces, response.box_ids)), [scene.names[i] for i in order])
                for k, i in enumerate(order):
                    self.check_intersection(exact[i], response, k, kind, ray.origin, other)

    def check_intersection(self, exact, response, k, kind, origin, other):
        self.assertEqual(response.num_points[k], exact.num_points)
        self.assertEqual(response.faces_entered[k], exact.entered)
        self.assertEqual(response.faces_left[k], exact.left)
        self.assertEqual(response.started_inside[k], exact.started_inside)
        way = [Fraction(b) - (Fraction(a) if kind == SEGMENT else 0) for a, b in zip(origin, other)]
        squared_length = sum(d * d for d in way)
        for t, along, exact_t in ((response.t_enter[k], response.distance_enter[k], exact.enter),
                                  (response.t_exit[k], response.distance_exit[k], exact.leave)):
            self.assertTrue(is_rounded(t, exact_t))
            self.assertTrue(is_rounded_root(abs(along), exact_t**2 * squared_length))
            self.assertEqual(along < 0, exact_t < 0)


def report_skip(reason):
    """Writes the result file of a test that was skipped: rosunit knows no such outcome."""
    for argument in sys.argv:
        if argument.startswith('--gtest_output=xml:'):
            with open(argument.split(':', 1)[1], 'w') as file:
                file.write('<testsuite name="real_scenes" tests="1" failures="0" errors="0" skipped="1">'
                           '<testcase classname="TestRealScenes" name="all" time="0"><skipped message=%s/></testcase>'
                           '</testsuite>\n' % quoteattr(reason))
    print('SKIPPED: ' + reason)


DATA = os.path.join(os.environ.get('BOX_QUERY_SHARED', ''), 'data')

if __name__ == '__main__':
    if 'BOX_QUERY_SHARED' not in os.environ:
        report_skip('BOX_QUERY_SHARED is not set: it names the directory that holds data/')
    elif not os.path.isdir(DATA):
        report_skip('BOX_QUERY_SHARED: there is no ' + DATA)
    else:
        rospy.init_node('test_real_scenes')
        rostest.rosrun('box_query', 'real_scenes', TestRealScenes)
