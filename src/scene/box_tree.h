// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where the boxes of a scene are: the tree that the kernels go down.
#pragma once

#include "kernels/scene_view.h"
#include "scene/prepared_boxes.h"

#include <box_query/geometry.h>

#include <cstdint>
#include <vector>

namespace box_query {

/// A tree of sixteen children a node, all leaves at the same depth; up to 128 boxes are one list,
/// and the first few of them are kept in blocks too.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(const std::vector<PreparedBox>& boxes);

  /// Valid as long as this tree is neither changed nor moved.
  kernels::SceneView view() const;

  /// Boxes whose numbers are out of the range of the kernels, by their number.
  const std::vector<std::uint32_t>& left_out() const { return left_out_; }

 private:
  friend class TreeBuilder;

  struct Nodes {
    std::vector<kernels::Bounds> bounds;
    std::vector<std::uint32_t> first;
  };

  std::vector<Nodes> levels_;
  std::vector<kernels::BoxBlock> blocks_;
  std::vector<kernels::BoxRecord> records_;
  std::vector<std::uint32_t> box_of_record_;
  std::vector<std::uint32_t> left_out_;
  double center_[3] = {0.0, 0.0, 0.0};
  double around_[2][3] = {};
  bool has_aligned_ = false;
  double mean_free_path_ = 0.0;
};

}  // namespace box_query
