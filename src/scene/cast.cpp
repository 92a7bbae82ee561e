// SPDX-License-Identifier: BSD-3-Clause
#include "exact/clip.h"
#include "geometry/rotation.h"
#include "scene/scene_impl.h"

#include <box_query/scene.h>

#include <algorithm>
#include <utility>
#include <variant>

namespace box_query {
namespace {

/// Outward normal of the face of the lowest axis in the set.
Vector3 outwardNormal(FaceSet faces, const Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool positive : {false, true}) {
      if (faces.contains(axis, positive)) {
        Vector3 normal = Vector3::Unit(axis);
        if (const auto* oriented = std::get_if<OrientedBox>(&box)) {
          const auto& a = boxAxes(oriented->orientation).of[axis];
          normal = Vector3(a[0], a[1], a[2]);
        }
        return positive ? normal : Vector3(-normal);
      }
    }
  }
  return Vector3::Zero();
}

}  // namespace

Hit Scene::cast(const Ray& ray, double max_range, const BoxMask* mask) const noexcept {
  const exact::Component component = exact::component(ray);
  const exact::Dyadic squared_length = exact::dot(component.direction, component.direction);
  Hit hit;
  exact::Clip closest;
  forEachBox(size(), mask, [&](std::size_t i) {
    const exact::Clip clip = exact::clip(component, impl_->boxes[i]);
    if (clip.num_points > 0 && (!hit.hit || compare(clip.enter, closest.enter) < 0)) {
      hit.hit = true;
      hit.box = i;
      closest = clip;
    }
    return true;
  });
  if (!hit.hit || !isWithin(closest.enter, squared_length, max_range)) {
    return Hit();
  }
  hit.range = exact::roundedRange(closest.enter, squared_length);
  hit.exit_range = exact::roundedRange(closest.exit, squared_length);
  hit.t = exact::rounded(closest.enter);
  hit.started_inside = closest.started_inside;
  hit.entered = closest.entered;
  hit.point = exact::roundedPoint(component, closest.enter);
  hit.normal =
      hit.started_inside ? Vector3::Zero() : outwardNormal(hit.entered, impl_->boxes[hit.box]);
  return hit;
}

bool Scene::castAny(const Ray& ray, double max_range, const BoxMask* mask) const noexcept {
  const exact::Component component = exact::component(ray);
  const exact::Dyadic squared_length = exact::dot(component.direction, component.direction);
  bool any = false;
  forEachBox(size(), mask, [&](std::size_t i) {
    const exact::Clip clip = exact::clip(component, impl_->boxes[i]);
    any = clip.num_points > 0 && isWithin(clip.enter, squared_length, max_range);
    return !any;
  });
  return any;
}

}  // namespace box_query
