// SPDX-License-Identifier: BSD-3-Clause
#include <box_query/geometry.h>

namespace box_query {

Segment Segment::fromCenterDirectionExtent(const Vector3& center, const Vector3& direction,
                                           double extent) {
  return {center - extent * direction, center + extent * direction};
}

bool isValid(const Line& line) noexcept {
  return line.origin.allFinite() && line.direction.allFinite();
}

bool isValid(const Ray& ray) noexcept {
  return ray.origin.allFinite() && ray.direction.allFinite();
}

bool isValid(const Segment& segment) noexcept {
  return segment.start.allFinite() && segment.end.allFinite();
}

bool isValid(const AlignedBox& box) noexcept {
  return box.min.allFinite() && box.max.allFinite() && (box.min.array() <= box.max.array()).all();
}

bool isValid(const OrientedBox& box) noexcept {
  const auto& q = box.orientation.coeffs();
  return box.center.allFinite() && q.allFinite() && (q.array() != 0.0).any() &&
         box.half_extents.allFinite() && (box.half_extents.array() >= 0.0).all();
}

bool isValid(const Box& box) noexcept {
  if (const auto* aligned = std::get_if<AlignedBox>(&box)) {
    return isValid(*aligned);
  }
  return isValid(*std::get_if<OrientedBox>(&box));
}

}  // namespace box_query
