# SPDX-License-Identifier: BSD-3-Clause
"""Scenes from CSV files, and rays and segments to ask about them: at random, and touching their boxes."""

import csv
from fractions import Fraction
import math
import os

from exact_boxes import Box, RAY, SEGMENT, neighbour

INFINITY = float('inf')


def read_scenes(path):
    """The scenes of a file: lists of (class, center, (w, x, y, z), full sizes)."""
    scenes = {}
    with open(path, newline='') as lines:
        for row in csv.DictReader(lines):
            def numbers(*names):
                return tuple(float(row[name]) for name in names)
            scenes.setdefault((row['scene'], row['stamp']), []).append(
                (row['class'], numbers('cx', 'cy', 'cz'), numbers('qw', 'qx', 'qy', 'qz'), numbers('sx', 'sy', 'sz')))
    return list(scenes.values())


def draw_scenes(folder, count, rng):
    """`count` scenes from all files of a folder, some of every file."""
    files = [read_scenes(os.path.join(folder, name)) for name in sorted(os.listdir(folder)) if name.endswith('.csv')]
    drawn = [scene for scenes in files for scene in rng.sample(scenes, count // (2 * len(files)))]
    rest = [scene for scenes in files for scene in scenes if scene not in drawn]
    return drawn + rng.sample(rest, count - len(drawn))


class Ray:
    def __init__(self, origin, direction, max_range=INFINITY):
        self.origin, self.direction, self.max_range = tuple(origin), tuple(direction), max_range

    def answer(self, boxes):
        """Every box's Interval or None, and the index of the box hit first within range, or None."""
        intervals = [box.intersect(RAY, self.origin, self.direction) for box in boxes]
        met = [i for i, interval in enumerate(intervals) if interval]
        first = min(met, key=lambda i: (intervals[i].enter, i), default=None)
        if first is not None and self.max_range < INFINITY:
            if self.squared_range(intervals[first].enter) > Fraction(self.max_range)**2:
                first = None
        return intervals, first

    def squared_range(self, t):
        return Fraction(t)**2 * sum(Fraction(d)**2 for d in self.direction)

    def outcome(self, answer):
        return answer[1] is not None

    def touches(self, boxes, answer):
        """Some box is met only by its surface, or just reached by the range."""
        return any(interval and (shrunk(box).intersect(RAY, self.origin, self.direction) is None or
                                 self.max_range < INFINITY and
                                 self.squared_range(interval.enter) == Fraction(self.max_range)**2)
                   for box, interval in zip(boxes, answer[0]))


class Segment:
    def __init__(self, start, end, radius=0.0):
        self.start, self.end, self.radius = tuple(start), tuple(end), radius

    def answer(self, boxes):
        """Every box's nearest parameter and squared distance."""
        return [box.nearest(self.start, self.end) for box in boxes]

    def outcome(self, answer):
        return all(squared > Fraction(self.radius)**2 for _, squared in answer)

    def touches(self, boxes, answer):
        """Some box is met only by its surface, or exactly as far away as the radius."""
        if self.radius > 0:
            return any(squared == Fraction(self.radius)**2 for _, squared in answer)
        return any(squared == 0 and shrunk(box).intersect(SEGMENT, self.start, self.end) is None
                   for box, (_, squared) in zip(boxes, answer))


def shrunk(box):
    """The box without its surface, nearly: what only touches the box misses this one."""
    small = Box.__new__(Box)
    small.__dict__.update(box.__dict__, half_extents=tuple(neighbour(e, -1) for e in box.half_extents))
    return small


class Queries:
    """Queries of one scene of Box. What it makes to touch boxes does so exactly where doubles name a point of
    a face, that is, where its box's axis is exactly one of the world's and its plane at a coordinate that is a
    double; else as nearly as doubles can."""

    def __init__(self, boxes, rng):
        self.boxes, self.rng = boxes, rng
        radii = [math.sqrt(sum(e * e for e in box.half_extents)) for box in boxes]
        self.low = [min(box.center[k] - r for box, r in zip(boxes, radii)) for k in range(3)]
        self.high = [max(box.center[k] + r for box, r in zip(boxes, radii)) for k in range(3)]
        faces = [face for box in boxes for i in range(3) for face in self.faces(box, i)]
        self.exact_faces = [face for face in faces if face[-1]]
        self.usable_faces = self.exact_faces or faces

    @staticmethod
    def faces(box, i):
        """(box, its axis, the world's nearest axis, side along that, coordinate on that, whether exact)"""
        axis = box.axes[i]
        k = max(range(3), key=lambda j: abs(axis[j]))
        aligned = all(axis[j] == 0 for j in range(3) if j != k)
        for side in (-1.0, 1.0):
            plane = box.center[k] + side * box.half_extents[i]
            exact = Fraction(box.center[k]) + Fraction(side * box.half_extents[i]) == Fraction(plane)
            yield box, i, k, side, plane, aligned and exact

    def vector(self, low, high):
        return [self.rng.uniform(low, high) for _ in range(3)]

    @staticmethod
    def turned(box, y):
        """Components along the axes of the box, as a vector of the world."""
        return [sum(y[i] * (box.axes[i][k] / box.n) for i in range(3)) for k in range(3)]

    def inside(self, box, part=1.0):
        y = [part * e * self.rng.uniform(-1, 1) for e in box.half_extents]
        return [c + v for c, v in zip(box.center, self.turned(box, y))]

    def near(self):
        return [self.rng.uniform(a - 0.3 * (b - a), b + 0.3 * (b - a)) for a, b in zip(self.low, self.high)]

    def random_ray(self):
        origin = self.near()
        direction = self.vector(-1, 1)
        if self.rng.random() < 0.5:
            direction = [x - y for x, y in zip(self.inside(self.rng.choice(self.boxes)), origin)]
        limited = self.rng.random() < 1 / 3
        return Ray(origin, direction, self.rng.uniform(0.01, 2 * max(map(abs, direction))) if limited else INFINITY)

    def random_segment(self):
        start = self.near()
        length = self.rng.choice((1.0, 1.0, 0.2, 0.0))
        end = [x + length * (y - x) for x, y in zip(start, self.near())]
        return Segment(start, end, self.rng.choice((0.0, self.rng.uniform(0, 0.3))))

    def face(self):
        """A face with a point of it, a direction in it, and the world's axis and side that point out of it."""
        box, i, k, side, plane, exact = self.rng.choice(self.usable_faces)
        y = [0.9 * e * self.rng.uniform(-1, 1) for e in box.half_extents]
        y[i] = box.half_extents[i] * side * (1 if box.axes[i][k] > 0 else -1)
        point = [c + v for c, v in zip(box.center, self.turned(box, y))]
        along = self.vector(-1, 1)
        along[i] = 0.0
        along = self.turned(box, along)
        if exact:
            point[k], along[k] = plane, 0.0
        return point, along, k, side

    def touching_ray(self, n):
        point, along, k, side = self.face()
        if n % 4 == 0:  # along the face
            return Ray([p - 4 * a for p, a in zip(point, along)], along)
        if n % 4 == 1:  # from the face away
            direction = self.vector(-1, 1)
            direction[k] = side * abs(direction[k])
            return Ray(point, direction)
        # Straight at the face, with a range that ends on it, or one double before: the height is small enough for
        # the range to be an exact difference.
        origin, direction = list(point), [0.0, 0.0, 0.0]
        origin[k] += side * (min(0.25, abs(point[k]) / 2) or 0.25)
        direction[k] = -side
        reach = abs(origin[k] - point[k])
        return Ray(origin, direction, reach if n % 4 == 2 else neighbour(reach, -1))

    def touching_segment(self, n):
        point, along, k, side = self.face()
        if n % 4 == 0:  # along the face
            return Segment([p - 4 * a for p, a in zip(point, along)], [p + 4 * a for p, a in zip(point, along)])
        start = [p + a for p, a in zip(point, along)]
        start[k] += side
        if n % 4 == 1:  # ends on the face
            return Segment(start, point)
        if n % 4 == 2:  # a point of the face
            return Segment(point, point)
        # Above the face, by as much as the radius or one double more: the height is an exact difference.
        above = list(point)
        above[k] += side * (min(0.02, abs(point[k]) / 2) or 0.02)
        radius = abs(above[k] - point[k])
        return Segment(above, above, radius if n % 8 == 3 else neighbour(radius, -1))

    def draw(self, random, touching, count):
        """`count` pairs of a query and its exact answer: a fifth of them touching, a quarter of each outcome."""
        drawn, outcomes, n = [], {True: 0, False: 0}, 0
        while len(drawn) < count:
            query = touching(n) if n < count // 5 else random()
            answer = query.answer(self.boxes)
            outcome = query.outcome(answer)
            if n < count // 5 or outcomes[outcome] < 3 * count // 4:
                drawn.append((query, answer))
                outcomes[outcome] += 1
            n += 1
            if n == 100 * count:
                raise RuntimeError('the scene does not have both outcomes: %r' % outcomes)
        return drawn

    def rays(self, count):
        return self.draw(self.random_ray, self.touching_ray, count)

    def segments(self, count):
        return self.draw(self.random_segment, self.touching_segment, count)
