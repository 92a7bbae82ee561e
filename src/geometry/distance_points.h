// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <box_query/distance.h>

namespace box_query {

/// Fills in the points of the segment and of the box at nearest.t, from the numbers as they were
/// given: the same bits whichever stage found t.
void setClosestPoints(const Segment& segment, const AlignedBox& box, SegmentDistance& nearest);
void setClosestPoints(const Segment& segment, const OrientedBox& box, SegmentDistance& nearest);

}  // namespace box_query
