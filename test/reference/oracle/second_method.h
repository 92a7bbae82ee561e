// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A second computation of what the oracle says, by other methods and in other arithmetic: plain
/// rationals in the frame of the world. Slow; it is there to check the oracle.
#pragma once

#include <box_query/geometry.h>

#include <array>
#include <optional>

#include <gmpxx.h>

namespace box_query::second_method {

/// A box by its center, unit axes and half extents, all exact: the axes of a rotation by q / |q|
/// are rational.
struct RationalBox {
  std::array<mpq_class, 3> center;
  std::array<std::array<mpq_class, 3>, 3> axes;
  std::array<mpq_class, 3> half_extents;

  explicit RationalBox(const AlignedBox& box);
  explicit RationalBox(const OrientedBox& box);
};

/// Points origin + t * direction, t in the interval.
struct RationalComponent {
  std::array<mpq_class, 3> origin;
  std::array<mpq_class, 3> direction;
  std::optional<mpq_class> first;  ///< Nothing: -inf.
  std::optional<mpq_class> last;   ///< Nothing: +inf.

  explicit RationalComponent(const Line& line);
  explicit RationalComponent(const Ray& ray);
  explicit RationalComponent(const Segment& segment);
};

/// Method of separating axes.
bool intersects(const RationalComponent& component, const RationalBox& box);

/// The interval in which a component that is not a point is in the box: the least and the greatest
/// of its crossings with face planes, and of its own ends, that lie in the box.
struct Interval {
  bool hit = false;
  mpq_class enter;
  mpq_class exit;
  FaceSet entered;
  FaceSet left;
};
Interval interval(const RationalComponent& component, const RationalBox& box);

/// The least squared distance among those of the ends from the box, of the corners from the segment
/// and of the edges from the segment; and the least parameter that attains it. Valid for a segment
/// that does not meet the box.
struct Nearest {
  mpq_class squared;
  mpq_class t;
};
Nearest nearest(const RationalComponent& segment, const RationalBox& box);

}  // namespace box_query::second_method
