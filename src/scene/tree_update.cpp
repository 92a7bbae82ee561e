// SPDX-License-Identifier: BSD-3-Clause
// A tree whose boxes have moved, or of which some have come or gone.
#include "scene/box_bounds.h"
#include "scene/box_tree.h"
#include "scene/tree_builder.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace box_query {
namespace {

/// Of the boxes, how many may be added or gone before the tree is built anew.
constexpr std::size_t kStrangers = 4;  // one in four
/// By what factor its cost may grow.
constexpr double kWorse = 1.5;

}  // namespace

std::optional<BoxTree> BoxTree::updated(const SceneBoxes& boxes, const BoxChanges& changes) const {
  if (levels_.size() < 2 || !left_out_.empty()) {
    return std::nullopt;
  }
  const std::size_t most = boxes.size() / kStrangers;
  if (changes.added.size() > most || changes.removed > most) {
    return std::nullopt;
  }
  std::vector<Item> items;
  const auto add = [&](std::uint32_t box) {
    const PreparedBox prepared = boxes.prepared(box);
    items.push_back({{}, box});
    return prepared.kind != PreparedBox::Kind::kExactOnly &&
           findBounds(extentOf(prepared), center_, items.back().bounds);
  };
  for (const std::uint32_t box : changes.added) {
    if (!add(box)) {
      return std::nullopt;
    }
  }
  // Those that were appended before are appended again, with the new ones.
  for (std::size_t k = built_records_; k < records_.size(); ++k) {
    const std::uint32_t box = changes.now[box_of_record_[k]];
    if (box != BoxChanges::kGone && !add(box)) {
      return std::nullopt;
    }
  }

  BoxTree tree(*this);
  tree.dropAppended();
  if (!tree.moveBoxes(boxes, changes)) {
    return std::nullopt;
  }
  tree.refit();
  const std::size_t gone = boxes.size() < items.size() + tree.built_records_
                               ? items.size() + tree.built_records_ - boxes.size()
                               : 0;
  if (items.size() > most || gone > most) {
    return std::nullopt;
  }
  if (!items.empty()) {
    TreeBuilder builder(tree.levels_, std::move(items));
    if (!builder.append(tree.records_.size())) {
      return std::nullopt;
    }
    tree.addRecords(boxes, builder.items());
    tree.addLeaves();
  }
  tree.measure();
  if (!(tree.cost_ <= kWorse * built_cost_)) {
    return std::nullopt;
  }
  tree.setBlocks();
  return tree;
}

void BoxTree::dropAppended() {
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    levels_[level].resize(built_nodes_[level]);
  }
  leaves_.resize(built_nodes_.front());
  records_.resize(built_records_);
  rests_.resize(std::min(rests_.size(), built_records_));
  box_of_record_.resize(built_records_);
}

/// Sets the slots and records of the boxes as they are now.
/// @return whether the kernels may take all of them
bool BoxTree::moveBoxes(const SceneBoxes& boxes, const BoxChanges& changes) {
  TreeNodes& leaves = levels_.front();
  for (std::size_t node = 0; node < leaves.size(); ++node) {
    const std::size_t children = leaves.childrenOf(node, records_.size());
    for (std::size_t slot = 0; slot < children; ++slot) {
      const std::size_t k = leaves.first[node] + slot;
      std::uint32_t& box = box_of_record_[k];
      if (box == BoxChanges::kGone) {
        continue;
      }
      box = changes.now[box];
      if (box == BoxChanges::kGone) {
        setSlot(leaves.bounds[node], slot, FloatBounds());
        clearSlot(leaves_[node], slot);
        continue;
      }
      if (!changes.is_new[box]) {
        continue;
      }
      const PreparedBox prepared = boxes.prepared(box);
      FloatBounds bounds;
      if (prepared.kind == PreparedBox::Kind::kExactOnly ||
          !findBounds(extentOf(prepared), center_, bounds)) {
        return false;
      }
      setSlot(leaves.bounds[node], slot, bounds);
      records_[k] = recordOf(prepared);
      setRests(boxes, k);
      setSlot(leaves_[node], slot, records_[k], center_);
      has_aligned_ = has_aligned_ || records_[k].isAligned();
    }
  }
  return true;
}

/// Sets the bounds of all nodes above the leaves.
void BoxTree::refit() {
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    TreeNodes& nodes = levels_[level];
    const TreeNodes& below = levels_[level - 1];
    for (std::size_t node = 0; node < nodes.size(); ++node) {
      const std::size_t children = nodes.childrenOf(node, below.size());
      for (std::size_t slot = 0; slot < children; ++slot) {
        setSlot(nodes.bounds[node], slot, aroundSlots(below.bounds[nodes.first[node] + slot]));
      }
    }
  }
}

}  // namespace box_query
