// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where the boxes of a scene are: the tree that the kernels go down.
#pragma once

#include "kernels/scene_view.h"
#include "scene/box_bounds.h"
#include "scene/scene_boxes.h"
#include "scene/tree_nodes.h"

#include <box_query/geometry.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace box_query {

/// What is different in boxes that come after others.
struct BoxChanges {
  static constexpr std::uint32_t kGone = ~std::uint32_t{0};

  /// Of each box before, its number now, or kGone.
  std::vector<std::uint32_t> now;
  /// Of each box now, whether it was another before, or none.
  std::vector<bool> is_new;
  /// Boxes that were none before.
  std::vector<std::uint32_t> added;
  std::size_t moved = 0;
  std::size_t removed = 0;
};

/// A tree of sixteen children a node, all leaves at the same depth; up to 128 boxes are one list.
/// Few boxes, and some hundreds in a heap, are kept in blocks too.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(const SceneBoxes& boxes);

  /// The tree of boxes that come after those of this tree: the same nodes with other bounds, and
  /// one more root for those that are added. Nothing where a new tree is the better one, since
  /// there are few boxes, some that kernels may not take, or too much has changed.
  std::optional<BoxTree> updated(const SceneBoxes& boxes, const BoxChanges& changes) const;

  /// Valid as long as this tree is neither changed nor moved.
  kernels::SceneView view() const;

  /// Whether a ray at random meets the bounds of so many boxes that the first ones that one comes
  /// to most often say that some box is met.
  bool isFull() const { return is_full_; }

  /// Boxes whose numbers are out of the range of the kernels, by their number.
  // NOLINTNEXTLINE(readability-identifier-naming): as the field
  const std::vector<std::uint32_t>& left_out() const { return left_out_; }

 private:
  void addRecords(const SceneBoxes& boxes, const std::vector<Item>& items);
  void setRests(const SceneBoxes& boxes, std::size_t record);
  void addLeaves();
  void measure();
  void measureRadius(double mean_side);
  double boxesReachedInLeaves(double radius) const;
  bool isGone(std::size_t record) const { return box_of_record_[record] == BoxChanges::kGone; }
  double metInVain() const;
  void setBlocks();
  void dropAppended();
  bool moveBoxes(const SceneBoxes& boxes, const BoxChanges& changes);
  void refit();

  std::vector<TreeNodes> levels_;
  std::vector<kernels::BoxBlock> blocks_;
  kernels::Bounds around_nodes_;            ///< of the roots
  std::vector<kernels::LeafBoxes> leaves_;  ///< of the nodes of the lowest level
  std::vector<kernels::BoxRecord> records_;
  std::vector<kernels::AxisRests> rests_;  ///< of each record, where kernels use them
  std::vector<std::uint32_t> box_of_record_;
  std::vector<std::uint32_t> left_out_;
  double center_[3] = {0.0, 0.0, 0.0};
  double around_[2][3] = {};
  bool has_aligned_ = false;
  double mean_free_path_ = 0.0;
  double most_radius_ = kernels::kLargestRadius;
  double bounds_met_ = 0.0;  ///< by a ray along its longest side
  bool is_full_ = false;
  /// Areas of the nodes over that of the whole: what a ray has to compare.
  double cost_ = 0.0;

  /// What of it was built, and not appended by updates; and its cost then.
  std::vector<std::size_t> built_nodes_;
  std::size_t built_records_ = 0;
  double built_cost_ = 0.0;
};

}  // namespace box_query
