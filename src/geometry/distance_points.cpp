// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/distance_points.h"

#include "exact/rounding.h"
#include "geometry/rotation.h"

#include <algorithm>

namespace box_query {
namespace {

double clamp(double x, double lo, double hi) {
  return std::min(std::max(x, lo), hi);
}

/// Coordinates beyond this are divided by kRoom, so that no difference or rotation overflows.
constexpr double kLarge = 0x1p1019;
constexpr double kRoom = 0x1p-4;

}  // namespace

void setClosestPoints(const Segment& segment, const AlignedBox& box, SegmentDistance& nearest) {
  nearest.on_segment = pointAt(segment, nearest.t);
  for (int i = 0; i < 3; ++i) {
    nearest.on_box[i] = clamp(nearest.on_segment[i], box.min[i], box.max[i]);
  }
}

void setClosestPoints(const Segment& segment, const OrientedBox& box, SegmentDistance& nearest) {
  nearest.on_segment = pointAt(segment, nearest.t);
  nearest.on_box = nearest.on_segment;

  double room = 1.0;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(nearest.on_segment[i]) > kLarge || std::abs(box.center[i]) > kLarge ||
        box.half_extents[i] > kLarge) {
      room = kRoom;
    }
  }
  double from_center[3];
  for (int j = 0; j < 3; ++j) {
    from_center[j] = room * nearest.on_segment[j] - room * box.center[j];
  }
  const Axes axes = boxAxes(box.orientation);
  bool inside = true;
  double local[3];
  for (int i = 0; i < 3; ++i) {
    const double x = axes.of[i][0] * from_center[0] + axes.of[i][1] * from_center[1] +
                     axes.of[i][2] * from_center[2];
    local[i] = clamp(x, room * -box.half_extents[i], room * box.half_extents[i]);
    inside = inside && local[i] == x;
  }
  if (inside) {
    return;  // the point of the segment itself, without the rounding of two rotations
  }
  for (int j = 0; j < 3; ++j) {
    nearest.on_box[j] = exact::finiteCoordinate(
        (room * box.center[j] +
         (axes.of[0][j] * local[0] + axes.of[1][j] * local[1] + axes.of[2][j] * local[2])) /
        room);
  }
}

}  // namespace box_query
