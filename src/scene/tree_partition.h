// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How the boxes of a tree are parted among its nodes.
#pragma once

#include "kernels/scene_view.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace box_query {

/// Bounds relative to the center of the scene, rounded outward.
struct FloatBounds {
  static constexpr float kNowhere = std::numeric_limits<float>::infinity();

  float lo[3] = {kNowhere, kNowhere, kNowhere};
  float hi[3] = {-kNowhere, -kNowhere, -kNowhere};

  void add(const FloatBounds& b) {
    for (int i = 0; i < 3; ++i) {
      lo[i] = std::min(lo[i], b.lo[i]);
      hi[i] = std::max(hi[i], b.hi[i]);
    }
  }
  /// Half of it, of bounds that are not empty.
  float area() const {
    const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
    return x * y + (y + x) * z;
  }
};

struct Item {
  FloatBounds bounds;
  std::uint32_t box;

  /// Twice the middle.
  float middle(int axis) const { return bounds.lo[axis] + bounds.hi[axis]; }
};

/// Items from begin to before end.
struct ItemRange {
  std::size_t begin;
  std::size_t end;
  std::size_t size() const { return end - begin; }
};

/// Cuts items into ranges, one a node, by the surface area heuristic (J. Goldsmith and J. Salmon,
/// "Automatic Creation of Object Hierarchies for Ray Tracing", 1987; binned after I. Wald, "On fast
/// Construction of SAH-based Bounding Volume Hierarchies", 2007), where the cost of a part is its
/// area times the leaves that it fills: a leaf costs the same whatever is in it.
class TreePartition {
 public:
  explicit TreePartition(std::vector<Item> items);

  const std::vector<Item>& items() const { return items_; }
  FloatBounds boundsOf(const ItemRange& range) const;

  /// Boxes that a node of a level is best filled with: 16 of a leaf; of others less than there is
  /// room for, so that splits may be uneven.
  static std::size_t target(std::size_t level);

  /// Appends at most `budget` ranges for nodes of a level.
  /// @pre there is room for the range in so many
  void cut(const ItemRange& range, std::size_t budget, std::size_t level,
           std::vector<ItemRange>& result);

  /// Appends ranges for leaves that are full, but for the last.
  void cutFull(const ItemRange& range, std::vector<ItemRange>& result);

 private:
  static std::size_t capacity(std::size_t level);

  template <typename IsAllowed>
  std::size_t split(const ItemRange& range, std::size_t fallback, IsAllowed&& is_allowed);

  std::vector<Item> items_;
};

}  // namespace box_query
