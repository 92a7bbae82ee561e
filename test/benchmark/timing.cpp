// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <time.h>

namespace box_query::benchmark {
namespace {

constexpr double kTurnNs = 2e5;

/// Of the wall: cheap enough for a single query.
double now() {
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return static_cast<double>(std::chrono::duration_cast<std::chrono::nanoseconds>(since).count());
}

/// Of this thread: what other programs take of the machine does not count.
double threadTime() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

/// Keeps a result, and all that it depends on.
void keep(std::uint64_t value) {
  asm volatile("" : : "r"(value) : "memory");
}

}  // namespace

double quantile(std::vector<double> values, double share) {
  if (values.empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const auto last = static_cast<double>(values.size() - 1);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::ceil(share * last));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

Spread spreadOf(std::vector<double> values) {
  return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75)};
}

std::vector<Timing> timeSideBySide(const std::vector<Pass>& contenders, std::size_t queries,
                                   int rounds, std::size_t base) {
  const std::size_t count = contenders.size();
  std::vector<Timing> timings(count);
  std::vector<int> passes(count);
  for (std::size_t c = 0; c < count; ++c) {
    timings[c].sum = contenders[c]();
    const double start = threadTime();
    keep(contenders[c]());
    passes[c] = std::max(1, static_cast<int>(kTurnNs / std::max(1.0, threadTime() - start)));
  }
  std::vector<std::vector<double>> ns(count);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t turn = 0; turn < count; ++turn) {
      const std::size_t c = (turn + static_cast<std::size_t>(round)) % count;
      if (contenders[c]() != timings[c].sum) {
        throw std::runtime_error("a contender's answers differ from pass to pass");
      }
      const double start = threadTime();
      for (int pass = 0; pass < passes[c]; ++pass) {
        keep(contenders[c]());
      }
      ns[c].push_back((threadTime() - start) / (passes[c] * static_cast<double>(queries)));
    }
  }
  for (std::size_t c = 0; c < count; ++c) {
    std::vector<double> ratios;
    for (std::size_t round = 0; round < ns[c].size(); ++round) {
      ratios.push_back(ns[c][round] / ns[base][round]);
    }
    timings[c].ns = spreadOf(ns[c]);
    timings[c].ratio = spreadOf(ratios);
  }
  return timings;
}

std::pair<std::vector<double>, std::vector<double>> timeEachOfTwo(const Query& one,
                                                                  const Query& other,
                                                                  std::size_t queries,
                                                                  int repeats) {
  const std::vector<double> never(queries, std::numeric_limits<double>::infinity());
  auto best = std::make_pair(never, never);
  const auto time = [queries](const Query& query, std::vector<double>& ns) {
    for (std::size_t i = 0; i < queries; ++i) {
      const double start = now();
      keep(query(i));
      ns[i] = std::min(ns[i], now() - start);
    }
  };
  for (int repeat = 0; repeat < repeats; ++repeat) {
    time(one, best.first);
    time(other, best.second);
  }
  return best;
}

}  // namespace box_query::benchmark
