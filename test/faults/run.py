#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""One fault, with real processes: what the node says during it, how soon it is right again after it, what it takes.

  run.py FAULT NODE   FAULT is the name of a function fault_FAULT of this folder, NODE the path of box_query_node
"""
import glob
import importlib
import os
import sys
import time

from world import FOLDER, World, check, megabytes

GROWTH = 64.0  # [MB] that a fault may leave behind, unless it says otherwise


class Report:
    """What was seen, as it is printed."""

    def __init__(self, world):
        self.world = world
        self.growth = GROWTH
        self.most = None  # [MB] that the node may take at any time beside what it had before
        self.before = None

    def begin(self):
        """All is well: the fault begins now."""
        self.before = megabytes(self.world.node_pid())

    def during(self, reason):
        print('  meanwhile: ' + reason)

    def stays(self, x, count, what, complete=True):
        """The answer during the fault, for a while."""
        for _ in range(10):
            check(self.world.answers(x, count, complete), 'expected', what, 'but', self.world.described())
            time.sleep(0.05)
        print('  meanwhile: ' + what)

    def right_again(self, since, x, count, after='its end'):
        """The answer that is right from `since` on: when did it come?"""
        seconds = self.world.until(lambda: self.world.answers(x, count), 'the right answer') - since
        print('  right again %.2f s after %s' % (seconds, after), flush=True)

    def end(self):
        check(self.before is not None, 'the fault never began')
        after = megabytes(self.world.node_pid())
        most = megabytes(self.world.node_pid(), 'VmHWM')
        print('  resident %.0f MB before, %.0f MB after, at most %.0f MB' % (self.before, after, most))
        check(after < self.before + self.growth, 'memory grew by more than', self.growth, 'MB')
        check(self.most is None or most < self.before + self.most, 'memory was more than', self.most, 'MB beyond')


def find(name):
    for path in glob.glob(os.path.join(FOLDER, '*_faults.py')):
        module = importlib.import_module(os.path.splitext(os.path.basename(path))[0])
        if hasattr(module, 'fault_' + name):
            return getattr(module, 'fault_' + name)
    sys.exit('there is no fault ' + name)


def main():
    fault = find(sys.argv[1])
    print(fault.__doc__)
    began = time.monotonic()
    with World(sys.argv[2]) as world:
        report = Report(world)
        fault(world, report)
        report.end()
        if world.node:  # it was not ended by the fault: it ends well now
            check(world.node.poll() is None, 'the node ended with', world.node.poll())
            world.node.terminate()
            check(world.node.wait(60) == 0, 'the node ended with', world.node.returncode)
    print('  %.1f s in all' % (time.monotonic() - began))


if __name__ == '__main__':
    main()
