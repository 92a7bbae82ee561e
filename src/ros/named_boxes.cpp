// SPDX-License-Identifier: BSD-3-Clause
#include "ros/named_boxes.h"

#include <algorithm>
#include <limits>

namespace box_query {
namespace {

using Arrays = std::initializer_list<BoxIndices*>;

/// Calls visit(box) for each index of a box.
template <class Visit>
void forEachBox(Arrays arrays, Visit&& visit) {
  for (BoxIndices* array : arrays) {
    for (std::int32_t& box : *array) {
      if (box >= 0) {
        visit(box);
      }
    }
  }
}

/// Where the indices are few and far between.
BoxIndices renumberBySorting(Arrays arrays) {
  BoxIndices boxes;
  forEachBox(arrays, [&](std::int32_t box) { boxes.push_back(box); });
  std::sort(boxes.begin(), boxes.end());
  boxes.erase(std::unique(boxes.begin(), boxes.end()), boxes.end());
  forEachBox(arrays, [&](std::int32_t& box) {
    box = static_cast<std::int32_t>(std::lower_bound(boxes.begin(), boxes.end(), box) -
                                    boxes.begin());
  });
  return boxes;
}

/// With a table of all from `first` to `last`: a fraction of the time where it is not too long.
BoxIndices renumberByTable(Arrays arrays, std::int32_t first, std::int32_t last) {
  constexpr std::int32_t kUnnamed = -1;
  BoxIndices places(static_cast<std::size_t>(last - first) + 1, kUnnamed);
  const auto placeOf = [&](std::int32_t box) -> std::int32_t& {
    return places[static_cast<std::size_t>(box - first)];
  };
  forEachBox(arrays, [&](std::int32_t box) { placeOf(box) = 0; });
  BoxIndices boxes;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] != kUnnamed) {
      places[i] = static_cast<std::int32_t>(boxes.size());
      boxes.push_back(first + static_cast<std::int32_t>(i));
    }
  }
  forEachBox(arrays, [&](std::int32_t& box) { box = placeOf(box); });
  return boxes;
}

}  // namespace

BoxIndices renumber(Arrays arrays) {
  // Entries of a table that take as long as an index takes to be sorted.
  constexpr std::size_t kEntries = 64;
  std::size_t count = 0;
  std::int32_t first = std::numeric_limits<std::int32_t>::max();
  std::int32_t last = -1;
  forEachBox(arrays, [&](std::int32_t box) {
    ++count;
    first = std::min(first, box);
    last = std::max(last, box);
  });
  const bool close = count > 0 && static_cast<std::size_t>(last - first) / kEntries <= count;
  return close ? renumberByTable(arrays, first, last) : renumberBySorting(arrays);
}

}  // namespace box_query
