// SPDX-License-Identifier: BSD-3-Clause
#include "exact/rounding.h"
#include "geometry/distance_exact.h"
#include "geometry/distance_points.h"

#include <box_query/distance.h>

namespace box_query {
namespace {

template <typename AnyBox>
SegmentDistance distanceOf(const Segment& segment, const AnyBox& box) {
  const exact::Nearest nearest = exact::nearest(exact::segmentAtBox(segment, box));
  SegmentDistance result;
  result.distance = exact::roundedSqrt(nearest.squared.num, nearest.squared.den);
  result.t = exact::roundedQuotient(nearest.t.num, nearest.t.den);
  setClosestPoints(segment, box, result);
  return result;
}

template <typename AnyBox>
bool isClearOf(const Segment& segment, const AnyBox& box, double radius) {
  const exact::Nearest nearest = exact::nearest(exact::segmentAtBox(segment, box));
  return compare(nearest.squared, exact::Ratio{exact::Dyadic(radius) * radius, 1.0}) > 0;
}

template <typename AnyBox>
double blockedAtOf(const Segment& segment, const AnyBox& box, double radius) {
  const std::optional<exact::Root> root =
      exact::firstWithin(exact::segmentAtBox(segment, box), radius);
  if (!root) {
    return std::numeric_limits<double>::infinity();
  }
  return radius == 0.0 ? exact::roundedQuotient(root->p, root->s) : exact::roundedDown(*root);
}

}  // namespace

SegmentDistance distance(const Segment& segment, const AlignedBox& box) noexcept {
  return distanceOf(segment, box);
}

SegmentDistance distance(const Segment& segment, const OrientedBox& box) noexcept {
  return distanceOf(segment, box);
}

bool isClear(const Segment& segment, const AlignedBox& box, double radius) noexcept {
  return isClearOf(segment, box, radius);
}

bool isClear(const Segment& segment, const OrientedBox& box, double radius) noexcept {
  return isClearOf(segment, box, radius);
}

double blockedAt(const Segment& segment, const AlignedBox& box, double radius) noexcept {
  return blockedAtOf(segment, box, radius);
}

double blockedAt(const Segment& segment, const OrientedBox& box, double radius) noexcept {
  return blockedAtOf(segment, box, radius);
}

}  // namespace box_query
