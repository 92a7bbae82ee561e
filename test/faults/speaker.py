#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A process that publishes until it is killed. It prints the monotonic time of its first message.

  boxes TOPIC TYPE FRAME X ID...   unit cubes at X, as a MarkerArray, one Marker (a CUBE_LIST) or, of no box, a String
  many TOPIC COUNT FRAME HOW       as one CUBE_LIST: with another id (flood) or elsewhere (moves) each time, once (once),
                                   or turned so that rays along them look at each (row)
  torrent TOPIC COUNT FRAME        as a MarkerArray, the same again and again as fast as it can
  tf PARENT CHILD X                where CHILD is, now
  clock SECONDS                    /clock from then on, as fast as the wall's
"""
import io
import itertools
import math
import struct
import sys
import time
import warnings

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


def many(topic, count, frame, how):
    """Serialised only once: it is to be sent as fast as can be."""
    turn = 0.5 * math.pi / 4 if how == 'row' else 0.0
    start = 4.0 if how == 'row' else 1.0
    step = 2.0**-10 if how == 'once' else 1.0
    marker = cube(frame, 0.0, 0)
    marker.type = Marker.CUBE_LIST
    marker.pose.orientation.x, marker.pose.orientation.w = math.sin(turn), math.cos(turn)
    marker.scale = Vector3(0.5, 0.5, 0.5) if how == 'row' else Vector3(1, 1, 1)
    empty = io.BytesIO()
    marker.serialize(empty)
    # Before the points: all but two empty arrays, two empty strings and a flag.
    head, tail = empty.getvalue()[:-17], empty.getvalue()[-13:]
    points = b''.join(struct.pack('<3d', start + step * i, 0, 0) for i in range(int(count)))
    number = head.index(b'cubes') + len(b'cubes')  # the id; a type and an action are before the position
    at, form = (number + 12, '<d') if how == 'moves' else (number, '<i')
    numbers = itertools.count(1) if how in ('flood', 'moves') else itertools.repeat(0)

    class Many(Marker):
        def serialize(self, buffer):
            buffer.write(head[:at] + struct.pack(form, next(numbers)) + head[at + struct.calcsize(form):])
            buffer.write(struct.pack('<I', int(count)) + points + tail)

    return topic, Many, Many


def torrent(topic, count, frame):
    array = io.BytesIO()
    MarkerArray([cube(frame, 1.0, number) for number in range(int(count))]).serialize(array)

    class Torrent(MarkerArray):
        def serialize(self, buffer):
            buffer.write(array.getbuffer())

    return topic, Torrent, Torrent


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
    topic, kind, message = {'boxes': boxes, 'many': many, 'torrent': torrent, 'tf': tf, 'clock': clock}[role](*arguments)
    # Without a queue, of which rospy warns, it waits until the receiver has read each message.
    warnings.simplefilter('ignore', SyntaxWarning)
    publisher = rospy.Publisher(topic, kind, queue_size=None if role == 'torrent' else 1, latch=role in ('boxes', 'many'))
    publisher.publish(message())
    print(time.monotonic(), flush=True)
    once = arguments[-1] in ('once', 'row')
    while not rospy.is_shutdown():
        if role != 'torrent':
            time.sleep(PERIOD)  # short: a signal to end does not cut it
        if not once:
            publisher.publish(message())


if __name__ == '__main__':
    main()
