// SPDX-License-Identifier: BSD-3-Clause
#include "scene/tree_builder.h"

#include "kernels/scene_view.h"

#include <algorithm>
#include <utility>

namespace box_query {
namespace {

constexpr std::size_t kSlots = kernels::kSlots;
/// Boxes that are best kept in one list.
constexpr std::size_t kFlat = 128;
/// Roots are compared all: more of them save a level, for longer.
constexpr std::size_t kMostRoots = 96;
static_assert(kFlat <= kSlots * kernels::kMostRootNodes, "all nodes of a list are roots");
static_assert(kMostRoots <= kSlots * (kernels::kMostRootNodes - 1), "append() adds one");

}  // namespace

TreeBuilder::TreeBuilder(std::vector<TreeNodes>& levels, std::vector<Item> items)
    : levels_(levels), partition_(std::move(items)) {}

void TreeBuilder::build() {
  const ItemRange all{0, partition_.items().size()};
  if (all.size() <= kFlat) {
    levels_.resize(1);
    std::vector<ItemRange> ranges;
    partition_.cutFull(all, ranges);
    emitLeaves(ranges, 0);
    return;
  }
  std::size_t top = 1;
  while (TreePartition::target(top - 1) * kMostRoots < all.size()) {
    ++top;
  }
  levels_.resize(top + 1);
  const std::size_t least = all.size() / TreePartition::target(top - 1) + 1;
  const std::size_t roots = (std::min(least + least / 4, kMostRoots) + kSlots - 1) / kSlots;
  std::vector<ItemRange> ranges;
  partition_.cut(all, roots, top, ranges);
  buildBelow(top, std::move(ranges), 0);
}

bool TreeBuilder::append(std::size_t records) {
  const ItemRange all{0, partition_.items().size()};
  const std::size_t top = levels_.size() - 1;
  if (all.size() > kSlots * TreePartition::target(top - 1)) {
    return false;
  }
  buildBelow(top, {all}, records);
  return true;
}

/// @param ranges a root each
void TreeBuilder::buildBelow(std::size_t top, std::vector<ItemRange> ranges, std::size_t records) {
  std::vector<ItemRange> slots;
  for (std::size_t level = top; level > 0; --level) {
    const std::size_t below = levels_[level - 1].size();
    std::vector<ItemRange> next;
    for (const ItemRange& range : ranges) {
      slots.clear();
      partition_.cut(range, kSlots, level - 1, slots);
      emit(level, slots, below, next);
    }
    ranges = std::move(next);
  }
  emitLeaves(ranges, records);
}

/// Appends a node with the given ranges as children, which come behind `below` others.
void TreeBuilder::emit(std::size_t level, const std::vector<ItemRange>& slots, std::size_t below,
                       std::vector<ItemRange>& ranges) {
  TreeNodes& nodes = levels_[level];
  nodes.first.push_back(static_cast<std::uint32_t>(below + ranges.size()));
  nodes.bounds.push_back(emptyBounds());
  for (std::size_t k = 0; k < slots.size(); ++k) {
    setSlot(nodes.bounds.back(), k, partition_.boundsOf(slots[k]));
    ranges.push_back(slots[k]);
  }
}

void TreeBuilder::emitLeaves(const std::vector<ItemRange>& ranges, std::size_t records) {
  TreeNodes& nodes = levels_[0];
  nodes.reserve(nodes.size() + ranges.size());
  for (const ItemRange& range : ranges) {
    nodes.first.push_back(static_cast<std::uint32_t>(records + range.begin));
    nodes.bounds.push_back(emptyBounds());
    for (std::size_t i = range.begin; i < range.end; ++i) {
      setSlot(nodes.bounds.back(), i - range.begin, partition_.items()[i].bounds);
    }
  }
}

}  // namespace box_query
