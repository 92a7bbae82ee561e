// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The distance of a segment that passes an aligned box at a constant distance, as a path over a
/// shelf does: there ties are the rule, and short numbers decide them.
#pragma once

#include "exact/clip.h"

#include <box_query/geometry.h>
#include <box_query/intersection.h>

#include <optional>

namespace box_query {

struct FlatDistance {
  /// The squared distance, exactly.
  exact::Dyadic squared;
  /// The box moved onto the segment: where it is entered first, the box is nearest.
  AlignedBox shadow;
};

/// Something if every axis along which the segment stays outside the slab of the box has a zero
/// direction, and the segment passes the others at some one parameter.
inline std::optional<FlatDistance> flatDistance(const Segment& segment, const AlignedBox& box) {
  FlatDistance flat{0.0, box};
  for (int i = 0; i < 3; ++i) {
    const double x = segment.start[i];
    if (x == segment.end[i] && !(x >= box.min[i] && x <= box.max[i])) {
      const exact::Dyadic excess = exact::Dyadic(x) - (x > box.max[i] ? box.max : box.min)[i];
      flat.squared += excess * excess;
      flat.shadow.min[i] = x;
      flat.shadow.max[i] = x;
    }
  }
  if (flat.squared.sign() == 0 || !testIntersection(segment, flat.shadow)) {
    return std::nullopt;
  }
  return flat;
}

inline std::optional<FlatDistance> flatDistance(const Segment&, const OrientedBox&) {
  return std::nullopt;
}

}  // namespace box_query
