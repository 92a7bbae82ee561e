// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Liang-Barsky clipping (paper, section 3) in exact arithmetic: the stage that always decides.
///
/// Line, ray and segment are one clip with three intervals, and an oriented box is an aligned one
/// in its own frame. With n = |q|^2 and M = n R every number of that frame is dyadic:
/// y = M^T (P - C), d = M^T D, E = n e, and M^T M = n^2 I holds exactly whatever |q| is.
#pragma once

#include "exact/dyadic.h"

#include <box_query/geometry.h>

#include <array>

namespace box_query::exact {

using Dyadic3 = std::array<Dyadic, 3>;

/// origin + t * direction with t >= 0 if has_start and t <= 1 if has_end.
struct Component {
  Dyadic3 origin;
  Dyadic3 direction;
  bool has_start;
  bool has_end;
};

Component component(const Line& line);
Component component(const Ray& ray);
Component component(const Segment& segment);

/// The points of a component that lie in a box: below_i <= t * direction_i <= above_i, in the frame
/// of the box, up to a positive factor.
struct Slabs {
  Dyadic3 below;
  Dyadic3 above;
  Dyadic3 direction;
};

Slabs slabs(const Component& component, const AlignedBox& box);
Slabs slabs(const Component& component, const OrientedBox& box);

/// num / den with den > 0, or an infinity: num = +-1, den = 0.
struct Parameter {
  Dyadic num;
  Dyadic den;
};

/// -1, 0 or 1 as a < b, a = b or a > b.
int compare(const Parameter& a, const Parameter& b);

/// What of a component lies in a box; the fields are those of Intersection. On a miss only
/// num_points and started_inside mean something.
struct Clip {
  int num_points = 0;
  bool started_inside = false;
  FaceSet entered;
  FaceSet left;
  Parameter enter;
  Parameter exit;
};

Clip clip(const Slabs& slabs, bool has_start, bool has_end);
Clip clip(const Component& component, const Box& box);

Dyadic squaredNorm(const Dyadic3& v);

/// The parameter, correctly rounded.
double rounded(const Parameter& t);

/// t * sqrt(squared_length), correctly rounded; 0 where the length is.
double roundedRange(const Parameter& t, const Dyadic& squared_length);

/// Whether |t| * sqrt(squared_length) <= range.
bool isWithin(const Parameter& t, const Dyadic& squared_length, double range);

/// origin + t * direction, every coordinate correctly rounded. (At an infinite parameter the
/// direction is zero.)
Vector3 roundedPoint(const Component& component, const Parameter& t);

}  // namespace box_query::exact
