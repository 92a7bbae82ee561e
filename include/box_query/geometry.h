// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The linear components and boxes of D. Eberly, "Intersection of a Line and a Box" (Geometric
/// Tools, 2018).
///
/// All coordinates of one query are in one frame and one unit (metres, by REP-103). Every number is
/// taken as the exact value of its double: nothing here is normalised or rounded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <variant>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace box_query {

using Vector3 = Eigen::Vector3d;

/// Unaligned, so that a struct that holds one has the same layout whatever -march its user compiles
/// with.
using Quaternion = Eigen::Quaternion<double, Eigen::DontAlign>;

/// Points origin + t * direction, t in (-inf, inf). The direction need not be unit length; zero
/// makes the line a point.
struct Line {
  Vector3 origin;
  Vector3 direction;
};

/// Points origin + t * direction, t in [0, inf). The direction need not be unit length; zero makes
/// the ray a point.
struct Ray {
  Vector3 origin;
  Vector3 direction;
};

/// Points start + t * (end - start), t in [0, 1], where end - start is the exact difference. Equal
/// ends make it a point.
struct Segment {
  Vector3 start;
  Vector3 end;

  /// From the paper's form center + s * direction, |s| <= extent (section 2.3). The end points are
  /// rounded to double.
  static Segment fromCenterDirectionExtent(const Vector3& center, const Vector3& direction,
                                           double extent);
};

/// Closed solid min <= X <= max, componentwise. Equal bounds make it flat, a line or a point.
struct AlignedBox {
  Vector3 min;
  Vector3 max;
};

/// Closed solid { center + R y : |y_i| <= half_extents_i }, R the rotation of the orientation.
///
/// The orientation is any non-zero quaternion q; R is that of q / |q| exactly. A half extent may be
/// zero.
struct OrientedBox {
  Vector3 center;
  Quaternion orientation;
  Vector3 half_extents;
};

using Box = std::variant<AlignedBox, OrientedBox>;

/// True if every number is finite (and, for a box, min <= max, half extents >= 0, and the
/// quaternion is not zero). Everything that takes a component or a box in this library has this as
/// its precondition.
bool isValid(const Line& line) noexcept;
bool isValid(const Ray& ray) noexcept;
bool isValid(const Segment& segment) noexcept;
bool isValid(const AlignedBox& box) noexcept;
bool isValid(const OrientedBox& box) noexcept;
bool isValid(const Box& box) noexcept;

/// Faces of a box as a set. The face on the negative side of axis i has the number 2 i, that on the
/// positive side 2 i + 1; axes are the box's own. One face: a point on a face; two: on an edge;
/// three: a corner (more only on flat boxes).
class FaceSet {
 public:
  constexpr FaceSet() = default;
  explicit constexpr FaceSet(unsigned bits) : bits_(static_cast<std::uint8_t>(bits)) {}

  static constexpr unsigned number(int axis, bool positive) {
    return 2U * static_cast<unsigned>(axis) + (positive ? 1U : 0U);
  }
  constexpr void insert(int axis, bool positive) {
    bits_ = static_cast<std::uint8_t>(bits_ | (1U << number(axis, positive)));
  }
  constexpr bool contains(int axis, bool positive) const {
    return ((bits_ >> number(axis, positive)) & 1U) != 0;
  }
  constexpr bool empty() const { return bits_ == 0; }
  /// Bit n is set where face n belongs to the set.
  constexpr std::uint8_t bits() const { return bits_; }

  friend constexpr bool operator==(FaceSet a, FaceSet b) { return a.bits_ == b.bits_; }
  friend constexpr bool operator!=(FaceSet a, FaceSet b) { return a.bits_ != b.bits_; }

 private:
  std::uint8_t bits_ = 0;
};

}  // namespace box_query
