// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed_bars.h"

#include "benchmark/format.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace box_query::benchmark {
namespace {

constexpr std::size_t kAnySize = std::numeric_limits<std::size_t>::max();

/// In every workload of some kinds and sizes: how many times our time the best of some methods
/// takes.
struct Promise {
  const char* name;
  Question question;
  Mode mode;
  std::vector<std::string> kinds;  ///< None: all scenes.
  std::size_t least;
  std::size_t most;
  std::vector<std::string> methods;  ///< How their names begin.
  double limit;
};

const std::vector<std::string> kEven = {"sparse", "dense"};
const std::vector<std::string> kAll = {};
const std::vector<std::string> kEmbree = {"Embree"};

const std::vector<Promise>& promises() {
  using Q = Question;
  constexpr Mode kOne = Mode::kSingle;
  constexpr Mode kMany = Mode::kBatch;
  static const std::vector<Promise> all = {
      // clang-format off
      {"closest of 16 in cache, eight double slabs at once over ours",
       Q::kClosest30, kOne, {"pairs"}, 0, kAnySize, {"double slabs, eight at once"}, 1.0},
      {"closest of 16 in cache, listing 9 over ours",
       Q::kClosest30, kOne, {"pairs"}, 0, kAnySize, {"listing 9"}, 10.0},
      {"distance of 16 in cache, exact scalar ones over ours",
       Q::kClearance, kOne, {"pairs apart"}, 0, kAnySize, {"exact distances, one by one"}, 10.0},
      {"distance of 16 in cache, plain scalar ones over ours",
       Q::kClearance, kOne, {"pairs apart"}, 0, kAnySize, {"double slabs, one by one"}, 10.0},
      {"closest of 8 to 32, Embree over ours",
       Q::kClosest30, kOne, kEven, 8, 32, kEmbree, 1.5},
      {"closest of recorded scenes, Embree over ours",
       Q::kClosest30, kOne, {"recorded", "merged"}, 0, kAnySize, kEmbree, 1.5},
      {"closest of 64 to 256, Embree over ours",
       Q::kClosest30, kOne, kEven, 64, 256, kEmbree, 1.4},
      {"closest of 1,000 to 100,000 sparse, Embree over ours",
       Q::kClosest30, kOne, {"sparse"}, 1000, 100000, kEmbree, 1.3},
      {"closest of 1,000 to 100,000 dense, Embree over ours",
       Q::kClosest30, kOne, {"dense"}, 1000, 100000, kEmbree, 1.5},
      {"closest of 1,000 to 100,000 in clusters, Embree over ours",
       Q::kClosest30, kOne, {"clusters"}, 1000, 100000, kEmbree, 1.3},
      {"closest of 1,000 to 100,000 needles, Embree over ours",
       Q::kClosest30, kOne, {"needles"}, 1000, 100000, kEmbree, 1.8},
      {"closest of 1,000 to 100,000 on shelves, Embree over ours",
       Q::kClosest30, kOne, {"shelves"}, 1000, 100000, kEmbree, 1.0},
      {"any, Embree over ours",
       Q::kAny30, kOne, kAll, 0, kAnySize, kEmbree, 1.2},
      {"segment, Embree over ours",
       Q::kSegment, kOne, kAll, 0, kAnySize, kEmbree, 1.2},
      {"closest, Bullet over ours",
       Q::kClosest30, kOne, kAll, 0, kAnySize, {"Bullet"}, 8.0},
      {"any, Bullet over ours",
       Q::kAny30, kOne, kAll, 0, kAnySize, {"Bullet"}, 8.0},
      {"segment, Bullet over ours",
       Q::kSegment, kOne, kAll, 0, kAnySize, {"Bullet"}, 8.0},
      {"closest in batches, 1,000, Embree's best over ours",
       Q::kClosest30, kMany, kEven, 1000, 1000, kEmbree, 1.3},
      {"closest in batches, 10,000, Embree's best over ours",
       Q::kClosest30, kMany, kEven, 10000, 10000, kEmbree, 2.0},
      {"closest in batches, 100,000, Embree's best over ours",
       Q::kClosest30, kMany, kEven, 100000, 100000, kEmbree, 2.5},
      {"closest in batches of 1,000 and more, one thread over two",
       Q::kClosest30, Mode::kThreads, kEven, 1000, kAnySize, {"box_query, 1 thread"}, 1.8},
      {"clearance of 8 to 128, Embree's point query over ours",
       Q::kClearance, kOne, kEven, 8, 128, kEmbree, 2.0},
      {"clearance of 1,000 and more, FCL and Bullet over ours",
       Q::kClearance, kOne, kEven, 1000, kAnySize, {"FCL", "Bullet"}, 10.0},
      {"clearance in batches of 1,000 and more, FCL and Bullet over ours",
       Q::kClearance, kMany, kEven, 1000, kAnySize, {"FCL", "Bullet"}, 15.0},
      // clang-format on
  };
  return all;
}

bool beginsWithOneOf(const std::string& name, const std::vector<std::string>& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](const std::string& beginning) { return name.rfind(beginning, 0) == 0; });
}

bool contains(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

/// The best of the methods that count, in each workload, the worst first.
std::vector<const SpeedRow*> cellsOf(const Promise& promise, const std::vector<SpeedRow>& rows) {
  std::vector<const SpeedRow*> cells;
  for (const SpeedRow& row : rows) {
    if (row.question != promise.question || row.mode != promise.mode || row.boxes < promise.least ||
        row.boxes > promise.most || !beginsWithOneOf(row.method, promise.methods) ||
        (!promise.kinds.empty() && !contains(promise.kinds, row.workload))) {
      continue;
    }
    const auto same = std::find_if(cells.begin(), cells.end(), [&](const SpeedRow* cell) {
      return cell->workload == row.workload && cell->boxes == row.boxes;
    });
    if (same == cells.end()) {
      cells.push_back(&row);
    } else if (row.timing.ratio.median < (*same)->timing.ratio.median) {
      *same = &row;
    }
  }
  std::sort(cells.begin(), cells.end(), [](const SpeedRow* a, const SpeedRow* b) {
    return a->timing.ratio.median < b->timing.ratio.median;
  });
  return cells;
}

std::optional<Bar> barOf(const Promise& promise, const std::vector<SpeedRow>& rows) {
  const std::vector<const SpeedRow*> cells = cellsOf(promise, rows);
  if (cells.empty()) {
    return std::nullopt;
  }
  constexpr std::size_t kShown = 6;
  std::string beside;
  for (std::size_t i = 0; i < std::min(kShown, cells.size()); ++i) {
    beside += format("%s%s %zu: %.2f", i == 0 ? "" : ", ", cells[i]->workload.c_str(),
                     cells[i]->boxes, cells[i]->timing.ratio.median);
  }
  if (cells.size() > kShown) {
    beside +=
        format(", %zu more up to %.2f", cells.size() - kShown, cells.back()->timing.ratio.median);
  }
  return Bar{promise.name, cells.front()->timing.ratio.median, Bar::kAtLeast, promise.limit, "",
             beside};
}

/// Million boxes a second, in the scenes of 10,000.
std::optional<Bar> rateBar(const char* name, Question question, double limit,
                           const std::vector<SpeedRow>& rows) {
  double slowest = std::numeric_limits<double>::infinity();
  std::string beside;
  for (const SpeedRow& row : rows) {
    if (row.question == question && row.method == "box_query" && row.boxes == 10000) {
      const double millions = 1e3 / row.timing.ns.median;
      slowest = std::min(slowest, millions);
      beside += (beside.empty() ? "" : ", ") + row.workload + format(": %.2f", millions);
    }
  }
  if (beside.empty()) {
    return std::nullopt;
  }
  return Bar{name, slowest, Bar::kAtLeast, limit, " million boxes", beside};
}

}  // namespace

std::vector<Bar> speedBars(const std::vector<SpeedRow>& rows) {
  std::vector<Bar> bars;
  for (const Promise& promise : promises()) {
    if (const auto bar = barOf(promise, rows)) {
      bars.push_back(*bar);
    }
  }
  for (const auto& bar : {rateBar("build of 10,000, a second", Question::kBuild, 1.5, rows),
                          rateBar("update of 10,000, a second", Question::kUpdate, 5.0, rows)}) {
    if (bar) {
      bars.push_back(*bar);
    }
  }
  return bars;
}

}  // namespace box_query::benchmark
