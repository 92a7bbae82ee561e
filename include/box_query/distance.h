// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Distance from a segment to the solid of one box, exactly.
///
/// The squared distance along a segment is convex and piecewise quadratic: its derivative is
/// continuous, non-decreasing and linear between at most six break points, where the segment
/// crosses the planes of the faces.
#pragma once

#include <box_query/geometry.h>

namespace box_query {

/// The nearest points of a segment and a box.
struct SegmentDistance {
  /// Distance of the closed solids, the exact one rounded to nearest, ties to even; 0 if they meet.
  /// Never NaN.
  double distance = std::numeric_limits<double>::infinity();
  /// Smallest parameter in [0, 1] at which the distance is attained, correctly rounded.
  double t = std::numeric_limits<double>::quiet_NaN();
  /// The points at that parameter, within a few ulp of the largest coordinate of segment and box.
  /// Always finite: a coordinate beyond the largest double is the largest one.
  Vector3 on_segment = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  Vector3 on_box = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// @pre isValid(segment) && isValid(box)
SegmentDistance distance(const Segment& segment, const AlignedBox& box) noexcept;
SegmentDistance distance(const Segment& segment, const OrientedBox& box) noexcept;

/// Whether the exact distance is greater than `radius`: touching is not clear.
/// @pre isValid(segment) && isValid(box), radius finite and >= 0
bool isClear(const Segment& segment, const AlignedBox& box, double radius) noexcept;
bool isClear(const Segment& segment, const OrientedBox& box, double radius) noexcept;

/// Smallest parameter t in [0, 1] whose point is within `radius` of the box; +inf if there is none
/// (isClear decides). For radius 0 the exact value rounded to nearest, ties to even: the t_enter of
/// findIntersection. Otherwise it is the root of a quadratic, and the result is the largest double
/// that is not greater: never late, and unique. 0 if the segment starts within the radius.
/// @pre isValid(segment) && isValid(box), radius finite and >= 0
double blockedAt(const Segment& segment, const AlignedBox& box, double radius) noexcept;
double blockedAt(const Segment& segment, const OrientedBox& box, double radius) noexcept;

}  // namespace box_query
