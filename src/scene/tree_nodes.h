// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The nodes of one level of a tree, and their slots.
#pragma once

#include "kernels/scene_view.h"
#include "scene/tree_partition.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace box_query {

/// Node n has the children from first[n] to before first[n + 1] of the level below, of the lowest
/// level records; the last one has all others.
struct TreeNodes {
  std::vector<kernels::Bounds> bounds;
  std::vector<std::uint32_t> first;

  std::size_t size() const { return first.size(); }
  void reserve(std::size_t nodes) {
    bounds.reserve(nodes);
    first.reserve(nodes);
  }
  void resize(std::size_t nodes) {
    bounds.resize(nodes);
    first.resize(nodes);
  }
  /// @param below how many nodes or records the level below has
  std::size_t childrenOf(std::size_t node, std::size_t below) const {
    return (node + 1 < first.size() ? first[node + 1] : below) - first[node];
  }
};

inline void setSlot(kernels::Bounds& bounds, std::size_t slot, const FloatBounds& b) {
  for (int i = 0; i < 3; ++i) {
    bounds.plane[0][i][slot] = b.lo[i];
    bounds.plane[1][i][slot] = b.hi[i];
  }
}

/// Bounds of which every slot is empty.
inline kernels::Bounds emptyBounds() {
  kernels::Bounds bounds;
  for (std::size_t slot = 0; slot < kernels::kSlots; ++slot) {
    setSlot(bounds, slot, FloatBounds());
  }
  return bounds;
}

/// Around all slots.
inline FloatBounds aroundSlots(const kernels::Bounds& bounds) {
  FloatBounds around;
  for (int i = 0; i < 3; ++i) {
    for (const float lo : bounds.plane[0][i]) {
      around.lo[i] = std::min(around.lo[i], lo);
    }
    for (const float hi : bounds.plane[1][i]) {
      around.hi[i] = std::max(around.hi[i], hi);
    }
  }
  return around;
}

/// Half the surface of all slots together.
inline double areaOfSlots(const kernels::Bounds& bounds) {
  double area = 0.0;
  for (std::size_t slot = 0; slot < kernels::kSlots; ++slot) {
    float side[3];
    for (int i = 0; i < 3; ++i) {
      side[i] = std::max(bounds.plane[1][i][slot] - bounds.plane[0][i][slot], 0.0F);
    }
    area += static_cast<double>(side[0] * side[1] + (side[1] + side[0]) * side[2]);
  }
  return area;
}

}  // namespace box_query
