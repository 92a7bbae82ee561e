// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/moved_into.h"

#include "geometry/rotation.h"

#include <algorithm>

namespace box_query {

Vector3 movedInto(const AlignedBox& box, const Vector3& point, FaceSet faces) {
  Vector3 inside;
  for (int i = 0; i < 3; ++i) {
    inside[i] = std::min(std::max(point[i], box.min[i]), box.max[i]);
    inside[i] = faces.contains(i, false) ? box.min[i] : inside[i];
    inside[i] = faces.contains(i, true) ? box.max[i] : inside[i];
  }
  return inside;
}

Vector3 movedInto(const OrientedBox& box, const Vector3& point, FaceSet faces) {
  const Axes axes = boxAxes(box.orientation);
  const Vector3 v = point - box.center;
  Vector3 inside = point;
  for (int i = 0; i < 3; ++i) {
    const double* a = axes.of[i];
    const double extent = box.half_extents[i];
    const double y = (a[0] * v[0] + a[1] * v[1]) + a[2] * v[2];
    double target = std::min(std::max(y, -extent), extent);
    target = faces.contains(i, false) ? -extent : target;
    target = faces.contains(i, true) ? extent : target;
    const double correction = target - y;
    for (int j = 0; j < 3; ++j) {
      inside[j] += correction * a[j];
    }
  }
  return inside;
}

}  // namespace box_query
