# SPDX-License-Identifier: BSD-3-Clause
"""A master, a node and what publishes to it, each a process of its own that can be killed."""
import contextlib
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import xmlrpc.client

import rosgraph
import rospy
from box_query.srv import CastRay, CastRayRequest, GetScene, GetSceneRequest
from geometry_msgs.msg import Vector3

TIMEOUT = 120.0  # [s] for whatever is waited for: it is measured, and never fails for being slow
NODE = '/box_query'
FOLDER = os.path.dirname(os.path.abspath(__file__))


def free_port():
    with socket.socket() as one:
        one.bind(('127.0.0.1', 0))
        return one.getsockname()[1]


def megabytes(pid, key='VmRSS'):
    """Memory of a process: VmRSS is what is resident now, VmHWM the most that ever was."""
    with open('/proc/%d/status' % pid) as status:
        return next(int(line.split()[1]) / 1024 for line in status if line.startswith(key + ':'))


class Fault(AssertionError):
    """A promise that was not kept."""


def check(kept, *what):
    if not kept:
        raise Fault(' '.join(map(str, what)))


class Speaker:
    """A process of speaker.py: speaks from `since` on."""

    def __init__(self, world, arguments):
        self.process = world.start([sys.executable, os.path.join(FOLDER, 'speaker.py')] + list(map(str, arguments)),
                                   stdout=subprocess.PIPE)
        self.since = float(self.process.stdout.readline() or 'nan')
        check(self.since == self.since, 'a publisher did not start:', arguments)

    def end(self, by=signal.SIGKILL):
        self.process.send_signal(by)
        self.process.wait(TIMEOUT)


class World:
    """Ends all of its processes at its end, however that comes."""

    def __init__(self, node):
        self.node_path = node
        self.processes = []
        self.node = None
        self.speakers = 0
        self.proxies = {}

    def __enter__(self):
        self.stack = contextlib.ExitStack()
        home = self.stack.enter_context(tempfile.TemporaryDirectory())
        self.stack.callback(self.end)
        self.port = free_port()
        os.environ.update(ROS_MASTER_URI='http://127.0.0.1:%d' % self.port, ROS_IP='127.0.0.1', ROS_HOME=home,
                          ROS_LOG_DIR=home)
        self.start_master()
        rospy.init_node('asker', disable_signals=True, disable_rosout=True)
        return self

    def __exit__(self, *error):
        return self.stack.__exit__(*error)

    def start(self, command, **options):
        self.processes.append(subprocess.Popen(command, stdin=subprocess.DEVNULL, **options))
        return self.processes[-1]

    def end(self):
        for by in signal.SIGTERM, signal.SIGKILL:  # roslaunch ends its own nodes
            for process in filter(lambda one: one.poll() is None, reversed(self.processes)):
                process.send_signal(by)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(TIMEOUT)

    def start_master(self):
        """Returns the time from which on it answers."""
        self.master = self.start(['rosmaster', '--core', '-p', str(self.port)], stdout=subprocess.DEVNULL)
        return self.until(lambda: rosgraph.Master('/asker').is_online(), 'a master')

    def start_node(self, **parameters):
        for name, value in parameters.items():
            rospy.set_param(NODE + '/' + name, value)
        self.node = self.start([self.node_path])
        self.until(lambda: self.node.poll() is not None or self.scene(), 'the node')
        check(self.node.poll() is None, 'the node did not start')

    def launch(self, *arguments):
        """The node, by its launch file."""
        self.start(['roslaunch', 'box_query', 'box_query.launch'] + list(arguments))
        self.until(self.scene, 'the launched node')

    def node_pid(self):
        if self.node:
            return self.node.pid
        address = rosgraph.Master('/asker').lookupNode(NODE)
        return xmlrpc.client.ServerProxy(address).getPid('/asker')[2]

    def speak(self, *arguments, name=None):
        self.speakers += 1
        return Speaker(self, [name or 'speaker_%d' % self.speakers, *arguments])

    def client(self, role, await_line=True):
        one = self.start([sys.executable, os.path.join(FOLDER, 'client.py'), role], stdout=subprocess.PIPE)
        check(not await_line or one.stdout.readline(), 'no client')
        return one

    def long_batch(self):
        """A client whose batch the node works on for minutes. It prints the answer."""
        def cpu():
            with open('/proc/%d/stat' % self.node_pid()) as stat:
                return sum(map(int, stat.read().rpartition(')')[2].split()[11:13])) / os.sysconf('SC_CLK_TCK')
        before = cpu()
        client = self.client('batch', await_line=False)
        self.until(lambda: cpu() > before + 1.0, 'work on the batch')
        check(client.poll() is None, 'the batch has ended already')
        return client

    def scene(self):
        """What the node knows, or None if it does not answer."""
        return self.call('get_scene', GetScene, GetSceneRequest())

    def described(self):
        """The scene, for a message."""
        scene = self.scene()
        return scene and 'the scene has %s: %s' % (
            [(topic, number, pose.position.x) for topic, number, pose in
             zip(scene.box_topics[:20], scene.box_ids, scene.poses)], scene.reason or 'complete')

    def ray(self):
        """What a ray from the map's origin along x hits, or None if the node does not answer."""
        request = CastRayRequest(direction=Vector3(1, 0, 0), allow_incomplete=True)
        request.header.frame_id = 'map'
        return self.call('cast_ray', CastRay, request)

    @contextlib.contextmanager
    def connected(self):
        """Within this, calls go through connections that are there before."""
        self.proxies = {name: rospy.ServiceProxy(NODE + '/' + name, kind, persistent=True)
                        for name, kind in (('get_scene', GetScene), ('cast_ray', CastRay))}
        check(self.scene() and self.ray(), 'the node does not answer')
        try:
            yield
        finally:
            self.proxies = {}

    def call(self, service, kind, request):
        try:
            return (self.proxies.get(service) or rospy.ServiceProxy(NODE + '/' + service, kind))(request)
        except (rospy.ServiceException, rospy.ROSException, OSError):
            return None

    def answers(self, x, count, complete=True):
        """Whether the nearest of so many unit cubes (None: of any number) is said to be at x, exactly."""
        ray = self.ray()
        if not (ray and ray.success and ray.hit and ray.range == x - 0.5 and ray.complete == complete):
            return False
        scene = count and self.scene()
        return not count or scene is not None and len(scene.box_ids) == count and scene.complete == complete

    def until(self, condition, what):
        """Waits for `condition` and returns the monotonic time at which it held."""
        deadline = time.monotonic() + TIMEOUT
        while not condition():
            if time.monotonic() > deadline:
                raise Fault('%s did not come; %s' % (what, self.described()))
            time.sleep(0.005)
        return time.monotonic()

    def await_reason(self, *words):
        """Waits until the scene is incomplete for a reason with these words, and returns it."""
        seen = []

        def names_it():
            scene = self.scene()
            seen.append(scene.reason if scene else 'no answer')
            return scene and not scene.complete and all(word in scene.reason for word in words)

        try:
            self.until(names_it, 'a reason')
        except Fault:
            raise Fault('%s is not in "%s"' % (words, seen[-1]))
        return seen[-1]
