// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/distance_exact.h"
#include "scene/scene_impl.h"

#include <box_query/distance.h>
#include <box_query/scene.h>

#include <optional>
#include <utility>
#include <variant>

namespace box_query {

bool Scene::isClear(const Segment& segment, double radius, const BoxMask* mask) const noexcept {
  bool clear = true;
  forEachBox(size(), mask, [&](std::size_t i) {
    clear = std::visit([&](const auto& box) { return box_query::isClear(segment, box, radius); },
                       impl_->boxes[i]);
    return clear;
  });
  return clear;
}

Clearance Scene::clearance(const Segment& segment, const BoxMask* mask) const noexcept {
  std::size_t nearest_box = kNoBox;
  exact::Ratio smallest;
  forEachBox(size(), mask, [&](std::size_t i) {
    exact::Nearest nearest = exact::nearest(exact::segmentAtBox(segment, impl_->boxes[i]));
    if (nearest_box == kNoBox || compare(nearest.squared, smallest) < 0) {
      nearest_box = i;
      smallest = std::move(nearest.squared);
    }
    return smallest.num.sign() != 0;  // nothing is nearer than a box that is met
  });
  if (nearest_box == kNoBox) {
    return {};
  }
  const SegmentDistance d = std::visit([&](const auto& box) { return distance(segment, box); },
                                       impl_->boxes[nearest_box]);
  return {nearest_box, d.distance, d.t, d.on_segment, d.on_box};
}

Blockage Scene::firstBlockage(const Segment& segment, double radius,
                              const BoxMask* mask) const noexcept {
  std::size_t first_box = kNoBox;
  exact::Root first;
  forEachBox(size(), mask, [&](std::size_t i) {
    std::optional<exact::Root> root =
        exact::firstWithin(exact::segmentAtBox(segment, impl_->boxes[i]), radius);
    if (root && (first_box == kNoBox || compare(*root, first) < 0)) {
      first_box = i;
      first = *std::move(root);
    }
    return true;
  });
  if (first_box == kNoBox) {
    return {};
  }
  return {true, first_box,
          std::visit([&](const auto& box) { return blockedAt(segment, box, radius); },
                     impl_->boxes[first_box])};
}

}  // namespace box_query
