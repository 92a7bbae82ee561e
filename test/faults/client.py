#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A client of the node that is not as clients should be.

  batch   asks what a million rays hit, which takes minutes among many boxes, and prints what became of it
  silent  sends half a request, and nothing more
  deaf    asks for an answer of megabytes, and reads none of it
The latter two print a line when they have begun, and stay until they are killed.
"""
import io
import struct
import sys
import time

import rosgraph
import rospy
from box_query.srv import CastRays, CastRaysRequest
from geometry_msgs.msg import Point, Vector3

from connection import connect

SERVICE = '/box_query/cast_rays'


def request(rays):
    one = CastRaysRequest(origins=[Point(0, 0.3, 0.3)], directions=[Vector3(1, 0, 0)] * rays, want_points=True,
                          want_normals=True)
    one.header.frame_id = 'map'
    return one


def batch():
    rospy.init_node('batch', disable_rosout=True)
    try:
        answer = rospy.ServiceProxy(SERVICE, CastRays)(request(1000000))
        print('answered' if answer.success else 'refused: ' + answer.message)
    except (rospy.ServiceException, OSError):
        print('the connection was closed')


def main():
    role = sys.argv[1]
    if role == 'batch':
        return batch()
    host, port = rosgraph.Master('/client').lookupService(SERVICE)[len('rosrpc://'):].split(':')
    one = connect(host, int(port), service=SERVICE, md5sum=CastRays._md5sum)
    body = io.BytesIO()
    request(100000).serialize(body)
    body = body.getvalue()
    one.sendall(struct.pack('<I', len(body)) + (body if role == 'deaf' else body[:len(body) // 2]))
    print('begun', flush=True)
    time.sleep(3600)


if __name__ == '__main__':
    main()
