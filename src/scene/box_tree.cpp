// SPDX-License-Identifier: BSD-3-Clause
#include "scene/box_tree.h"

#include "kernels/float_bounds.h"
#include "scene/tree_partition.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace box_query {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr std::size_t kSlots = kernels::kSlots;
/// Boxes that are best kept in one list.
constexpr std::size_t kFlat = 128;
/// Boxes that are sooner compared themselves than by their bounds: at most 64.
constexpr std::size_t kInBlocks = 16;
/// Roots are compared all: more of them save a level, for longer.
constexpr std::size_t kMostRoots = 96;
static_assert(kFlat <= kSlots * kernels::kMostRootNodes, "all nodes of a list are roots");
static_assert(kMostRoots <= kSlots * kernels::kMostRootNodes, "and so are those of the last level");

/// The middle of a box and how far it reaches along the axes of the world.
struct Reach {
  double middle[3];
  double half[3];
};

Reach reachOf(const PreparedBox& box) {
  Reach r;
  if (box.kind == PreparedBox::Kind::kAligned) {
    for (int j = 0; j < 3; ++j) {
      r.middle[j] = 0.5 * (box.aligned.bound[0][j] + box.aligned.bound[1][j]);
      r.half[j] = 0.5 * (box.aligned.bound[1][j] - box.aligned.bound[0][j]);
    }
    return r;
  }
  const OrientedSlabs& slabs = box.oriented;
  for (int j = 0; j < 3; ++j) {
    r.middle[j] = slabs.center[j];
    r.half[j] = std::fabs(slabs.axes[0][j]) * slabs.half_extents[0] +
                std::fabs(slabs.axes[1][j]) * slabs.half_extents[1] +
                std::fabs(slabs.axes[2][j]) * slabs.half_extents[2];
  }
  return r;
}

/// More than what rounding takes from a bound, relative to |middle| + half: the axes are within 10
/// units of 2^-53, and a difference in double and a float follow.
constexpr double kOutward = 0x1p-23;

bool boundsOf(const Reach& r, const double* center, FloatBounds& bounds) {
  for (int j = 0; j < 3; ++j) {
    const double middle = r.middle[j] - center[j];
    // The middle of an aligned box is rounded at its own size, not at that of the difference.
    const double slack =
        kOutward * (std::fabs(middle) + r.half[j]) + 0x1p-50 * std::fabs(r.middle[j]) + 0x1p-100;
    bounds.lo[j] = static_cast<float>((middle - r.half[j]) - slack);
    bounds.hi[j] = static_cast<float>((middle + r.half[j]) + slack);
    if (!(std::fabs(middle) + r.half[j] < kernels::kFarthestOrigin)) {
      return false;
    }
  }
  return true;
}

kernels::BoxRecord recordOf(const PreparedBox& box) {
  kernels::BoxRecord record = {};
  if (box.kind == PreparedBox::Kind::kAligned) {
    for (int i = 0; i < 3; ++i) {
      record.column[0][i] = box.aligned.bound[0][i];
      record.column[1][i] = box.aligned.bound[1][i];
    }
    record.extent[3] = -1.0;
    return record;
  }
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      record.column[j][i] = box.oriented.axes[i][j];
    }
    record.column[j][3] = box.oriented.center[j];
    record.extent[j] = box.oriented.half_extents[j];
  }
  record.extent[3] = box.oriented.padded_extent_sum;
  return record;
}

/// Boxes in blocks; none if one of them is too far away, or too large.
/// @pre every one is for the kernels
std::vector<kernels::BoxBlock> blocksOf(const std::vector<kernels::BoxRecord>& records,
                                        const double* scene_center) {
  constexpr std::size_t kBlockSlots = kernels::kBlockSlots;
  std::vector<kernels::BoxBlock> blocks((records.size() + kBlockSlots - 1) / kBlockSlots);
  for (std::size_t k = 0; k < kBlockSlots * blocks.size(); ++k) {
    kernels::BoxBlock& block = blocks[k / kBlockSlots];
    const std::size_t slot = k % kBlockSlots;
    if (k >= records.size()) {
      for (int i = 0; i < 3; ++i) {
        block.extent[i][slot] = -kInf;
      }
      continue;
    }
    const kernels::BoxRecord& box = records[k];
    double extents[3];
    double size = 0.0;
    double pad = kernels::bounds::kFloatUnderflow;
    for (int j = 0; j < 3; ++j) {
      double middle = box.column[j][3];
      extents[j] = box.extent[j];
      for (int i = 0; i < 3; ++i) {
        block.axis[i][j][slot] = static_cast<float>(box.column[j][i]);
      }
      if (box.isAligned()) {
        middle = 0.5 * (box.column[0][j] + box.column[1][j]);
        extents[j] = 0.5 * (box.column[1][j] - box.column[0][j]);
        for (int i = 0; i < 3; ++i) {
          block.axis[i][j][slot] = i == j ? 1.0F : 0.0F;
        }
        pad += 0x1p-50 * std::fabs(middle);  // it is rounded at its own size
      }
      const double relative = middle - scene_center[j];
      block.center[j][slot] = static_cast<float>(relative);
      size += std::fabs(relative) + extents[j];
    }
    if (!(size <= kernels::kFarthestInBlocks)) {
      return {};
    }
    pad += kernels::bounds::kBlock * size;
    for (int i = 0; i < 3; ++i) {
      block.extent[i][slot] = static_cast<float>((extents[i] + pad) * kernels::bounds::kUp);
    }
  }
  return blocks;
}

void setEmpty(kernels::Bounds& bounds) {
  for (int i = 0; i < 3; ++i) {
    std::fill(std::begin(bounds.plane[0][i]), std::end(bounds.plane[0][i]), kInf);
    std::fill(std::begin(bounds.plane[1][i]), std::end(bounds.plane[1][i]), -kInf);
  }
}

void setSlot(kernels::Bounds& bounds, std::size_t slot, const FloatBounds& b) {
  for (int i = 0; i < 3; ++i) {
    bounds.plane[0][i][slot] = b.lo[i];
    bounds.plane[1][i][slot] = b.hi[i];
  }
}

}  // namespace

/// Makes the levels of a tree, from the top.
class TreeBuilder {
 public:
  TreeBuilder(BoxTree& tree, std::vector<Item> items) : tree_(tree), partition_(std::move(items)) {}

  void build() {
    const ItemRange all{0, partition_.items().size()};
    // The nodes of a level as ranges of items.
    std::vector<ItemRange> ranges;
    if (all.size() <= kFlat) {
      tree_.levels_.resize(1);
      for (std::size_t begin = 0; begin < all.end; begin += kSlots) {
        ranges.push_back({begin, std::min(begin + kSlots, all.end)});
      }
      emitLeaves(ranges);
      return;
    }
    std::size_t top = 1;
    while (TreePartition::target(top - 1) * kMostRoots < all.size()) {
      ++top;
    }
    tree_.levels_.resize(top + 1);
    const std::size_t least = all.size() / TreePartition::target(top - 1) + 1;
    const std::size_t roots = (std::min(least + least / 4, kMostRoots) + kSlots - 1) / kSlots;
    std::vector<ItemRange> slots;
    partition_.cut(all, roots * kSlots, top - 1, slots);
    emit(top, slots, ranges);
    for (std::size_t level = top - 1; level > 0; --level) {
      std::vector<ItemRange> below;
      for (const ItemRange& range : ranges) {
        slots.clear();
        partition_.cut(range, kSlots, level - 1, slots);
        emit(level, slots, below);
      }
      ranges = std::move(below);
    }
    emitLeaves(ranges);
  }

  const std::vector<Item>& items() const { return partition_.items(); }

 private:
  /// Appends nodes with the given ranges as children: one, or as many roots as it takes.
  void emit(std::size_t level, const std::vector<ItemRange>& slots, std::vector<ItemRange>& below) {
    auto& nodes = tree_.levels_[level];
    for (std::size_t k = 0; k < slots.size(); ++k) {
      if (k % kSlots == 0) {
        nodes.first.push_back(static_cast<std::uint32_t>(below.size()));
        setEmpty(nodes.bounds.emplace_back());
      }
      setSlot(nodes.bounds.back(), k % kSlots, partition_.boundsOf(slots[k]));
      below.push_back(slots[k]);
    }
  }

  void emitLeaves(const std::vector<ItemRange>& ranges) {
    auto& nodes = tree_.levels_[0];
    for (const ItemRange& range : ranges) {
      nodes.first.push_back(static_cast<std::uint32_t>(range.begin));
      setEmpty(nodes.bounds.emplace_back());
      for (std::size_t i = range.begin; i < range.end; ++i) {
        setSlot(nodes.bounds.back(), i - range.begin, partition_.items()[i].bounds);
      }
    }
  }

  BoxTree& tree_;
  TreePartition partition_;
};

namespace {

/// The median of a sample, so that a few boxes far away do not cost the others the precision of
/// float.
void findCenter(const std::vector<Reach>& reaches, double* center) {
  constexpr std::size_t kSample = 33;
  const std::size_t count = std::min(kSample, reaches.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::array<double, kSample> sample;
    for (std::size_t k = 0; k < count; ++k) {
      sample[k] = reaches[k * reaches.size() / count].middle[axis];
    }
    std::nth_element(sample.begin(), sample.begin() + count / 2, sample.begin() + count);
    center[axis] = count > 0 ? sample[count / 2] : 0.0;
  }
}

}  // namespace

BoxTree::BoxTree(const std::vector<PreparedBox>& boxes) {
  std::vector<Reach> reaches;
  std::vector<std::uint32_t> numbers;
  reaches.reserve(boxes.size());
  numbers.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].kind == PreparedBox::Kind::kExactOnly) {
      left_out_.push_back(static_cast<std::uint32_t>(i));
    } else {
      reaches.push_back(reachOf(boxes[i]));
      numbers.push_back(static_cast<std::uint32_t>(i));
    }
  }
  findCenter(reaches, center_);
  std::vector<Item> items;
  items.reserve(reaches.size());
  for (std::size_t k = 0; k < reaches.size(); ++k) {
    Item item;
    item.box = numbers[k];
    if (boundsOf(reaches[k], center_, item.bounds)) {
      items.push_back(item);
    } else {
      left_out_.push_back(item.box);
    }
  }
  std::sort(left_out_.begin(), left_out_.end());
  if (items.empty()) {
    return;
  }

  FloatBounds around;
  double area = 0.0;
  for (const Item& item : items) {
    around.add(item.bounds);
    area += 2.0 * static_cast<double>(item.bounds.area());
  }
  double volume = 1.0;
  double longest = 0.0;
  for (int i = 0; i < 3; ++i) {
    around_[0][i] = around.lo[i];
    around_[1][i] = around.hi[i];
    const double side = static_cast<double>(around.hi[i]) - around.lo[i];
    volume *= side;
    longest = std::max(longest, side);
  }
  // A ray meets a convex body of surface S as often as a disc of S / 4 (Cauchy).
  mean_free_path_ = std::min(std::max(4.0 * volume / area, longest / 64.0), 2.0 * longest);

  TreeBuilder builder(*this, std::move(items));
  builder.build();
  records_.reserve(builder.items().size());
  box_of_record_.reserve(builder.items().size());
  for (const Item& item : builder.items()) {
    records_.push_back(recordOf(boxes[item.box]));
    has_aligned_ = has_aligned_ || records_.back().isAligned();
    box_of_record_.push_back(item.box);
  }
  if (records_.size() <= kInBlocks) {
    blocks_ = blocksOf(records_, center_);
  }
}

kernels::SceneView BoxTree::view() const {
  kernels::SceneView view = {};
  view.depth = static_cast<int>(levels_.size());
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    view.levels[i] = {levels_[i].bounds.data(), levels_[i].first.data(),
                      static_cast<std::uint32_t>(levels_[i].bounds.size())};
  }
  view.blocks = blocks_.data();
  view.num_blocks = static_cast<std::uint32_t>(blocks_.size());
  view.records = records_.data();
  view.box_of_record = box_of_record_.data();
  for (int i = 0; i < 3; ++i) {
    view.center[i] = center_[i];
    view.around[0][i] = around_[0][i];
    view.around[1][i] = around_[1][i];
  }
  view.has_aligned = has_aligned_;
  view.mean_free_path = mean_free_path_;
  return view;
}

}  // namespace box_query
