// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The stages of a distance query in order, for a box alone and for the boxes of a scene.
#pragma once

#include "geometry/distance_exact.h"
#include "geometry/distance_filter.h"
#include "geometry/distance_refine.h"

#include <box_query/distance.h>

namespace box_query {

/// What the first stage knows of a segment and a box: nothing, where their numbers are out of
/// range.
struct NearestEstimate {
  SegmentSlabs slabs{};
  NearestGuess guess{};
  DistanceBounds bounds{0.0, std::numeric_limits<double>::infinity()};
};

template <typename SlabsType>
inline NearestEstimate estimateNearest(const Segment& segment, const SlabsType& box) {
  NearestEstimate e{segmentSlabs(segment, box)};
  if (e.slabs.isInRange()) {
    e.guess = guessNearest(e.slabs);
    e.bounds = distanceBounds(e.slabs, e.guess.excess);
  }
  return e;
}

/// Distance and parameter, correctly rounded, with the points.
template <typename BoxType>
SegmentDistance roundedDistance(const Segment& segment, const BoxType& box,
                                const NearestEstimate& estimate);

/// The same of a segment that meets the box.
template <typename BoxType>
SegmentDistance distanceOfMet(const Segment& segment, const BoxType& box);

/// The same of a segment that certainly starts in a box.
SegmentDistance fromInside(const Segment& segment);

/// The squared distance, exactly: what decides where nothing else does.
template <typename BoxType>
exact::Ratio exactSquaredDistance(const Segment& segment, const BoxType& box);

/// Whether the exact distance is greater than the radius.
template <typename BoxType>
bool isFarther(const Segment& segment, const BoxType& box, const DistanceBounds& bounds,
               double radius);

/// See blockedAt(), for a segment that is not clear of the box.
template <typename BoxType>
double roundedFirstWithin(const Segment& segment, const BoxType& box,
                          const NearestEstimate& estimate, double radius);

}  // namespace box_query
