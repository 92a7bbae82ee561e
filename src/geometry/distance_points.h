// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <box_query/distance.h>

namespace box_query {

/// The ends themselves at 0 and 1; cannot overflow.
inline Vector3 pointAt(const Segment& segment, double t) {
  Vector3 point;
  for (int i = 0; i < 3; ++i) {
    point[i] = (1.0 - t) * segment.start[i] + t * segment.end[i];
  }
  return point;
}

/// Fills in the points of the segment and of the box at nearest.t, from the numbers as they were
/// given: the same bits whichever stage found t.
void setClosestPoints(const Segment& segment, const AlignedBox& box, SegmentDistance& nearest);
void setClosestPoints(const Segment& segment, const OrientedBox& box, SegmentDistance& nearest);

}  // namespace box_query
