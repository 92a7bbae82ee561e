// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/solve.h"
#include "scene/scene_impl.h"

#include <box_query/scene.h>

#include <algorithm>
#include <variant>

namespace box_query {
namespace {

/// Exact order of two boxes that the component meets.
template <typename T>
bool isEnteredBefore(const T& linear, const DoubleComponent& component, const Box& a,
                     const Box& b) {
  const auto solveBox = [&](const Box& box) {
    return std::visit([&](const auto& x) { return solve(linear, component, x, prepared(x)); }, box);
  };
  Solution at_a = solveBox(a);
  Solution at_b = solveBox(b);
  return compareEntries(linear, a, at_a, b, at_b) < 0;
}

template <typename T>
std::vector<BoxIntersection> findAllOf(const std::vector<Box>& boxes,
                                       const std::vector<Box>& simplest,
                                       const std::vector<PreparedBox>& prepared_boxes,
                                       const T& linear, const BoxMask* mask) {
  const DoubleComponent component = doubleComponent(linear);
  std::vector<BoxIntersection> found;
  forEachBox(boxes.size(), mask, [&](std::size_t i) {
    if (!enclose<T>(component, prepared_boxes[i]).isMiss()) {
      BoxIntersection candidate{
          i, std::visit([&](const auto& b) { return findIntersection(linear, b); }, boxes[i])};
      if (candidate.intersection.num_points > 0) {
        found.push_back(candidate);
      }
    }
    return true;
  });
  // Rounding keeps the order, but for the parameters that it makes equal. Found in order of the
  // index, ties stay in it.
  std::stable_sort(found.begin(), found.end(),
                   [&](const BoxIntersection& a, const BoxIntersection& b) {
                     if (a.intersection.t_enter != b.intersection.t_enter) {
                       return a.intersection.t_enter < b.intersection.t_enter;
                     }
                     return isEnteredBefore(linear, component, simplest[a.box], simplest[b.box]);
                   });
  return found;
}

}  // namespace

std::vector<BoxIntersection> Scene::findAll(const Line& line, const BoxMask* mask) const {
  return findAllOf(impl_->boxes, impl_->simplest, impl_->prepared, line, mask);
}

std::vector<BoxIntersection> Scene::findAll(const Ray& ray, const BoxMask* mask) const {
  return findAllOf(impl_->boxes, impl_->simplest, impl_->prepared, ray, mask);
}

std::vector<BoxIntersection> Scene::findAll(const Segment& segment, const BoxMask* mask) const {
  return findAllOf(impl_->boxes, impl_->simplest, impl_->prepared, segment, mask);
}

}  // namespace box_query
