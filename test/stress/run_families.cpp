// SPDX-License-Identifier: BSD-3-Clause
#include "stress/run_families.h"

#include "exact/stage_counters.h"
#include "stress/check_pair.h"
#include "stress/check_scene.h"
#include "stress/families.h"

#include <thread>

namespace box_query::stress {
namespace {

/// The sum over all indices of check(index, tally): the same with any number of threads, but for
/// which failures are kept.
template <typename Check>
Tally onThreads(std::uint64_t count, int threads, const Check& check) {
  const auto stride = static_cast<std::uint64_t>(threads);
  std::vector<Tally> tallies(stride);
  std::vector<std::thread> workers;
  for (std::uint64_t first = 0; first < stride; ++first) {
    workers.emplace_back([&, first] {
      for (std::uint64_t index = first; index < count; index += stride) {
        check(index, tallies[first]);
      }
      const exact::StageCounters& counters = exact::stageCounters();  // a new thread's own
      tallies[first].certified_decisions = counters.certified_decisions;
      tallies[first].exact_decisions = counters.exact_decisions;
      tallies[first].exact_roundings = counters.exact_roundings;
    });
  }
  for (std::thread& worker : workers) {
    worker.join();
  }
  Tally sum;
  for (const Tally& tally : tallies) {
    sum.merge(tally);
  }
  return sum;
}

}  // namespace

Tally runIntersections(std::size_t family, std::uint64_t seed, std::uint64_t count, int threads) {
  return onThreads(count, threads, [&](std::uint64_t index, Tally& tally) {
    checkIntersections(makeSample(family, index % 2 == 0, seed, index), tally);
  });
}

Tally runDistances(std::size_t family, std::uint64_t seed, std::uint64_t count, int threads) {
  return onThreads(count, threads, [&](std::uint64_t index, Tally& tally) {
    Random radii(seed, 1000 + family, index);
    checkDistances(makeSample(family, index % 2 == 0, seed, index), radii, tally);
  });
}

Tally runScenes(std::size_t family, std::uint64_t seed, std::uint64_t count, int threads) {
  return onThreads(count, threads, [&](std::uint64_t index, Tally& tally) {
    Random choices(seed, 3000 + family, index);
    checkScene(makeScene(family, seed, index), choices, tally);
  });
}

}  // namespace box_query::stress
