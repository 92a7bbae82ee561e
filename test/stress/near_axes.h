// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Families in which boxes and components are turned from an axis, or from each other, by so little
/// that the last bits decide.
#pragma once

#include "stress/target.h"

namespace box_query::stress {

/// One of the 24 rotations that permute the axes, not of unit length.
Quaternion quarterTurns(Random& random);
/// A multiple of 0.1 in [-limit, limit] as doubles have it: as people write shelves down.
double decimal(Random& random, int limit);

/// A shelf in a frame of its own, turned as a whole: boxes of one size in rows, side by side, so
/// that they share the planes of their faces, as far as doubles can.
class TurnedShelf {
 public:
  TurnedShelf(Random& random, bool oriented);

  /// The box in this column, row and layer: numbers of any sign.
  Target boxAt(const Vector3& cell) const;
  /// Components through a place in or near that box, mostly along planes that boxes share.
  Sample along(Random& random, const Vector3& cell) const;

 private:
  Quaternion rotation_;
  Vector3 half_extents_;
  bool oriented_;
  /// The box in the middle: of local coordinates 2 cell, boxes' centers, and 2 cell +- 1, planes.
  Target middle_;
};

/// A box turned from the axes by 1e-16 to 1e-3; components along its faces and edges.
Sample nearlyAligned(Random& random, bool oriented);
/// One box of a turned shelf.
Sample turnedShelves(Random& random, bool oriented);
/// Components of which one coordinate hardly changes: by 1e-18 to 1e-8 of the one that changes
/// most. From near and far they graze a face.
Sample hardlySloping(Random& random, bool oriented);

}  // namespace box_query::stress
