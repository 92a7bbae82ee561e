// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Distance from a segment to a box in exact arithmetic: the stage that decides what no other can.
///
/// In the frame of a box a point of the segment is at t d from its start, and f(t) = sum_i
/// max(below_i - t d_i, 0, t d_i - above_i)^2 is its squared distance: convex, with a continuous
/// derivative, and quadratic between the break points where the segment crosses the planes of the
/// faces.
#pragma once

#include "exact/clip.h"
#include "exact/dyadic.h"

#include <box_query/geometry.h>

#include <optional>

namespace box_query::exact {

/// A segment in the frame of a box, all of it stretched by |q|^2.
struct SegmentAtBox {
  Slabs slabs;
  /// Squared distances in that frame are this many times those in the world.
  Dyadic stretch_squared;
};
SegmentAtBox segmentAtBox(const Segment& segment, const AlignedBox& box);
SegmentAtBox segmentAtBox(const Segment& segment, const OrientedBox& box);
SegmentAtBox segmentAtBox(const Segment& segment, const Box& box);

/// A ratio with den > 0.
using Ratio = Parameter;

struct Nearest {
  /// Smallest parameter in [0, 1] where the distance is smallest.
  Parameter t;
  /// The squared distance there, in the world.
  Ratio squared;
};
Nearest nearest(const SegmentAtBox& segment);

/// (p - sqrt(q)) / s with q >= 0 and s > 0: the smaller root of a quadratic; rational where q = 0.
struct Root {
  Dyadic p;
  Dyadic q;
  Dyadic s;
};
int compare(const Root& a, const Root& b);

/// The largest double that is not greater than a root in [0, 1].
double roundedDown(const Root& root);

/// Smallest parameter in [0, 1] whose point is within `radius` of the box, if there is one.
std::optional<Root> firstWithin(const SegmentAtBox& segment, double radius);

}  // namespace box_query::exact
