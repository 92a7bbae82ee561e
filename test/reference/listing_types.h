// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The types of the paper's listings where they differ from the library's.
#pragma once

#include <box_query/geometry.h>

#include <array>
#include <cmath>
#include <limits>

namespace box_query::listings {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The paper's oriented box: axes as vectors of unit length (as far as doubles can), not a
/// quaternion.
struct OrientedBox3 {
  Vector3 C;
  std::array<Vector3, 3> U;
  Vector3 e;
};

/// Its axes are rounded here: what follows can only be as right as they are.
inline OrientedBox3 toOrientedBox3(const OrientedBox& box) {
  const Eigen::Matrix3d axes = box.orientation.normalized().toRotationMatrix();
  return {box.center, {axes.col(0), axes.col(1), axes.col(2)}, box.half_extents};
}

/// The paper's conversion of an aligned box (section 1), which rounds.
inline OrientedBox3 toOrientedBox3(const AlignedBox& box) {
  return {(box.max + box.min) / 2.0,
          {Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()},
          (box.max - box.min) / 2.0};
}

/// The centre-direction-extent form of a segment (section 2.3): P + t D, |t| <= e, |D| = 1.
struct CenteredSegment3 {
  Vector3 P;
  Vector3 D;
  double e;
};

/// The paper's Normalize: makes D unit length and returns half its former length.
inline double normalize(Vector3& D) {
  const double length = D.norm();
  D /= length;
  return length / 2.0;
}

inline CenteredSegment3 toCenteredSegment3(const Segment& segment) {
  CenteredSegment3 centered{(segment.start + segment.end) / 2.0, segment.end - segment.start, 0.0};
  centered.e = normalize(centered.D);
  return centered;
}

/// Coordinates of a world vector along the axes of a box.
inline Vector3 alongAxes(const Vector3& X, const OrientedBox3& box) {
  return {X.dot(box.U[0]), X.dot(box.U[1]), X.dot(box.U[2])};
}

/// What the listings call numPoints, t and point.
struct Found {
  int num_points;
  double t[2];
  Vector3 point[2];
};

}  // namespace box_query::listings
