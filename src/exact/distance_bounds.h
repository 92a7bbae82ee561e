// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Error bounds of segment distances; tests replace this file by one with smaller bounds and expect
/// wrong answers.
#pragma once

namespace box_query::exact::bounds {

/// Distances from SegmentSlabs, whose scale is s: see geometry/distance_filter.h.
constexpr double kDistance = 160 * 0x1p-53;
/// The slope of the squared distance, times |direction|_1 s.
constexpr double kSlope = 160 * 0x1p-53;
/// Shorter directions have the error of one with this |direction|_1, far above what underflow takes
/// from them in the frame of a box, and from their products with an excess.
constexpr double kShortestDirection = 0x1p-800;
/// Scales that the filter takes: nothing overflows, and what underflow adds is far below the
/// bounds.
constexpr double kSmallestScale = 0x1p-100;
constexpr double kLargestScale = 0x1p100;
/// The same of the squared norm of a quaternion.
constexpr double kSmallestStretch = 0x1p-200;
constexpr double kLargestStretch = 0x1p200;

}  // namespace box_query::exact::bounds
