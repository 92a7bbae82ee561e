// SPDX-License-Identifier: BSD-3-Clause
#include "scene/box_tree.h"

#include "kernels/float_bounds.h"
#include "kernels/kernels.h"
#include "scene/box_bounds.h"
#include "scene/tree_builder.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <variant>

namespace box_query {
namespace {

/// The median of a sample of the boxes that kernels may take, so that a few boxes far away do not
/// cost the others the precision of float.
void findCenter(const SceneBoxes& boxes, double* center) {
  constexpr std::size_t kSample = 33;
  const std::size_t count = std::min(kSample, boxes.size());
  std::array<std::array<double, kSample>, 3> sample;
  std::size_t size = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t end = (k + 1) * boxes.size() / count;
    for (std::size_t i = k * boxes.size() / count; i < end; ++i) {
      const PreparedBox box = boxes.prepared(i);
      if (box.kind != PreparedBox::Kind::kExactOnly) {
        const Extent extent = extentOf(box);
        for (int axis = 0; axis < 3; ++axis) {
          sample[axis][size] = extent.middle[axis];
        }
        ++size;
        break;
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto begin = sample[axis].begin();
    std::nth_element(begin, begin + size / 2, begin + size);
    center[axis] = size > 0 ? sample[axis][size / 2] : 0.0;
  }
}

/// Half the surface of a box.
double areaOf(const double* sides) {
  return sides[0] * sides[1] + (sides[1] + sides[0]) * sides[2];
}
double areaOf(const kernels::BoxRecord& box) {
  double sides[3];
  for (int i = 0; i < 3; ++i) {
    sides[i] = box.isAligned() ? box.column[1][i] - box.column[0][i] : 2.0 * box.extent[i];
  }
  return areaOf(sides);
}

/// How many points of as many, all over something of these sides, a cube of a radius reaches, in
/// the mean over all cubes that reach it.
double boxesReached(double points, const double* sides, double radius) {
  for (int i = 0; i < 3; ++i) {
    points *= 2.0 * radius / (sides[i] + 2.0 * radius);
  }
  return points;
}

}  // namespace

// A box is prepared twice, which takes less time than to keep it.
BoxTree::BoxTree(const SceneBoxes& boxes) {
  findCenter(boxes, center_);
  std::vector<Item> items;
  items.reserve(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const PreparedBox box = boxes.prepared(i);
    Item item;
    item.box = i;
    if (box.kind != PreparedBox::Kind::kExactOnly &&
        findBounds(extentOf(box), center_, item.bounds)) {
      items.push_back(item);
    } else {
      left_out_.push_back(i);
    }
  }
  if (items.empty()) {
    return;
  }
  TreeBuilder builder(levels_, std::move(items));
  builder.build();
  addRecords(boxes, builder.items());
  addLeaves();
  for (const TreeNodes& level : levels_) {
    built_nodes_.push_back(level.size());
  }
  built_records_ = records_.size();
  measure();
  built_cost_ = cost_;
  setBlocks();
}

void BoxTree::addRecords(const SceneBoxes& boxes, const std::vector<Item>& items) {
  records_.reserve(records_.size() + items.size());
  box_of_record_.reserve(records_.size() + items.size());
  rests_.reserve(kernels::active().find_rests != nullptr ? records_.size() + items.size() : 0);
  for (const Item& item : items) {
    records_.push_back(recordOf(boxes.prepared(item.box)));
    has_aligned_ = has_aligned_ || records_.back().isAligned();
    box_of_record_.push_back(item.box);
    setRests(boxes, records_.size() - 1);
  }
}

void BoxTree::setRests(const SceneBoxes& boxes, std::size_t record) {
  const auto find = kernels::active().find_rests;
  if (find == nullptr) {
    return;
  }
  rests_.resize(records_.size());
  if (const auto* box = std::get_if<OrientedBox>(&boxes.simplest(box_of_record_[record]))) {
    find(box->orientation.coeffs().data(), records_[record], rests_[record]);
  }
}

/// Of nodes that have none yet.
void BoxTree::addLeaves() {
  const TreeNodes& nodes = levels_.front();
  leaves_.reserve(nodes.size());
  for (std::size_t node = leaves_.size(); node < nodes.size(); ++node) {
    leaves_.push_back(emptyLeaf());
    const std::size_t children = nodes.childrenOf(node, records_.size());
    for (std::size_t slot = 0; slot < children; ++slot) {
      setSlot(leaves_.back(), slot, records_[nodes.first[node] + slot], center_);
    }
  }
}

/// Finds out what depends on all bounds together.
void BoxTree::measure() {
  FloatBounds around;
  around_nodes_ = emptyBounds();
  for (std::size_t node = 0; node < levels_.back().size(); ++node) {
    const FloatBounds slots = aroundSlots(levels_.back().bounds[node]);
    setSlot(around_nodes_, node, slots);
    around.add(slots);
  }
  double area = 0.0;
  for (const kernels::Bounds& bounds : levels_.front().bounds) {
    area += 2.0 * areaOfSlots(bounds);
  }
  double volume = 1.0;
  double longest = 0.0;
  for (int i = 0; i < 3; ++i) {
    around_[0][i] = around.lo[i];
    around_[1][i] = around.hi[i];
    const double side = around_[1][i] - around_[0][i];
    volume *= side;
    longest = std::max(longest, side);
  }
  // A ray meets a convex body of surface S as often as a disc of S / 4 (Cauchy).
  const double free = 4.0 * volume / area;
  mean_free_path_ = std::min(std::max(free, longest / 64.0), 2.0 * longest);
  bounds_met_ = longest / free;
  measureRadius(std::sqrt(area / (6.0 * static_cast<double>(records_.size()))));
  constexpr double kMostApart = 50.0;  // measured
  is_full_ = area > kMostApart * 2.0 * static_cast<double>(around.area());

  cost_ = 0.0;
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    for (const kernels::Bounds& bounds : levels_[level].bounds) {
      cost_ += areaOfSlots(bounds);
    }
  }
  cost_ /= static_cast<double>(around.area());
}

/// Finds the radius up to which the cube of a point reaches few boxes, in the mean over all points
/// that may be so near: of boxes without extent, all over the scene, and of each leaf all over it.
/// None, where floats tell boxes of that mean side hardly apart, some being far away from others.
void BoxTree::measureRadius(double mean_side) {
  constexpr double kFew = 4.0;  // measured
  const auto count = static_cast<double>(records_.size());
  most_radius_ = kernels::kLargestRadius;
  if (count <= kFew) {
    return;
  }
  double sides[3];
  double longest = 0.0;
  double reach = 0.0;
  for (int i = 0; i < 3; ++i) {
    sides[i] = around_[1][i] - around_[0][i];
    longest = std::max(longest, sides[i]);
    reach += std::max(std::fabs(around_[0][i]), std::fabs(around_[1][i]));
  }
  constexpr double kApart = 0.5;  // measured
  if (reach * kernels::bounds::kApart > kApart * mean_side) {
    most_radius_ = 0.0;
    return;
  }
  constexpr double kAll = 64.0;  // times the scene: more than kFew of five boxes
  most_radius_ = std::min(most_radius_, kAll * longest);
  const double least = 0x1p-24 * longest;
  while (boxesReached(count, sides, most_radius_) > kFew ||
         boxesReachedInLeaves(most_radius_) > kFew) {
    most_radius_ = most_radius_ > least ? 0.75 * most_radius_ : 0.0;
  }
}

/// Of a leaf, in the mean over a sample of them; 0 if there is but a list.
double BoxTree::boxesReachedInLeaves(double radius) const {
  if (levels_.size() < 2) {
    return 0.0;
  }
  constexpr std::size_t kSample = 64;
  const TreeNodes& parents = levels_[1];
  const std::size_t step = (parents.size() - 1) / kSample + 1;
  double reached = 0.0;
  double leaves = 0.0;
  for (std::size_t node = 0; node < parents.size(); node += step) {
    const kernels::Bounds& bounds = parents.bounds[node];
    const std::size_t leaf = parents.first[node];  // the first stands for its neighbours
    double sides[3];
    for (int i = 0; i < 3; ++i) {
      sides[i] = std::max(0.0F, bounds.plane[1][i][0] - bounds.plane[0][i][0]);
    }
    const auto boxes = static_cast<double>(levels_[0].childrenOf(leaf, records_.size()));
    reached += boxesReached(boxes, sides, radius);
    leaves += 1.0;
  }
  return reached / leaves;
}

/// Of the bounds of boxes that a ray through all of it meets, how many do so in vain: of a convex
/// body each surface is met as often as it is large (Cauchy).
double BoxTree::metInVain() const {
  double area = 0.0;
  for (const kernels::Bounds& bounds : levels_.front().bounds) {
    area += areaOfSlots(bounds);
  }
  for (std::size_t k = 0; k < records_.size(); ++k) {
    area -= isGone(k) ? 0.0 : areaOf(records_[k]);
  }
  double sides[3];
  for (int i = 0; i < 3; ++i) {
    sides[i] = around_[1][i] - around_[0][i];
  }
  return area / areaOf(sides);
}

/// Keeps the boxes in blocks where that is faster, and those that are gone out of them.
void BoxTree::setBlocks() {
  blocks_.clear();
  if (records_.size() > kernels::kMostInBlocks ||
      !kernels::active().prefers_blocks(records_.size(), {bounds_met_, metInVain()})) {
    return;
  }
  blocks_ = blocksOf(records_, center_);
  for (std::size_t k = 0; k < records_.size() && !blocks_.empty(); ++k) {
    if (isGone(k)) {
      clearSlot(blocks_[k / kernels::kSlots], k % kernels::kSlots);
    }
  }
}

kernels::SceneView BoxTree::view() const {
  kernels::SceneView view = {};
  view.depth = static_cast<int>(levels_.size());
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    view.levels[i] = {levels_[i].bounds.data(), levels_[i].first.data(),
                      static_cast<std::uint32_t>(levels_[i].bounds.size())};
  }
  constexpr std::uint32_t kNodes = 2;  // as soon compared as what is around them
  static constexpr std::uint32_t kFirst[] = {0};
  view.depth_together = view.depth;
  if (view.depth > 0 && view.levels[view.depth - 1].nodes > kNodes) {
    view.levels[view.depth] = {&around_nodes_, kFirst, 1};
    view.depth_together = view.depth + 1;
  }
  view.blocks = blocks_.data();
  view.boxes_in_blocks = static_cast<std::uint32_t>(blocks_.empty() ? 0 : records_.size());
  view.around_nodes = &around_nodes_;
  view.leaves = leaves_.data();
  view.records = records_.data();
  view.rests = rests_.data();
  view.num_records = static_cast<std::uint32_t>(records_.size());
  view.box_of_record = box_of_record_.data();
  double reach = 0.0;
  for (int i = 0; i < 3; ++i) {
    view.center[i] = center_[i];
    // (As they were found, from floats.)
    view.around[0][i] = static_cast<float>(around_[0][i]);
    view.around[1][i] = static_cast<float>(around_[1][i]);
    reach += std::max(std::fabs(around_[0][i]), std::fabs(around_[1][i]));
  }
  namespace bounds = kernels::bounds;
  view.apart = static_cast<float>((reach * bounds::kApart + bounds::kFloatUnderflow) *
                                  (bounds::kUp * bounds::kUp));
  view.is_heap = bounds_met_ > kernels::kManyBounds;
  constexpr double kFew = 1.8;  // measured
  view.meets_few_leaves = levels_.size() == 2 && cost_ < kFew;
  view.has_aligned = has_aligned_;
  view.mean_free_path = mean_free_path_;
  view.most_radius = most_radius_;
  return view;
}

}  // namespace box_query
