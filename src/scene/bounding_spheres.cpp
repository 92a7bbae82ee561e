// SPDX-License-Identifier: BSD-3-Clause
#include "scene/bounding_spheres.h"

#include "exact/distance_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace box_query {
namespace {

struct Sphere {
  Vector3 center;
  double radius;
};

double length(const Vector3& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * exact::bounds::kSphereRadius;
}

Sphere sphereAround(const AlignedBox& box) {
  const Vector3 center = 0.5 * box.min + 0.5 * box.max;
  return {center, length((box.max - center).cwiseMax(center - box.min))};
}

Sphere sphereAround(const OrientedBox& box) {
  return {box.center, length(box.half_extents)};
}

double sumOfMagnitudes(const Vector3& v) {
  return std::fabs(v[0]) + std::fabs(v[1]) + std::fabs(v[2]);
}

}  // namespace

BoundingSpheres::BoundingSpheres(const std::vector<Box>& boxes) {
  x.reserve(boxes.size());
  y.reserve(boxes.size());
  z.reserve(boxes.size());
  radius.reserve(boxes.size());
  for (const Box& any : boxes) {
    const Sphere sphere = std::visit([](const auto& box) { return sphereAround(box); }, any);
    x.push_back(sphere.center[0]);
    y.push_back(sphere.center[1]);
    z.push_back(sphere.center[2]);
    radius.push_back(sphere.radius);
    farthest = std::max(farthest, sumOfMagnitudes(sphere.center));
  }
}

SphereFilter::SphereFilter(const Segment& segment, const BoundingSpheres& spheres)
    : spheres_(spheres) {
  double squared = 0.0;
  for (int i = 0; i < 3; ++i) {
    start_[i] = segment.start[i];
    direction_[i] = segment.end[i] - segment.start[i];
    squared += direction_[i] * direction_[i];
  }
  // What is shorter counts as a point; the slack is longer.
  inverse_ = squared > 0x1p-200 ? 1.0 / squared : 0.0;
  const double largest = std::max(
      spheres.farthest, std::max(sumOfMagnitudes(segment.start), sumOfMagnitudes(segment.end)));
  slack_ = largest < exact::bounds::kLargestScale
               ? exact::bounds::kSphere * largest + exact::bounds::kSmallestSphere
               : std::numeric_limits<double>::infinity();
}

}  // namespace box_query
