// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A component in the frame of a box, without any rounding and without a division.
#pragma once

#include "reference/oracle/dyadic.h"

#include <box_query/geometry.h>

namespace box_query::oracle {

enum class Kind { kLine, kRay, kSegment };

/// Points origin + t * direction; a segment's direction is the exact difference of its ends.
struct ExactComponent {
  Kind kind;
  DyadicVector origin;
  DyadicVector direction;

  // Implicit, so that every function of the oracle takes the public types.
  ExactComponent(const Line& line);        // NOLINT(google-explicit-constructor)
  ExactComponent(const Ray& ray);          // NOLINT(google-explicit-constructor)
  ExactComponent(const Segment& segment);  // NOLINT(google-explicit-constructor)

  bool isPoint() const;
};

/// With M = n R(q) and n = |q|^2, M^T M = n^2 I: the columns of M are exactly orthogonal whatever
/// |q| is. A point X is in the box if and only if low <= M^T (X - center) <= high.
struct ExactBox {
  DyadicVector center;
  bool rotated = false;  ///< Else M is the identity.
  std::array<DyadicVector, 3> columns;
  Dyadic n = 1.0;
  DyadicVector low;
  DyadicVector high;

  ExactBox(const AlignedBox& box);   // NOLINT(google-explicit-constructor)
  ExactBox(const OrientedBox& box);  // NOLINT(google-explicit-constructor)
  ExactBox(const Box& box);          // NOLINT(google-explicit-constructor)

  /// M^T v.
  DyadicVector toBox(const DyadicVector& v) const;
  /// M v.
  DyadicVector toWorld(const DyadicVector& v) const;
};

/// X(t) is in the box if and only if low_i <= y_i + t d_i <= high_i for every axis i. All lengths
/// are n times those of the world.
struct Slabs {
  Kind kind;
  DyadicVector y;
  DyadicVector d;
  DyadicVector low;
  DyadicVector high;
  Dyadic n;

  Slabs(const ExactComponent& component, const ExactBox& box);
};

}  // namespace box_query::oracle
