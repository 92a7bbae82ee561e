// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Exact distance from a segment to the closed solid of a box.
#pragma once

#include "reference/oracle/slabs.h"

#include <optional>

namespace box_query::oracle {

/// The smallest squared distance, and the smallest parameter at which it is attained.
struct Nearest {
  Fraction squared;
  Fraction t;
};

Nearest nearest(const ExactComponent& segment, const ExactBox& box);

/// Squared distance of the point at t, any finite number, from the box.
Fraction squaredDistanceAt(const ExactComponent& component, const ExactBox& box, const Fraction& t);

/// Whether the distance is greater than the radius.
bool isClear(const ExactComponent& segment, const ExactBox& box, double radius);

/// Smallest t in [0, 1] whose point is within the radius; nothing if the segment is clear.
std::optional<Root> firstWithin(const ExactComponent& segment, const ExactBox& box, double radius);
/// The same where nearest(segment, box) is known already.
std::optional<Root> firstWithin(const ExactComponent& segment, const ExactBox& box, double radius,
                                const Nearest& best);

}  // namespace box_query::oracle
