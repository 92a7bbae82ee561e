// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/prepared_box.h"

#include <box_query/geometry.h>

#include <variant>

namespace box_query {

/// A box of a Scene as the filter sees it, oriented or aligned.
struct PreparedBox {
  enum class Kind { kAligned, kOriented, kExactOnly };

  explicit PreparedBox(const AlignedBox& box)
      : kind(isModerate(box) ? Kind::kAligned : Kind::kExactOnly), aligned(doubleSlabs(box)) {}

  explicit PreparedBox(const OrientedBox& box)
      : kind(isModerate(box) ? Kind::kOriented : Kind::kExactOnly), oriented(doubleSlabs(box)) {}

  explicit PreparedBox(const Box& box)
      : PreparedBox(std::holds_alternative<AlignedBox>(box)
                        ? PreparedBox(*std::get_if<AlignedBox>(&box))
                        : PreparedBox(*std::get_if<OrientedBox>(&box))) {}

  /// kExactOnly: not moderate.
  Kind kind;
  union {
    AlignedSlabs aligned;
    OrientedSlabs oriented;
  };
};

}  // namespace box_query
