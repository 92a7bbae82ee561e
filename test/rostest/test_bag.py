#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Boxes of recorded messages, types that are not installed among them, that rosbag plays on its own clock: it starts,
ends, stands still and goes back.
"""

import os
import subprocess
import sys
import tempfile
import time
import unittest

import rosbag
import rospy
import rostest
from box_query.srv import CastRay, CastRayRequest, GetScene, GetSceneRequest
from geometry_msgs.msg import TransformStamped, Vector3
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from public_definitions import message_classes

TIMEOUT = 30.0  # [s] of wall time for whatever is waited for
TYPES = ('jsk_recognition_msgs/BoundingBoxArray', 'vision_msgs/BoundingBox3DArray')
CLASSES = {name: made for kind in TYPES for name, made in message_classes(kind).items()}


def transform(stamp):
    """The cart is `stamp` - 1000 metres ahead of the map's origin."""
    one = TransformStamped(child_frame_id='cart')
    one.header.frame_id = 'map'
    one.header.stamp = rospy.Time(stamp)
    one.transform.translation.x = stamp - 1000.0
    one.transform.rotation.w = 1.0
    return TFMessage([one])


def marker_array(ids):
    array = MarkerArray()
    for number in ids:
        marker = Marker(type=Marker.CUBE, ns='shelf', id=number)
        marker.header.frame_id = 'map'
        marker.pose.position.y = number
        marker.pose.orientation.w = 1.0
        marker.scale = Vector3(1, 0.5, 1)
        array.markers.append(marker)
    return array


def with_header(message, stamp):
    message.header.stamp = rospy.Time(stamp)
    message.header.frame_id = 'cart'
    return message


def set_box(pose, sides, x):
    pose.position.x = x
    pose.orientation.w = 1.0
    sides.x = sides.y = sides.z = 1.0


def jsk_array(stamp):
    box = with_header(CLASSES['jsk_recognition_msgs/BoundingBox'](label=7), stamp)
    set_box(box.pose, box.dimensions, 10.0)
    return CLASSES['jsk_recognition_msgs/BoundingBoxArray'](boxes=[box])


def vision_array(stamp):
    box = CLASSES['vision_msgs/BoundingBox3D']()
    set_box(box.center, box.size, 20.0)
    return with_header(CLASSES['vision_msgs/BoundingBox3DArray'](boxes=[box]), stamp)


def write(path, messages):
    """`messages` are (time, topic, message), in any order."""
    with rosbag.Bag(path, 'w') as bag:
        for stamp, topic, message in sorted(messages, key=lambda each: each[0]):
            bag.write(topic, message, rospy.Time(stamp))
        # rosbag may end before its last message is out: this one says nothing.
        bag.write('/boxes', MarkerArray(), rospy.Time(stamp + 0.5))


class TestBag(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, 'boxes.bag')
        rospy.wait_for_service('/box_query/get_scene', TIMEOUT)
        self.get_scene = rospy.ServiceProxy('/box_query/get_scene', GetScene, persistent=True)

    def play(self, messages, rate):
        write(self.path, messages)
        subprocess.run(['rosbag', 'play', '--quiet', '--clock', '--wait-for-subscribers', '--rate', str(rate), self.path],
                       check=True, stdin=subprocess.DEVNULL, timeout=TIMEOUT)

    def await_scene(self, names):
        """Waits until the node has these (topic, namespace, id). Returns the scene, and the poses by name."""
        deadline = time.monotonic() + TIMEOUT
        while True:
            scene = self.get_scene(GetSceneRequest())
            poses = dict(zip(zip(scene.box_topics, scene.box_namespaces, scene.box_ids), scene.poses))
            if sorted(poses) == sorted(names):
                return scene, poses
            self.assertLess(time.monotonic(), deadline, '%s; %s' % (sorted(poses), scene.reason))
            time.sleep(0.02)

    def test_bag(self):
        jsk, vision = ('/jsk', '7', 0), ('/vision', '', 0)
        recorded = [(1000.0, '/boxes', marker_array([1, 2])), (1001.0, '/boxes', marker_array([2, 3]))]
        for tenths in range(31):
            stamp = 1000.0 + tenths / 10
            recorded.append((stamp + 0.25, '/tf', transform(stamp)))  # later than the boxes that need it
            if tenths < 30:
                recorded.append((stamp + 0.05, '/jsk', jsk_array(stamp + 0.05)))
            if tenths <= 5:
                recorded.append((stamp, '/vision', vision_array(stamp)))
        self.play(recorded, rate=2)
        scene, poses = self.await_scene([('/boxes', 'shelf', 1), ('/boxes', 'shelf', 2), ('/boxes', 'shelf', 3), jsk, vision])
        self.assertAlmostEqual(poses[jsk].position.x, 10.0 + 2.95, places=8, msg='at its stamp, between two transforms')
        self.assertAlmostEqual(poses[vision].position.x, 20.0 + 0.5, places=8)
        self.assertIn('Topic /vision is stale', scene.reason)
        self.assertFalse(scene.complete)
        self.assertNotIn('/jsk', scene.reason)

        # The clock stands now, and nobody hangs.
        cast_ray = rospy.ServiceProxy('/box_query/cast_ray', CastRay)
        request = CastRayRequest(direction=Vector3(1, 0, 0), allow_incomplete=True)
        request.header.frame_id = 'cart'
        answer = cast_ray(request)
        self.assertTrue(answer.success and answer.hit, answer.message)
        self.assertEqual(answer.box_topic, '/jsk')
        self.assertAlmostEqual(answer.range, 10.0 + 2.95 - 0.5 - 3.0, places=8, msg='from where the cart is last')
        request.header.frame_id = 'nowhere'
        self.assertFalse(cast_ray(request).success)

        # It goes back: what was is no more, transforms included.
        self.play([(900.0, '/boxes', marker_array([5])), (900.1, '/boxes', marker_array([6])),
                   (900.2, '/jsk', jsk_array(900.2))], rate=1)
        scene, poses = self.await_scene([('/boxes', 'shelf', 5), ('/boxes', 'shelf', 6)])
        self.assertTrue(900.0 < scene.header.stamp.to_sec() < 902.0, scene.header.stamp)
        self.assertIn("1 box of topic /jsk waits for the transform from frame 'cart'", scene.reason)
        self.assertIn('No boxes have come on topic /vision', scene.reason)


if __name__ == '__main__':
    rospy.init_node('test_bag')
    rostest.rosrun('box_query', 'bag', TestBag, sys.argv)
