// SPDX-License-Identifier: BSD-3-Clause
#include "exact/clip.h"

#include <box_query/intersection.h>

namespace box_query {
namespace {

template <typename T, typename BoxType>
bool test(const T& linear, const BoxType& box) {
  return exact::clip(exact::component(linear), box).num_points > 0;
}

template <typename T, typename BoxType>
Intersection find(const T& linear, const BoxType& box) {
  const exact::Component component = exact::component(linear);
  const exact::Clip clip = exact::clip(component, box);
  Intersection result;
  result.num_points = clip.num_points;
  result.started_inside = clip.started_inside;
  if (clip.num_points > 0) {
    result.t_enter = exact::rounded(clip.enter);
    result.t_exit = exact::rounded(clip.exit);
    result.entered = clip.entered;
    result.left = clip.left;
    result.enter_point = exact::roundedPoint(component, clip.enter);
    result.exit_point = exact::roundedPoint(component, clip.exit);
  }
  return result;
}

template <typename T, typename BoxType>
IntersectionRanges ranges(const T& linear, const BoxType& box) {
  const exact::Component component = exact::component(linear);
  const exact::Clip clip = exact::clip(component, box);
  if (clip.num_points == 0) {
    return {};
  }
  const exact::Dyadic squared_length = exact::squaredNorm(component.direction);
  return {exact::roundedRange(clip.enter, squared_length),
          exact::roundedRange(clip.exit, squared_length)};
}

}  // namespace

bool testIntersection(const Line& line, const AlignedBox& box) noexcept {
  return test(line, box);
}
bool testIntersection(const Ray& ray, const AlignedBox& box) noexcept {
  return test(ray, box);
}
bool testIntersection(const Segment& segment, const AlignedBox& box) noexcept {
  return test(segment, box);
}
bool testIntersection(const Line& line, const OrientedBox& box) noexcept {
  return test(line, box);
}
bool testIntersection(const Ray& ray, const OrientedBox& box) noexcept {
  return test(ray, box);
}
bool testIntersection(const Segment& segment, const OrientedBox& box) noexcept {
  return test(segment, box);
}

Intersection findIntersection(const Line& line, const AlignedBox& box) noexcept {
  return find(line, box);
}
Intersection findIntersection(const Ray& ray, const AlignedBox& box) noexcept {
  return find(ray, box);
}
Intersection findIntersection(const Segment& segment, const AlignedBox& box) noexcept {
  return find(segment, box);
}
Intersection findIntersection(const Line& line, const OrientedBox& box) noexcept {
  return find(line, box);
}
Intersection findIntersection(const Ray& ray, const OrientedBox& box) noexcept {
  return find(ray, box);
}
Intersection findIntersection(const Segment& segment, const OrientedBox& box) noexcept {
  return find(segment, box);
}

IntersectionRanges findRanges(const Line& line, const AlignedBox& box) noexcept {
  return ranges(line, box);
}
IntersectionRanges findRanges(const Ray& ray, const AlignedBox& box) noexcept {
  return ranges(ray, box);
}
IntersectionRanges findRanges(const Segment& segment, const AlignedBox& box) noexcept {
  return ranges(segment, box);
}
IntersectionRanges findRanges(const Line& line, const OrientedBox& box) noexcept {
  return ranges(line, box);
}
IntersectionRanges findRanges(const Ray& ray, const OrientedBox& box) noexcept {
  return ranges(ray, box);
}
IntersectionRanges findRanges(const Segment& segment, const OrientedBox& box) noexcept {
  return ranges(segment, box);
}

}  // namespace box_query
