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
  std::vector<ItemRange> slots;
  partition_.cut(all, roots * kSlots, top - 1, slots);
  buildBelow(top, std::move(slots), 0);
}

bool TreeBuilder::append(std::size_t records) {
  const ItemRange all{0, partition_.items().size()};
  const std::size_t top = levels_.size() - 1;
  if (all.size() > kSlots * TreePartition::target(top - 1)) {
    return false;
  }
  std::vector<ItemRange> slots;
  partition_.cut(all, kSlots, top - 1, slots);
  buildBelow(top, std::move(slots), records);
  return true;
}

void TreeBuilder::buildBelow(std::size_t top, std::vector<ItemRange> slots, std::size_t records) {
  // The nodes of a level as ranges of items.
  std::vector<ItemRange> ranges;
  emit(top, slots, levels_[top - 1].size(), ranges);
  for (std::size_t level = top - 1; level > 0; --level) {
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

/// Appends nodes with the given ranges as children, one or as many roots as it takes, which come
/// behind `below` others.
void TreeBuilder::emit(std::size_t level, const std::vector<ItemRange>& slots, std::size_t below,
                       std::vector<ItemRange>& ranges) {
  TreeNodes& nodes = levels_[level];
  for (std::size_t k = 0; k < slots.size(); ++k) {
    if (k % kSlots == 0) {
      nodes.first.push_back(static_cast<std::uint32_t>(below + ranges.size()));
      nodes.bounds.push_back(emptyBounds());
    }
    setSlot(nodes.bounds.back(), k % kSlots, partition_.boundsOf(slots[k]));
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
