// SPDX-License-Identifier: BSD-3-Clause
#include "exact/rounding.h"
#include "exact/stage_counters.h"
#include "geometry/aligned_form.h"
#include "geometry/distance_exact.h"
#include "geometry/distance_points.h"
#include "geometry/distance_query.h"
#include "geometry/flat_distance.h"
#include "geometry/prepared_box.h"
#include "geometry/solve.h"

#include <box_query/distance.h>
#include <box_query/intersection.h>

#include <optional>
#include <utility>

namespace box_query {
namespace {

template <typename BoxType>
NearestEstimate estimateOf(const Segment& segment, const BoxType& box) {
  return estimateNearest(segment, doubleSlabs(box));
}

/// The parameter from which on a segment is in a box.
template <typename BoxType>
std::optional<double> firstMeeting(const Segment& segment, const BoxType& box) {
  Solution solution = solve(segment, doubleComponent(segment), box);
  return solution.num_points > 0
             ? std::optional<double>(roundedParameter(segment, box, solution, End::kEnter))
             : std::nullopt;
}

template <typename BoxType>
RoundedDistance nearestOf(const Segment& segment, const BoxType& box, const NearestEstimate& e) {
  if (e.bounds.lower > 0.0) {
    if (const auto refined = refinedDistance(segment, box, e.slabs, e.guess)) {
      return *refined;
    }
  } else if (startsInside(e.slabs)) {
    return {0.0, 0.0};
  } else if (const auto t = firstMeeting(segment, box)) {
    return {0.0, *t};
  }
  if (const auto flat = flatDistance(segment, box)) {
    return {exact::roundedSqrt(flat->squared, 1.0),
            findIntersection(segment, flat->shadow).t_enter};
  }
  ++exact::stageCounters().exact_roundings;
  const exact::Nearest nearest = exact::nearest(exact::segmentAtBox(segment, box));
  return {exact::roundedSqrt(nearest.squared.num, nearest.squared.den),
          exact::roundedQuotient(nearest.t.num, nearest.t.den)};
}

template <typename BoxType>
double blockedAtOf(const Segment& segment, const BoxType& box, double radius) {
  if (radius == 0.0) {
    return findIntersection(segment, box).t_enter;
  }
  const NearestEstimate estimate = estimateOf(segment, box);
  return isFarther(segment, box, estimate.bounds, radius)
             ? std::numeric_limits<double>::infinity()
             : roundedFirstWithin(segment, box, estimate, radius);
}

}  // namespace

template <typename BoxType>
SegmentDistance roundedDistance(const Segment& segment, const BoxType& box,
                                const NearestEstimate& estimate) {
  const RoundedDistance nearest = nearestOf(segment, box, estimate);
  SegmentDistance result;
  result.distance = nearest.distance;
  result.t = nearest.t;
  setClosestPoints(segment, box, result);
  return result;
}

template <typename BoxType>
SegmentDistance distanceOfMet(const Segment& segment, const BoxType& box) {
  SegmentDistance result;
  result.distance = 0.0;
  result.t = *firstMeeting(segment, box);
  setClosestPoints(segment, box, result);
  return result;
}

SegmentDistance fromInside(const Segment& segment) {
  SegmentDistance result;
  result.distance = 0.0;
  result.t = 0.0;
  result.on_segment = pointAt(segment, 0.0);
  result.on_box = result.on_segment;
  return result;
}

template <typename BoxType>
exact::Ratio exactSquaredDistance(const Segment& segment, const BoxType& box) {
  if (auto flat = flatDistance(segment, box)) {
    return {std::move(flat->squared), 1.0};
  }
  ++exact::stageCounters().exact_decisions;
  return exact::nearest(exact::segmentAtBox(segment, box)).squared;
}

template <typename BoxType>
bool isFarther(const Segment& segment, const BoxType& box, const DistanceBounds& bounds,
               double radius) {
  if (bounds.lower > radius) {
    return true;
  }
  if (bounds.upper <= radius) {
    return false;
  }
  if (radius == 0.0) {
    return !testIntersection(segment, box);
  }
  return compare(exactSquaredDistance(segment, box),
                 exact::Ratio{exact::Dyadic(radius) * radius, 1.0}) > 0;
}

template <typename BoxType>
double roundedFirstWithin(const Segment& segment, const BoxType& box,
                          const NearestEstimate& estimate, double radius) {
  const SegmentSlabs& slabs = estimate.slabs;
  if (slabs.isInRange()) {
    const Excess start = excessAt(slabs, 0.0);
    if (std::sqrt(dot(start, start)) + slabs.error() <= radius) {
      return 0.0;
    }
    const double guess = guessFirstWithin(slabs, radius);
    if (const auto refined = refinedFirstWithin(segment, box, slabs, radius, guess)) {
      return *refined;
    }
  }
  ++exact::stageCounters().exact_roundings;
  return exact::roundedDown(*exact::firstWithin(exact::segmentAtBox(segment, box), radius));
}

template exact::Ratio exactSquaredDistance(const Segment&, const AlignedBox&);
template exact::Ratio exactSquaredDistance(const Segment&, const OrientedBox&);
template SegmentDistance roundedDistance(const Segment&, const AlignedBox&, const NearestEstimate&);
template SegmentDistance roundedDistance(const Segment&, const OrientedBox&,
                                         const NearestEstimate&);
template SegmentDistance distanceOfMet(const Segment&, const AlignedBox&);
template SegmentDistance distanceOfMet(const Segment&, const OrientedBox&);
template bool isFarther(const Segment&, const AlignedBox&, const DistanceBounds&, double);
template bool isFarther(const Segment&, const OrientedBox&, const DistanceBounds&, double);
template double roundedFirstWithin(const Segment&, const AlignedBox&, const NearestEstimate&,
                                   double);
template double roundedFirstWithin(const Segment&, const OrientedBox&, const NearestEstimate&,
                                   double);

SegmentDistance distance(const Segment& segment, const AlignedBox& box) noexcept {
  return roundedDistance(segment, box, estimateOf(segment, box));
}

SegmentDistance distance(const Segment& segment, const OrientedBox& box) noexcept {
  if (const auto form = alignedForm(box)) {
    return distance(segment, form->box);
  }
  return roundedDistance(segment, box, estimateOf(segment, box));
}

bool isClear(const Segment& segment, const AlignedBox& box, double radius) noexcept {
  return isFarther(segment, box, estimateOf(segment, box).bounds, radius);
}

bool isClear(const Segment& segment, const OrientedBox& box, double radius) noexcept {
  if (const auto form = alignedForm(box)) {
    return isClear(segment, form->box, radius);
  }
  return isFarther(segment, box, estimateOf(segment, box).bounds, radius);
}

double blockedAt(const Segment& segment, const AlignedBox& box, double radius) noexcept {
  return blockedAtOf(segment, box, radius);
}

double blockedAt(const Segment& segment, const OrientedBox& box, double radius) noexcept {
  if (const auto form = alignedForm(box)) {
    return blockedAt(segment, form->box, radius);
  }
  return blockedAtOf(segment, box, radius);
}

}  // namespace box_query
