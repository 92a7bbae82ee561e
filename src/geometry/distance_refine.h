// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Distances and their parameters, correctly rounded by double-double arithmetic.
#pragma once

#include "geometry/distance_filter.h"

#include <box_query/geometry.h>

#include <optional>

namespace box_query {

struct RoundedDistance {
  double distance;
  double t;
};

/// Nothing where double-doubles cannot tell how to round.
/// @pre slabs.isInRange(), and the solids do not meet
template <typename BoxType>
std::optional<RoundedDistance> refinedDistance(const Segment& segment, const BoxType& box,
                                               const SegmentSlabs& slabs,
                                               const NearestGuess& guess);

/// The same from a parameter near the nearest point, even if it is no better than a float. Nothing
/// also where the kernels leave it to others.
std::optional<RoundedDistance> refinedByKernel(const Segment& segment, const OrientedBox& box,
                                               double t);

/// The smallest parameter within the radius, rounded down, from a guess of it.
/// @pre slabs.isInRange(), radius > 0, the segment does not start within it but comes within it
template <typename BoxType>
std::optional<double> refinedFirstWithin(const Segment& segment, const BoxType& box,
                                         const SegmentSlabs& slabs, double radius, double guess);

}  // namespace box_query
