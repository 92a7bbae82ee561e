// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/accuracy_bars.h"

#include "benchmark/format.h"
#include "benchmark/methods.h"
#include "benchmark/scene_methods.h"
#include "exact/stage_counters.h"

#include <algorithm>
#include <stdexcept>

namespace box_query::benchmark {
namespace {

const Row& rowOf(const std::vector<Row>& rows, const std::string& table,
                 const std::string& method) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) {
    return r.table == table && r.input == "random" && r.prepared == "box" && r.method == method;
  });
  if (row == rows.end()) {
    throw std::logic_error("no row " + table + ", " + method);
  }
  return *row;
}

/// How many times the double slab's time, on random input with prepared boxes.
Bar overSlab(const std::vector<Row>& rows, const std::string& name, const std::string& table,
             const std::string& method, double limit) {
  const Spread& ratio = rowOf(rows, table, method).timing.ratio;
  return {name,  ratio.median, Bar::kAtMost,
          limit, "",           format("quartiles %.2f to %.2f", ratio.low, ratio.high)};
}

/// What a correctly rounded t adds to a hit of which nothing but the enclosure is known.
Bar roundingOfAHit(const Options& options) {
  const auto pairs = makePairs<Ray>(Input::kRandom, 16384, options.seed);
  Pairs<Ray> hits;
  for (std::size_t i = 0; i < pairs.boxes.size() && hits.boxes.size() < 4096; ++i) {
    if (testIntersection(pairs.components[i], pairs.boxes[i])) {
      hits.components.push_back(pairs.components[i]);
      hits.boxes.push_back(pairs.boxes[i]);
    }
  }
  const auto exactly = [] {
    const exact::StageCounters& counters = exact::stageCounters();
    return counters.exact_decisions + counters.exact_roundings;
  };
  // Those that need the exact stage are not what this bar is about.
  Pairs<Ray> plain;
  for (std::size_t i = 0; i < hits.boxes.size(); ++i) {
    const auto before = exactly();
    LibraryRounded::ask(hits.components[i], LibraryRounded::prepare(hits.boxes[i]));
    if (exactly() == before) {
      plain.components.push_back(hits.components[i]);
      plain.boxes.push_back(hits.boxes[i]);
    }
  }
  const auto boxes = prepareAll<LibraryRounded>(plain.boxes);
  const std::vector<Pass> passes = {
      [&] { return passOver<LibraryEnclosed>(plain.components, boxes); },
      [&] { return passOver<LibraryRounded>(plain.components, boxes); }};
  const auto timings = timeSideBySide(passes, plain.boxes.size(), options.rounds, 0);
  return {
      "rounding of a hit, no exact stage needed",
      timings[1].ns.median - timings[0].ns.median,
      Bar::kAtMost,
      40.0,
      " ns",
      format("%.1f ns with enclosed t, %.1f ns with rounded t; %zu of %zu hits needed no exact "
             "stage",
             timings[0].ns.median, timings[1].ns.median, plain.boxes.size(), hits.boxes.size())};
}

/// Every ray of a random scene against every box of it.
Bar slowPath(const Options& options, std::uint64_t slow_pairs) {
  const exact::StageCounters before = exact::stageCounters();
  std::uint64_t asked = 0;
  std::uint64_t hits = 0;
  for (std::uint64_t seed = options.seed; asked < slow_pairs; ++seed) {
    const RayScene scene = makeScene(Input::kRandom, 4096, seed);
    const auto boxes = prepareAll<LibraryTest>(scene.boxes);
    for (const Ray& ray : scene.rays) {
      for (const auto& box : boxes) {
        hits += LibraryTest::ask(ray, box).hit ? 1 : 0;
      }
    }
    asked += scene.rays.size() * boxes.size();
  }
  const exact::StageCounters after = exact::stageCounters();
  const auto slow = after.certified_decisions - before.certified_decisions;
  return {"slow path, in 1e8 random pairs",
          1e8 * static_cast<double>(slow) / static_cast<double>(asked),
          Bar::kAtMost,
          1.0,
          "",
          format("%llu of %.3g pairs, %.1f %% hits", static_cast<unsigned long long>(slow),
                 static_cast<double>(asked),
                 100.0 * static_cast<double>(hits) / static_cast<double>(asked))};
}

/// A scene where everything ties against the same scene jittered by 1e-6 m.
template <typename Query>
Bar tie(const std::string& name, const RayScene& scene, const Options& options, Query&& query) {
  const RayScene moved = jittered(scene, 1e-6, options.seed);
  const Scene tied_scene = sceneOf(scene.boxes);
  const Scene moved_scene = sceneOf(moved.boxes);
  const auto [tied, plain] = timeEachOfTwo(
      [&](std::size_t i) { return query(tied_scene, scene.rays[i]); },
      [&](std::size_t i) { return query(moved_scene, moved.rays[i]); }, scene.rays.size(), 5);
  const auto tell = [](const std::vector<double>& ns) {
    return format("median %.0f, 99.9 %% %.0f, worst %.0f ns", quantile(ns, 0.5),
                  quantile(ns, 0.999), quantile(ns, 1.0));
  };
  return {name, quantile(tied, 0.5) / quantile(plain, 0.5),        Bar::kAtMost, 4.0,
          "",   "tied " + tell(tied) + "; jittered " + tell(plain)};
}

std::uint64_t closest(const Scene& scene, const Ray& ray) {
  return bitsOf(scene.cast(ray).range);
}
std::uint64_t all(const Scene& scene, const Ray& ray) {
  return scene.findAll(ray).size();
}

}  // namespace

std::vector<Bar> measureBars(const std::vector<Row>& rows, const Options& options,
                             std::uint64_t slow_pairs) {
  std::vector<Bar> bars;
  bars.push_back(
      overSlab(rows, "yes/no of a ray, over the double slab", "ray", LibraryTest::kName, 1.25));
  bars.push_back(overSlab(rows, "yes/no of a segment, over the double slab", "segment",
                          LibraryTest::kName, 1.4));
  const double find = rowOf(rows, "line", Find::kName).timing.ns.median;
  const double line = rowOf(rows, "line", LibraryTest::kName).timing.ns.median;
  bars.push_back({"yes/no of a line, over the paper's listing 8", line / find, Bar::kAtMost, 1.0,
                  "", format("%.1f against %.1f ns", line, find)});
  bars.push_back(overSlab(rows, "closest of 64 boxes with rounded range, over the uncertified scan",
                          "closest", SceneClosest::kName, 1.6));
  bars.push_back(roundingOfAHit(options));
  bars.push_back(slowPath(options, slow_pairs));
  bars.push_back(tie("closest on a rack of 64, rays in planes of faces, over jittered",
                     makeScene(Input::kShelf, 5000, options.seed), options, closest));
  const RayScene row = touchedRow(10000, 1000, options.seed);
  bars.push_back(tie("closest of 10,000 boxes all touched, over jittered", row, options, closest));
  bars.push_back(tie("all of 10,000 boxes all touched, over jittered", row, options, all));
  bars.push_back(tie("closest of 10,000 boxes all entered at one t, over jittered",
                     sharedFronts(10000, 1000, options.seed), options, closest));
  return bars;
}

}  // namespace box_query::benchmark
