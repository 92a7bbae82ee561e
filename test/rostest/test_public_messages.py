#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Boxes of packages that are not installed, through the real node: publishers know the public definitions, and genpy
makes the rest of them, checksums included.
"""

import sys
import unittest

from genpy.dynamic import generate_dynamic
import rospy
import rostest
from box_query.srv import CastRay, CastRayRequest, GetScene, GetSceneRequest
from geometry_msgs.msg import Point, Vector3

from public_definitions import full_definition, message_classes

TIMEOUT = 20.0  # [s] for whatever is waited for
TURN = (0.0, 0.0, 0.6, 0.8)  # x, y, z, w
SIZE = (1.0, 0.25, 3.0)
LATCHED = []  # publishers, which have to outlive their tests


def fill(message, **fields):
    """Sets fields: tuples to the parts of a message in their order, everything else as it is."""
    for name, value in fields.items():
        part = getattr(message, name)
        if isinstance(value, tuple):
            for slot, number in zip(part.__slots__, value):
                setattr(part, slot, number)
        else:
            setattr(message, name, value)
    return message


class TestPublicMessages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service('/box_query/get_scene', TIMEOUT)
        cls.get_scene = rospy.ServiceProxy('/box_query/get_scene', GetScene, persistent=True)
        cls.cast_ray = rospy.ServiceProxy('/box_query/cast_ray', CastRay, persistent=True)

    def publisher(self, topic, message_class):
        LATCHED.append(rospy.Publisher('/' + topic, message_class, latch=True, queue_size=10))
        return LATCHED[-1]

    def names_of(self, topic, expected):
        """Waits until the node has these (namespace, id, label) of a topic. Returns its boxes by name."""
        deadline = rospy.get_time() + TIMEOUT
        while True:
            scene = self.get_scene(GetSceneRequest())
            names = zip(scene.box_topics, scene.box_namespaces, scene.box_ids, scene.box_labels)
            boxes = {name[1:]: box for name, box in zip(names, zip(scene.poses, scene.sizes, scene.stamps))
                     if name[0] == '/' + topic}
            if sorted(boxes) == sorted(expected):
                return boxes
            self.assertLess(rospy.get_time(), deadline, '%s: %s; %s' % (topic, sorted(boxes), scene.reason))
            rospy.sleep(0.02)

    def check_box(self, box, x, stamp):
        """The box is at (x, -2, 0.1) with TURN and SIZE, to the last bit."""
        pose, size, its_stamp = box
        p, q = pose.position, pose.orientation
        self.assertEqual((p.x, p.y, p.z), (x, -2.0, 0.1))
        self.assertEqual((q.x, q.y, q.z, q.w), TURN)
        self.assertEqual((size.x, size.y, size.z), SIZE)
        self.assertEqual(its_stamp.to_sec(), stamp)

    def pose(self, classes, x):
        pose = classes['geometry_msgs/Pose']()
        fill(pose.position, x=x, y=-2.0, z=0.1)
        return fill(pose, orientation=TURN)

    def header(self, message, stamp, frame='map'):
        message.header.frame_id = frame
        message.header.stamp = rospy.Time(stamp)
        return message

    def ask_ray(self, x):
        request = CastRayRequest(origin=Point(x, -2.0, 50.0), direction=Vector3(0, 0, -1), allow_incomplete=True)
        request.header.frame_id = 'map'
        return self.cast_ray(request)

    def await_ray(self, topic, x, label):
        """Waits until a ray down meets something at x, which check_ray() then names."""
        deadline = rospy.get_time() + TIMEOUT
        while not self.ask_ray(x).hit and rospy.get_time() < deadline:
            rospy.sleep(0.02)
        self.check_ray(topic, x, label)

    def check_ray(self, topic, x, label):
        """A ray down onto a box of the topic names it."""
        answer = self.ask_ray(x)
        self.assertTrue(answer.success and answer.hit, answer.message)
        self.assertEqual((answer.box_topic, answer.box_label), ('/' + topic, label))
        self.assertAlmostEqual(answer.range, 50.0 - 1.6, places=12)

    def jsk_box(self, classes, x, label):
        one = self.header(classes['jsk_recognition_msgs/BoundingBox'](), 7)
        return fill(one, pose=self.pose(classes, x), dimensions=SIZE, value=0.5, label=label)

    def test_jsk_bounding_box_array(self):
        classes = message_classes('jsk_recognition_msgs/BoundingBoxArray')
        array = self.header(classes['jsk_recognition_msgs/BoundingBoxArray'](), 8, 'nowhere')
        array.boxes = [self.jsk_box(classes, 10.0, 3), self.jsk_box(classes, 13.0, 4)]
        publisher = self.publisher('jsk', type(array))
        publisher.publish(array)
        boxes = self.names_of('jsk', [('3', 0, '3'), ('4', 1, '4')])
        self.check_box(boxes['4', 1, '4'], 13.0, 7)
        self.check_ray('jsk', 13.0, '4')
        array.boxes = [self.jsk_box(classes, 16.0, 4)]
        publisher.publish(array)
        self.check_box(self.names_of('jsk', [('4', 0, '4')])['4', 0, '4'], 16.0, 7)

    def test_vision_bounding_box_3d_array(self):
        classes = message_classes('vision_msgs/BoundingBox3DArray')
        array = self.header(classes['vision_msgs/BoundingBox3DArray'](), 7)
        for x in (20.0, 23.0):
            one = classes['vision_msgs/BoundingBox3D']()
            array.boxes.append(fill(one, center=self.pose(classes, x), size=SIZE))
        self.publisher('vision_boxes', type(array)).publish(array)
        boxes = self.names_of('vision_boxes', [('', 0, ''), ('', 1, '')])
        self.check_box(boxes['', 1, ''], 23.0, 7)
        self.check_ray('vision_boxes', 23.0, '')

    def test_vision_detection_3d_array(self):
        classes = message_classes('vision_msgs/Detection3DArray')
        array = self.header(classes['vision_msgs/Detection3DArray'](), 7)
        detection = classes['vision_msgs/Detection3D']()
        for number, score in ((5, 0.25), (6, 0.75)):
            detection.results.append(fill(classes['vision_msgs/ObjectHypothesisWithPose'](), id=number, score=score))
        fill(detection.bbox, center=self.pose(classes, 30.0), size=SIZE)
        field = fill(classes['sensor_msgs/PointField'](), name='x', datatype=7, count=1)
        fill(detection.source_cloud, fields=[field], data=b'\0' * 12, width=3, point_step=4, height=1)
        array.detections = [detection]
        self.publisher('vision_detections', type(array)).publish(array)
        boxes = self.names_of('vision_detections', [('6', 0, '6')])
        self.check_box(boxes['6', 0, '6'], 30.0, 7)
        self.check_ray('vision_detections', 30.0, '6')

    def test_derived_object_array(self):
        classes = message_classes('derived_object_msgs/ObjectArray')
        array = self.header(classes['derived_object_msgs/ObjectArray'](), 9, 'nowhere')
        for number, kind, sides in ((70, 1, SIZE), (71, 2, (1.0,))):  # a box and a sphere
            one = self.header(classes['derived_object_msgs/Object'](), 7)
            fill(one, id=number, object_classified=True, classification=one.CLASSIFICATION_TRUCK)
            one.polygon.points = [classes['geometry_msgs/Point32']()]
            one.pose = self.pose(classes, 40.0)
            fill(one.shape, type=kind, dimensions=list(sides))
            array.objects.append(one)
        self.publisher('derived_objects', type(array)).publish(array)
        boxes = self.names_of('derived_objects', [('TRUCK', 70, 'TRUCK')])
        self.check_box(boxes['TRUCK', 70, 'TRUCK'], 40.0, 7)
        self.check_ray('derived_objects', 40.0, 'TRUCK')

    def test_autoware_detected_object_array(self):
        classes = message_classes('autoware_msgs/DetectedObjectArray')
        array = self.header(classes['autoware_msgs/DetectedObjectArray'](), 7)
        one = self.header(classes['autoware_msgs/DetectedObject'](), 9, 'nowhere')
        fill(one, id=80, label='bus', valid=True, space_frame='map', pose=self.pose(classes, 50.0), dimensions=SIZE,
             pose_reliable=True, image_frame='camera', user_defined_info=['a', 'bc'])
        lane = classes['autoware_msgs/Lane']()
        lane.waypoints = [classes['autoware_msgs/Waypoint'](), classes['autoware_msgs/Waypoint']()]
        one.candidate_trajectories.lanes = [lane]
        one.convex_hull.polygon.points = [classes['geometry_msgs/Point32']()]
        fill(one.roi_image, encoding='bgr8', data=b'\1\2\3')
        array.objects = [one]
        self.publisher('autoware', type(array)).publish(array)
        boxes = self.names_of('autoware', [('bus', 80, 'bus')])
        self.check_box(boxes['bus', 80, 'bus'], 50.0, 7)
        self.check_ray('autoware', 50.0, 'bus')

    def test_moveit_collision_object(self):
        classes = message_classes('moveit_msgs/CollisionObject')

        def shelf(x, operation):
            one = self.header(classes['moveit_msgs/CollisionObject'](), 7)
            fill(one, id='shelf', operation=operation)
            fill(one.type, key='furniture', db='shop')
            one.primitives = [fill(classes['shape_msgs/SolidPrimitive'](), type=1, dimensions=list(SIZE))]
            one.primitive_poses = [self.pose(classes, x)]
            one.meshes = [classes['shape_msgs/Mesh']()]
            one.meshes[0].triangles = [classes['shape_msgs/MeshTriangle']()]
            one.planes = [classes['shape_msgs/Plane']()]
            one.subframe_names = ['handle']
            return one
        publisher = self.publisher('collision_objects', classes['moveit_msgs/CollisionObject'])
        publisher.publish(shelf(60.0, 0))
        first = ('shelf', 0, 'furniture')
        self.check_box(self.names_of('collision_objects', [first])[first], 60.0, 7)
        self.check_ray('collision_objects', 60.0, 'furniture')
        publisher.publish(shelf(63.0, 2))
        second = ('shelf', 1 << 32, 'furniture')
        self.check_box(self.names_of('collision_objects', [first, second])[second], 63.0, 7)
        move = self.header(classes['moveit_msgs/CollisionObject'](), 8)
        fill(move, id='shelf', operation=3)
        fill(move.pose.position, x=5.0)
        publisher.publish(move)
        self.await_ray('collision_objects', 68.0, 'furniture')
        boxes = self.names_of('collision_objects', [first, second])
        self.check_box(boxes[first], 65.0, 8)
        self.check_box(boxes[second], 68.0, 8)
        publisher.publish(shelf(0.0, 1))
        self.names_of('collision_objects', [])

    def test_moveit_planning_scene(self):
        classes = message_classes('moveit_msgs/PlanningScene')

        def crate(x):
            one = self.header(classes['moveit_msgs/CollisionObject'](), 7)
            one.id = 'crate'
            one.primitives = [fill(classes['shape_msgs/SolidPrimitive'](), type=1, dimensions=list(SIZE))]
            one.primitive_poses = [self.pose(classes, x)]
            return one
        scene = classes['moveit_msgs/PlanningScene'](name='kitchen')
        scene.robot_state.joint_state.name = ['elbow']
        scene.world.collision_objects = [crate(70.0)]
        publisher = self.publisher('planning_scene', type(scene))
        publisher.publish(scene)
        self.check_box(self.names_of('planning_scene', [('crate', 0, '')])['crate', 0, ''], 70.0, 7)
        self.check_ray('planning_scene', 70.0, '')
        scene.world.collision_objects = []
        publisher.publish(scene)
        self.names_of('planning_scene', [])

    def test_a_fork_is_named_and_does_no_harm(self):
        """A fork of jsk_recognition_msgs has a velocity under the same name."""
        name = 'jsk_recognition_msgs/BoundingBoxArray'
        forked = full_definition(name).replace('float32 value', 'geometry_msgs/Vector3 velocity\nfloat32 value')
        self.assertNotEqual(forked, full_definition(name))
        fork = generate_dynamic(name, forked)[name]
        self.publisher('unknown', fork).publish(fork())
        deadline = rospy.get_time() + TIMEOUT
        while 'unknown' not in self.get_scene(GetSceneRequest()).reason:
            if rospy.get_time() > deadline:
                break
            rospy.sleep(0.02)
        reason = self.get_scene(GetSceneRequest()).reason
        self.assertIn('%s (md5 %s) is not understood' % (name, fork._md5sum), reason)
        for known in ('jsk_recognition_msgs/BoundingBoxArray', 'vision_msgs/BoundingBox3DArray',
                      'vision_msgs/Detection3DArray', 'derived_object_msgs/ObjectArray',
                      'autoware_msgs/DetectedObjectArray', 'moveit_msgs/CollisionObject',
                      'moveit_msgs/PlanningScene'):
            self.assertIn('%s (%s)' % (known, message_classes(known)[known]._md5sum), reason)
        classes = message_classes(name)
        self.publisher('beside', classes[name]).publish(classes[name](boxes=[self.jsk_box(classes, 80.0, 3)]))
        self.check_box(self.names_of('beside', [('3', 0, '3')])['3', 0, '3'], 80.0, 7)


if __name__ == '__main__':
    rospy.init_node('test_public_messages')
    rostest.rosrun('box_query', 'public_messages', TestPublicMessages, sys.argv)
