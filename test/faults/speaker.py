#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A process that publishes until it is killed. It prints the monotonic time of its first message.

  boxes TOPIC TYPE FRAME X ID...   unit cubes at X, as a MarkerArray, one Marker (a CUBE_LIST) or, of no box, a String
  tf PARENT CHILD X                where CHILD is, now
  clock SECONDS                    /clock from then on, as fast as the wall's
"""
import sys
import time

import rospy
from geometry_msgs.msg import Point, TransformStamped, Vector3
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

PERIOD = 0.02  # [s] between two messages


def cube(frame, x, number):
    marker = Marker(type=Marker.CUBE, ns='cubes', id=number, scale=Vector3(1, 1, 1))
    marker.header.frame_id = frame
    marker.header.stamp = rospy.Time.now() if frame != 'map' else rospy.Time()
    marker.pose.position.x = x
    marker.pose.orientation.w = 1.0
    return marker


def boxes(topic, kind, frame, x, *ids):
    if kind == 'String':
        return topic, String, lambda: String('no box')
    if kind == 'Marker':
        def cubes():
            marker = cube(frame, float(x), int(ids[0]))
            marker.type = Marker.CUBE_LIST
            marker.points = [Point() for _ in ids]
            return marker
        return topic, Marker, cubes
    return topic, MarkerArray, lambda: MarkerArray([cube(frame, float(x), int(number)) for number in ids])


def tf(parent, child, x):
    def transform():
        one = TransformStamped(child_frame_id=child)
        one.header.frame_id = parent
        one.header.stamp = rospy.Time.now()
        one.transform.translation.x = float(x)
        one.transform.rotation.w = 1.0
        return TFMessage([one])
    return '/tf', TFMessage, transform


def clock(start):
    began = time.monotonic()
    return '/clock', Clock, lambda: Clock(rospy.Time(float(start) + time.monotonic() - began))


def main():
    name, role, *arguments = sys.argv[1:]
    rospy.init_node(name, disable_rosout=True)
    topic, kind, message = {'boxes': boxes, 'tf': tf, 'clock': clock}[role](*arguments)
    publisher = rospy.Publisher(topic, kind, queue_size=1, latch=role == 'boxes')
    publisher.publish(message())
    print(time.monotonic(), flush=True)
    while not rospy.is_shutdown():
        publisher.publish(message())
        time.sleep(PERIOD)


if __name__ == '__main__':
    main()
