// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How the levels of a tree are made.
#pragma once

#include "scene/tree_nodes.h"
#include "scene/tree_partition.h"

#include <cstddef>
#include <vector>

namespace box_query {

/// Makes the levels of a tree from the top, or more of them.
class TreeBuilder {
 public:
  /// @pre items are not empty
  TreeBuilder(std::vector<TreeNodes>& levels, std::vector<Item> items);

  /// @pre there are no levels
  void build();

  /// Appends a root, and what is below it, to levels that have `records` records.
  /// @return whether there is room for the items below one root
  bool append(std::size_t records);

  /// In the order of the records that they become.
  const std::vector<Item>& items() const { return partition_.items(); }

 private:
  void buildBelow(std::size_t top, std::vector<ItemRange> ranges, std::size_t records);
  void emit(std::size_t level, const std::vector<ItemRange>& slots, std::size_t below,
            std::vector<ItemRange>& ranges);
  void emitLeaves(const std::vector<ItemRange>& ranges, std::size_t records);

  std::vector<TreeNodes>& levels_;
  TreePartition partition_;
};

}  // namespace box_query
