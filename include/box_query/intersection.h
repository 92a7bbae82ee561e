// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Test- and find-intersection of a line, a ray or a segment with one box, exactly.
///
/// Every yes or no, every count and every set of faces is that of the closed solids that the given
/// doubles describe: touching counts. Parameters are the exact ones rounded to nearest, ties to
/// even (too large: infinite, too small: 0). Two different points may therefore have equal
/// parameters: num_points has the last word.
#pragma once

#include <box_query/geometry.h>

namespace box_query {

/// Whether the component and the closed solid have a point in common, by the method of separating
/// axes (paper, section 2) in the box's own frame: in doubles as the overlap of three slabs, which
/// is the same question, and where those cannot tell as the paper has it, without a division.
/// @pre isValid(component) && isValid(box)
bool testIntersection(const Line& line, const AlignedBox& box) noexcept;
bool testIntersection(const Ray& ray, const AlignedBox& box) noexcept;
bool testIntersection(const Segment& segment, const AlignedBox& box) noexcept;
bool testIntersection(const Line& line, const OrientedBox& box) noexcept;
bool testIntersection(const Ray& ray, const OrientedBox& box) noexcept;
bool testIntersection(const Segment& segment, const OrientedBox& box) noexcept;

/// The part of a component that lies in a box.
struct Intersection {
  /// 0: none. 1: a single point (also where the component is itself a point in the box). 2: an
  /// interval.
  int num_points = 0;
  /// { t : X(t) in the box } = [t_enter, t_exit]; empty as [+inf, -inf]. A line's or a ray's
  /// parameter is a multiple of its direction, a segment's runs from 0 at its start to 1 at its
  /// end. A zero direction inside the box keeps the component's own interval: every parameter is
  /// the same point.
  double t_enter = std::numeric_limits<double>::infinity();
  double t_exit = -std::numeric_limits<double>::infinity();
  /// The start (t = 0) of a ray or a segment lies in the closed solid. Always false for a line.
  bool started_inside = false;
  /// Faces whose planes bound the interval at t_enter (t_exit): one, or two on an edge, three on a
  /// corner. A face also belongs to the set where the component passes it at its own start (end);
  /// the set is empty where only the component's own start (end) bounds the interval.
  FaceSet entered;
  FaceSet left;
  /// X(t_enter) and X(t_exit), clamped to the box in its own frame; NaN on a miss. Within a few ulp
  /// of the largest coordinate of component and box. Equal bits on every machine.
  /// Where there are any, finite: a coordinate beyond the largest double is the largest one.
  Vector3 enter_point = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  Vector3 exit_point = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// The part of the component that lies in the closed solid. Liang-Barsky clipping (paper, section
/// 3).
/// @pre isValid(component) && isValid(box)
Intersection findIntersection(const Line& line, const AlignedBox& box) noexcept;
Intersection findIntersection(const Ray& ray, const AlignedBox& box) noexcept;
Intersection findIntersection(const Segment& segment, const AlignedBox& box) noexcept;
Intersection findIntersection(const Line& line, const OrientedBox& box) noexcept;
Intersection findIntersection(const Ray& ray, const OrientedBox& box) noexcept;
Intersection findIntersection(const Segment& segment, const OrientedBox& box) noexcept;

/// Distances [m] along a component, from its origin or start to where it enters and leaves a box.
struct IntersectionRanges {
  /// t_enter and t_exit times the length of the direction (of end - start), correctly rounded;
  /// negative behind a line's origin. The interval is empty, [+inf, -inf], on a miss.
  double enter = std::numeric_limits<double>::infinity();
  double exit = -std::numeric_limits<double>::infinity();
};

/// The metric interval that belongs to findIntersection(component, box). On its own, so that nobody
/// pays for square roots who did not ask for them.
/// @pre isValid(component) && isValid(box)
IntersectionRanges findRanges(const Line& line, const AlignedBox& box) noexcept;
IntersectionRanges findRanges(const Ray& ray, const AlignedBox& box) noexcept;
IntersectionRanges findRanges(const Segment& segment, const AlignedBox& box) noexcept;
IntersectionRanges findRanges(const Line& line, const OrientedBox& box) noexcept;
IntersectionRanges findRanges(const Ray& ray, const OrientedBox& box) noexcept;
IntersectionRanges findRanges(const Segment& segment, const OrientedBox& box) noexcept;

}  // namespace box_query
