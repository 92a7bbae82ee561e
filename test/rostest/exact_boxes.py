# SPDX-License-Identifier: BSD-3-Clause
"""What a line, a ray or a segment has in common with oriented boxes, in exact arithmetic.

Every double is taken as the rational number that it is. With n = |q|^2 the matrix n R(q) of a box is a
polynomial in q, so that in the frame of the box, scaled by n, nothing needs a root: every decision is one
between fractions.
"""

from fractions import Fraction
import struct

INFINITY = float('inf')
LINE, RAY, SEGMENT = range(3)  # as in FindIntersections.srv
INTERVALS = {LINE: (-INFINITY, INFINITY), RAY: (0, INFINITY), SEGMENT: (0, 1)}


def integers(doubles):
    """The doubles as integers over one common denominator, a power of two."""
    ratios = [x.as_integer_ratio() for x in doubles]
    denominator = max(d for _, d in ratios)
    return [n * (denominator // d) for n, d in ratios], denominator


def squared_length(doubles):
    return sum(Fraction(x)**2 for x in doubles)


class Interval:
    """The parameters at which a component is in a box, the faces there, and whether its start is."""

    def __init__(self, enter, leave, entered, left, is_point, started_inside):
        self.enter = enter
        self.leave = leave
        self.entered = entered  # bit 2 i: negative side of axis i, bit 2 i + 1: positive side
        self.left = left
        self.num_points = 1 if is_point or enter == leave else 2
        self.started_inside = started_inside


class Box:
    def __init__(self, center, orientation, half_extents):
        """center and half_extents as (x, y, z), orientation as (w, x, y, z), all doubles."""
        self.center = tuple(center)
        self.half_extents = tuple(half_extents)
        (w, x, y, z), _ = integers(orientation)
        self.n = w * w + x * x + y * y + z * z
        self.axes = (  # n times the unit vectors
            (w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)),
            (2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)),
            (2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z))

    def in_frame(self, kind, a, b):
        """Origin, direction and extents along the axes, and what they must be divided by to be metres."""
        numbers, denominator = integers(tuple(a) + tuple(b) + self.center + self.half_extents)
        origin, direction, center, extents = (numbers[i:i + 3] for i in range(0, 12, 3))
        if kind == SEGMENT:
            direction = [y - x for x, y in zip(origin, direction)]
        offset = [x - y for x, y in zip(origin, center)]
        return ([sum(u * v for u, v in zip(axis, offset)) for axis in self.axes],
                [sum(u * v for u, v in zip(axis, direction)) for axis in self.axes],
                [self.n * e for e in extents], self.n * denominator)

    def intersect(self, kind, a, b):
        """The Interval of a component with the closed box, or None."""
        origin, direction, extents, _ = self.in_frame(kind, a, b)
        start, end = enter, leave = INTERVALS[kind]
        planes = []
        for i, (y, d, e) in enumerate(zip(origin, direction, extents)):
            if d == 0:
                if abs(y) > e:
                    return None
                continue
            s = 1 if d > 0 else -1
            near, far = Fraction(-s * e - y, d), Fraction(s * e - y, d)
            planes.append((near, far, 2 * i + (s < 0), 2 * i + (s > 0)))
            enter, leave = max(enter, near), min(leave, far)
        if enter > leave:
            return None
        entered = sum(1 << face for near, _, face, _ in planes if near == enter)
        left = sum(1 << face for _, far, _, face in planes if far == leave)
        inside = kind != LINE and all(abs(y) <= e for y, e in zip(origin, extents))
        return Interval(enter, leave, entered, left, not any(direction), inside)

    def profile(self, a, b):
        """The squared distance [m^2] of a segment's point at t, as a function of t."""
        origin, direction, extents, unit = self.in_frame(SEGMENT, a, b)

        def squared_distance(t):
            n, m = Fraction(t).numerator, Fraction(t).denominator
            excess = (max(abs(y * m + n * d) - e * m, 0) for y, d, e in zip(origin, direction, extents))
            return Fraction(sum(x * x for x in excess), (m * unit)**2)

        return squared_distance

    def nearest(self, a, b):
        """The smallest parameter of a segment's nearest point, and the squared distance [m^2] there.

        Half the derivative of the squared distance is piecewise linear and never decreases: the first break
        point at which it is not negative, or the zero before that, is the place.
        """
        origin, direction, extents, _ = self.in_frame(SEGMENT, a, b)
        breaks = {Fraction(0), Fraction(1)}
        for y, d, e in zip(origin, direction, extents):
            if d != 0:
                breaks.update(t for t in (Fraction(e - y, d), Fraction(-e - y, d)) if 0 < t < 1)

        def slope(t):
            total, n, m = 0, t.numerator, t.denominator
            for y, d, e in zip(origin, direction, extents):
                x, e = y * m + n * d, e * m
                total += d * (x - e if x > e else x + e if x < -e else 0)
            return Fraction(total, m)

        place, before, slope_before = Fraction(1), None, None
        for t in sorted(breaks):
            slope_here = slope(t)
            if slope_here >= 0:
                place = t
                if slope_here > 0 and before is not None:
                    place = before + (t - before) * slope_before / (slope_before - slope_here)
                break
            before, slope_before = t, slope_here
        return place, self.profile(a, b)(place)


def neighbour(x, step):
    """The double that is `step` (1 or -1) away from a double x >= 0 among all of them in order."""
    bits, = struct.unpack('<q', struct.pack('<d', abs(x)))
    return struct.unpack('<d', struct.pack('<q', bits + step))[0] if bits + step >= 0 else -5e-324


def is_even(x):
    return struct.unpack('<q', struct.pack('<d', x))[0] % 2 == 0


def is_rounded(x, exact):
    """Whether the finite double x is the one nearest to the fraction, ties to even."""
    if x < 0 or (x == 0 and exact < 0):
        x, exact = abs(x), -exact
    low = (Fraction(x) + Fraction(neighbour(x, -1))) / 2
    high = (Fraction(x) + Fraction(neighbour(x, 1))) / 2
    return low <= exact <= high if is_even(x) else low < exact < high


def is_rounded_root(x, square):
    """Whether the finite double x >= 0 is the one nearest to the square root of a fraction, ties to even."""
    low = max((Fraction(x) + Fraction(neighbour(x, -1))) / 2, 0)**2
    high = ((Fraction(x) + Fraction(neighbour(x, 1))) / 2)**2
    return low <= square <= high if is_even(x) else low < square < high
