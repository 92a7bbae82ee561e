// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A box to aim at: its points and directions in the world, computed in plain doubles in a fixed
/// order. They are near what they say, which is what makes them hostile.
#pragma once

#include "stress/random.h"

#include <box_query/geometry.h>

#include <array>

namespace box_query::stress {

/// One box, and a component as line, ray and segment: (origin, direction) and (origin, end).
struct Sample {
  Box box;
  Vector3 origin;
  Vector3 direction;
  Vector3 end;

  Line line() const { return {origin, direction}; }
  Ray ray() const { return {origin, direction}; }
  Segment segment() const { return {origin, end}; }
};

class Target {
 public:
  explicit Target(const AlignedBox& box);
  explicit Target(const OrientedBox& box);

  const Box& box() const { return box_; }
  const Vector3& halfExtents() const { return half_extents_; }
  /// Point by its local coordinates in units of the half extents: faces are at -1 and 1.
  Vector3 at(const Vector3& local) const;
  /// Direction by its local coordinates (lengths as in the world).
  Vector3 along(const Vector3& local) const;

 private:
  Box box_;
  Vector3 center_;
  Vector3 half_extents_;
  std::array<Vector3, 3> columns_;
};

/// A box with this center, rotation and size; as an aligned box the rotation is left out.
Target makeTarget(bool oriented, const Vector3& center, const Quaternion& rotation,
                  const Vector3& half_extents);

/// A place on the box and a direction there, both local.
struct Contact {
  Vector3 place;
  Vector3 direction;
};

/// Touches an edge or a corner from outside, as far as a line with this direction can; or passes
/// a face in its plane.
Contact grazingEdge(Random& random);
Contact grazingCorner(Random& random);
Contact inFacePlane(Random& random);
/// One of these.
Contact anyGraze(Random& random);
/// Goes through a point in or near the box in any direction.
Contact through(Random& random);

/// p + t d.
Vector3 onRay(const Vector3& p, double t, const Vector3& d);

/// Components that pass the contact: origins before it, at times at or behind it, up to `reach`
/// times the direction away; ends after it, at or before it; everything moved by up to `ulps`.
Sample aim(Random& random, const Target& target, const Contact& contact, double reach, int ulps);

}  // namespace box_query::stress
