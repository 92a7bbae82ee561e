// SPDX-License-Identifier: BSD-3-Clause
#include "scene/box_tree.h"

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
/// Roots are compared all: more of them save a level, for longer.
constexpr std::size_t kMostRoots = 96;
/// Of the capacity of an inner node, how much is used before it is split: room for uneven splits.
constexpr double kFill = 0.8;

/// Bounds relative to the center of the scene, rounded outward.
struct FloatBounds {
  float lo[3] = {kInf, kInf, kInf};
  float hi[3] = {-kInf, -kInf, -kInf};

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

/// Cuts the items into ranges, level by level from the top.
class TreeBuilder {
 public:
  TreeBuilder(BoxTree& tree, std::vector<Item> items) : tree_(tree), items_(std::move(items)) {}

  void build() {
    const std::size_t n = items_.size();
    std::size_t depth = 1;
    std::size_t roots = (n + kSlots - 1) / kSlots;
    capacity_[0] = target_[0] = kSlots;
    if (n > kFlat) {
      while (depth == 1 || target_[depth - 2] * kMostRoots < n) {
        ++depth;
        capacity_[depth - 1] = capacity_[depth - 2] * kSlots;
        target_[depth - 1] =
            static_cast<std::size_t>(kFill * static_cast<double>(target_[depth - 2] * kSlots));
      }
      roots = (n + target_[depth - 2] - 1) / target_[depth - 2];
      roots = std::min(roots + roots / 4, kMostRoots);
      roots = (roots + kSlots - 1) / kSlots;
    }
    tree_.levels_.resize(depth);

    // The nodes of a level as ranges of items; the roots share one range.
    std::vector<Range> ranges;
    if (depth == 1) {
      for (std::size_t begin = 0; begin < n; begin += kSlots) {
        ranges.push_back({begin, std::min(begin + kSlots, n)});
      }
    } else {
      std::vector<Range> slots;
      partition({0, n}, roots * kSlots, depth - 2, slots);
      emit(depth - 1, slots, (slots.size() + kSlots - 1) / kSlots, ranges);
      for (std::size_t level = depth - 2; level > 0; --level) {
        std::vector<Range> below;
        auto& nodes = tree_.levels_[level];
        nodes.bounds.reserve(ranges.size());
        nodes.first.reserve(ranges.size());
        for (const Range& range : ranges) {
          slots.clear();
          partition(range, kSlots, level - 1, slots);
          emit(level, slots, 1, below);
        }
        ranges = std::move(below);
      }
    }
    emitLeaves(ranges);
  }

  std::vector<Item>& items() { return items_; }

 private:
  struct Range {
    std::size_t begin;
    std::size_t end;
    std::size_t size() const { return end - begin; }
  };

  FloatBounds boundsOfRange(const Range& range) const {
    FloatBounds b;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      b.add(items_[i].bounds);
    }
    return b;
  }

  /// Appends `count` nodes at a level with the given ranges as children.
  void emit(std::size_t level, const std::vector<Range>& slots, std::size_t count,
            std::vector<Range>& below) {
    auto& nodes = tree_.levels_[level];
    for (std::size_t k = 0; k < count; ++k) {
      nodes.first.push_back(static_cast<std::uint32_t>(below.size()));
      kernels::Bounds& bounds = nodes.bounds.emplace_back();
      setEmpty(bounds);
      // Spread evenly, though only the last of several roots could be short.
      for (std::size_t slot = 0; slot < kSlots && k * kSlots + slot < slots.size(); ++slot) {
        const Range& range = slots[k * kSlots + slot];
        setSlot(bounds, slot, boundsOfRange(range));
        below.push_back(range);
      }
    }
  }

  void emitLeaves(const std::vector<Range>& ranges) {
    auto& nodes = tree_.levels_[0];
    nodes.bounds.resize(ranges.size());
    nodes.first.resize(ranges.size());
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      nodes.first[k] = static_cast<std::uint32_t>(ranges[k].begin);
      setEmpty(nodes.bounds[k]);
      for (std::size_t i = ranges[k].begin; i < ranges[k].end; ++i) {
        setSlot(nodes.bounds[k], i - ranges[k].begin, items_[i].bounds);
      }
    }
  }

  /// Cuts a range into at most `budget` nodes of a level.
  void partition(const Range& range, std::size_t budget, std::size_t level,
                 std::vector<Range>& result) {
    if (budget == 1 || range.size() <= target_[level]) {
      result.push_back(range);
      return;
    }
    const std::size_t capacity = capacity_[level];
    const auto needed = [&](std::size_t n) { return (n + capacity - 1) / capacity; };
    // Full nodes on one side are always allowed.
    const std::size_t full = needed(range.size()) / 2 * capacity;
    const std::size_t middle = split(
        range, full > 0 ? full : range.size() / 2,
        [&](std::size_t left) { return needed(left) + needed(range.size() - left) <= budget; });
    const Range left{range.begin, middle};
    const Range right{middle, range.end};
    const double share = static_cast<double>(left.size()) / static_cast<double>(range.size());
    const auto fair = static_cast<std::size_t>(share * static_cast<double>(budget) + 0.5);
    const std::size_t least = needed(left.size());
    const std::size_t most = budget - needed(right.size());
    const std::size_t for_left = std::max(least, std::min(fair, most));
    partition(left, for_left, level, result);
    partition(right, budget - for_left, level, result);
  }

  /// Reorders a range of at least two items around where it is best cut, or else behind `fallback`
  /// of them.
  template <typename IsAllowed>
  std::size_t split(const Range& range, std::size_t fallback, IsAllowed&& is_allowed) {
    float lo[3] = {kInf, kInf, kInf};
    float hi[3] = {-kInf, -kInf, -kInf};
    for (std::size_t i = range.begin; i < range.end; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        lo[axis] = std::min(lo[axis], items_[i].middle(axis));
        hi[axis] = std::max(hi[axis], items_[i].middle(axis));
      }
    }
    int axis = hi[1] - lo[1] > hi[0] - lo[0] ? 1 : 0;
    axis = hi[2] - lo[2] > hi[axis] - lo[axis] ? 2 : axis;
    const float extent = hi[axis] - lo[axis];
    if (!(extent > 0.0F)) {
      return range.begin + fallback;  // all in one place: any cut is as good
    }
    constexpr std::size_t kBins = 16;
    const float scale = static_cast<float>(kBins) / extent;
    const auto binOf = [&](const Item& item) {
      const auto bin = static_cast<std::size_t>((item.middle(axis) - lo[axis]) * scale);
      return std::min(bin, kBins - 1);
    };
    std::array<FloatBounds, kBins> bounds;
    std::array<std::size_t, kBins> counts{};
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const std::size_t bin = binOf(items_[i]);
      bounds[bin].add(items_[i].bounds);
      ++counts[bin];
    }
    const auto cost = [](const FloatBounds& b, std::size_t n) {
      return n == 0 ? 0.0F : b.area() * static_cast<float>((n + kSlots - 1) / kSlots);
    };
    std::array<float, kBins> right_cost{};
    FloatBounds right;
    std::size_t right_count = 0;
    for (std::size_t bin = kBins - 1; bin > 0; --bin) {
      right.add(bounds[bin]);
      right_count += counts[bin];
      right_cost[bin] = cost(right, right_count);
    }
    float best = kInf;
    std::size_t best_bin = 0;
    FloatBounds left;
    std::size_t left_count = 0;
    for (std::size_t bin = 1; bin < kBins; ++bin) {
      left.add(bounds[bin - 1]);
      left_count += counts[bin - 1];
      if (left_count == 0 || left_count == range.size() || !is_allowed(left_count)) {
        continue;
      }
      const float total = cost(left, left_count) + right_cost[bin];
      if (total < best) {
        best = total;
        best_bin = bin;
      }
    }
    const auto at = [&](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
    if (best_bin == 0) {
      const std::size_t middle = range.begin + fallback;
      std::nth_element(
          at(range.begin), at(middle), at(range.end),
          [&](const Item& a, const Item& b) { return a.middle(axis) < b.middle(axis); });
      return middle;
    }
    const auto middle = std::partition(at(range.begin), at(range.end),
                                       [&](const Item& item) { return binOf(item) < best_bin; });
    return static_cast<std::size_t>(middle - items_.begin());
  }

  BoxTree& tree_;
  std::vector<Item> items_;
  std::size_t capacity_[kernels::kMaxLevels] = {};
  std::size_t target_[kernels::kMaxLevels] = {};
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
    box_of_record_.push_back(item.box);
  }
}

kernels::SceneView BoxTree::view() const {
  kernels::SceneView view = {};
  view.depth = static_cast<int>(levels_.size());
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    view.levels[i] = {levels_[i].bounds.data(), levels_[i].first.data(),
                      static_cast<std::uint32_t>(levels_[i].bounds.size())};
  }
  view.records = records_.data();
  view.box_of_record = box_of_record_.data();
  for (int i = 0; i < 3; ++i) {
    view.center[i] = center_[i];
    view.around[0][i] = around_[0][i];
    view.around[1][i] = around_[1][i];
  }
  view.mean_free_path = mean_free_path_;
  return view;
}

}  // namespace box_query
