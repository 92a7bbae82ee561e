// SPDX-License-Identifier: BSD-3-Clause
#include "scene/tree_partition.h"

#include <array>
#include <cmath>

namespace box_query {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr std::size_t kSlots = kernels::kSlots;
constexpr double kFill = 0.8;

}  // namespace

TreePartition::TreePartition(std::vector<Item> items) : items_(std::move(items)) {}

FloatBounds TreePartition::boundsOf(const ItemRange& range) const {
  FloatBounds b;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    b.add(items_[i].bounds);
  }
  return b;
}

std::size_t TreePartition::capacity(std::size_t level) {
  return kSlots << (4 * level);
}

std::size_t TreePartition::target(std::size_t level) {
  return static_cast<std::size_t>(std::pow(kFill, static_cast<double>(level)) *
                                  static_cast<double>(capacity(level)));
}

void TreePartition::cut(const ItemRange& range, std::size_t budget, std::size_t level,
                        std::vector<ItemRange>& result) {
  if (budget == 1 || range.size() <= target(level)) {
    result.push_back(range);
    return;
  }
  const std::size_t room = capacity(level);
  const auto needed = [&](std::size_t n) { return (n + room - 1) / room; };
  // Full nodes on one side are always allowed.
  const std::size_t full = needed(range.size()) / 2 * room;
  const std::size_t middle =
      split(range, full > 0 ? full : range.size() / 2,
            [&](std::size_t left) { return needed(left) + needed(range.size() - left) <= budget; });
  const ItemRange left{range.begin, middle};
  const ItemRange right{middle, range.end};
  const double share = static_cast<double>(left.size()) / static_cast<double>(range.size());
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): no number here is negative
  const auto fair = static_cast<std::size_t>(share * static_cast<double>(budget) + 0.5);
  const std::size_t least = needed(left.size());
  const std::size_t most = budget - needed(right.size());
  const std::size_t for_left = std::max(least, std::min(fair, most));
  cut(left, for_left, level, result);
  cut(right, budget - for_left, level, result);
}

void TreePartition::cutFull(const ItemRange& range, std::vector<ItemRange>& result) {
  if (range.size() <= kSlots) {
    result.push_back(range);
    return;
  }
  const std::size_t leaves = (range.size() + kSlots - 1) / kSlots;
  const std::size_t middle =
      split(range, leaves / 2 * kSlots, [](std::size_t /*left*/) { return false; });
  cutFull({range.begin, middle}, result);
  cutFull({middle, range.end}, result);
}

/// Reorders a range of at least two items around where it is best cut, or else behind `fallback`
/// of them.
template <typename IsAllowed>
std::size_t TreePartition::split(const ItemRange& range, std::size_t fallback,
                                 IsAllowed&& is_allowed) {
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
    // NOLINTNEXTLINE(bugprone-integer-division): whole leaves
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
    std::nth_element(at(range.begin), at(middle), at(range.end),
                     [&](const Item& a, const Item& b) { return a.middle(axis) < b.middle(axis); });
    return middle;
  }
  const auto middle = std::partition(at(range.begin), at(range.end),
                                     [&](const Item& item) { return binOf(item) < best_bin; });
  return static_cast<std::size_t>(middle - items_.begin());
}

}  // namespace box_query
