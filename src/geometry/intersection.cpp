// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/aligned_form.h"
#include "geometry/solve.h"

#include <box_query/intersection.h>

namespace box_query {
namespace {

template <typename T>
bool test(const T& linear, const AlignedBox& box) {
  return meets(linear, box, prepared(box));
}

template <typename T>
bool test(const T& linear, const OrientedBox& box) {
  if (const auto form = alignedForm(box)) {
    return test(linear, form->box);
  }
  return meets(linear, box, prepared(box));
}

template <typename T, typename BoxType>
Intersection findInOwnFrame(const T& linear, const BoxType& box) {
  const DoubleComponent component = doubleComponent(linear);
  Solution solution = solve(linear, component, box);
  return intersectionOf(linear, component, box, solution);
}

template <typename T>
Intersection find(const T& linear, const AlignedBox& box) {
  return findInOwnFrame(linear, box);
}

template <typename T>
Intersection find(const T& linear, const OrientedBox& box) {
  if (const auto form = alignedForm(box)) {
    Intersection result = findInOwnFrame(linear, form->box);
    result.entered = form->ownFaces(result.entered);
    result.left = form->ownFaces(result.left);
    return result;
  }
  return findInOwnFrame(linear, box);
}

template <typename T, typename BoxType>
IntersectionRanges ranges(const T& linear, const BoxType& box) {
  Solution solution = solve(linear, doubleComponent(linear), box);
  if (solution.num_points == 0) {
    return {};
  }
  const exact::DoubleDouble length = directionLength(linear);
  return {roundedRange(linear, box, solution, End::kEnter, length),
          roundedRange(linear, box, solution, End::kExit, length)};
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
