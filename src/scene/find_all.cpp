// SPDX-License-Identifier: BSD-3-Clause
#include "exact/clip.h"
#include "scene/scene_impl.h"

#include <box_query/scene.h>

#include <algorithm>
#include <utility>
#include <variant>

namespace box_query {
namespace {

template <typename T>
std::vector<BoxIntersection> findAllOf(const std::vector<Box>& boxes, const T& linear,
                                       const BoxMask* mask) {
  struct Found {
    std::size_t box;
    exact::Parameter enter;
  };
  const exact::Component component = exact::component(linear);
  std::vector<Found> found;
  forEachBox(boxes.size(), mask, [&](std::size_t i) {
    exact::Clip clip = exact::clip(component, boxes[i]);
    if (clip.num_points > 0) {
      found.push_back({i, std::move(clip.enter)});
    }
    return true;
  });
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    const int order = compare(a.enter, b.enter);
    return order < 0 || (order == 0 && a.box < b.box);
  });
  std::vector<BoxIntersection> result;
  result.reserve(found.size());
  for (const Found& f : found) {
    result.push_back({f.box, std::visit([&](const auto& b) { return findIntersection(linear, b); },
                                        boxes[f.box])});
  }
  return result;
}

}  // namespace

std::vector<BoxIntersection> Scene::findAll(const Line& line, const BoxMask* mask) const {
  return findAllOf(impl_->boxes, line, mask);
}

std::vector<BoxIntersection> Scene::findAll(const Ray& ray, const BoxMask* mask) const {
  return findAllOf(impl_->boxes, ray, mask);
}

std::vector<BoxIntersection> Scene::findAll(const Segment& segment, const BoxMask* mask) const {
  return findAllOf(impl_->boxes, segment, mask);
}

}  // namespace box_query
