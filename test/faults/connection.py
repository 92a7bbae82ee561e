# SPDX-License-Identifier: BSD-3-Clause
"""A TCPROS connection whose bytes are sent and read by hand."""
import socket
import struct
import xmlrpc.client

import rosgraph
from visualization_msgs.msg import MarkerArray

from world import NODE, TIMEOUT, check


def take(connection, size):
    taken = bytearray()
    while len(taken) < size:
        taken += connection.recv(size - len(taken)) or check(False, 'the connection was closed')
    return bytes(taken)


def read(connection):
    """What has its length before it: a header or a message."""
    return take(connection, *struct.unpack('<I', take(connection, 4)))


def connect(host, port, **fields):
    """A socket on which both sides have said who they are."""
    one = socket.create_connection((host, port), TIMEOUT)
    header = b''.join(struct.pack('<I', len(field)) + field.encode()
                      for field in map('='.join, {'callerid': '/client', **fields}.items()))
    one.sendall(struct.pack('<I', len(header)) + header)
    answer = read(one)
    check(b'error=' not in answer, answer)
    return one


class Viewer:
    """A subscriber of ~markers that reads only what it is told to."""

    def __init__(self):
        topic = NODE + '/markers'
        node = xmlrpc.client.ServerProxy(rosgraph.Master('/client').lookupNode(NODE))
        _, host, port = node.requestTopic('/client', topic, [['TCPROS']])[2]
        self.connection = connect(host, port, topic=topic, type=MarkerArray._type, md5sum=MarkerArray._md5sum)
        self.shown = {}  # how many points, by namespace and id

    def read(self):
        for marker in MarkerArray().deserialize(read(self.connection)).markers:
            self.shown.pop((marker.ns, marker.id), None)
            if marker.action == marker.ADD:
                self.shown[marker.ns, marker.id] = len(marker.points)
