// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The exact part of a component that lies in the closed solid of a box.
#pragma once

#include "reference/oracle/slabs.h"

namespace box_query::oracle {

/// An end of an interval: a fraction, or -inf or +inf.
struct Bound {
  int infinity = 0;  ///< -1, 0 or +1; the value means nothing unless it is 0.
  Fraction value;
};

/// Sign of a - b; equal infinities are equal.
int compare(const Bound& a, const Bound& b);

/// What Intersection of the library describes, unrounded.
struct Interval {
  int num_points = 0;
  Bound enter;
  Bound exit;
  FaceSet entered;
  FaceSet left;
  bool started_inside = false;

  bool hit() const { return num_points > 0; }
};

Interval interval(const ExactComponent& component, const ExactBox& box);

/// (t |D|)^2, the square of a range in metres. `t` is finite.
Fraction squaredRange(const Fraction& t, const ExactComponent& component);

}  // namespace box_query::oracle
