// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Times of several contenders, side by side in one run: in every round each has its turn, and
/// every round begins with another one.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace box_query::benchmark {

struct Spread {
  double median = 0.0;
  double low = 0.0;   ///< Lower quartile.
  double high = 0.0;  ///< Upper quartile.
};

/// Takes the values out of order.
Spread spreadOf(const std::vector<double>& values);
/// The smallest value that is not below `share` of all; NaN if there are none.
double quantile(std::vector<double> values, double share);

struct Timing {
  Spread ns;              ///< A query.
  Spread ratio;           ///< To the contender `base`, round by round.
  std::uint64_t sum = 0;  ///< Of all answers of one pass.
};

/// One pass over all queries, returning a sum of the answers.
using Pass = std::function<std::uint64_t()>;

/// Query number i on its own.
using Query = std::function<std::uint64_t(std::size_t i)>;

/// kThread: what other programs take of the machine does not count. kWall: for what has threads;
/// turns of 20 ms.
enum class Clock { kThread, kWall };

/// @param queries in one pass; each turn runs passes for about 0.2 ms, after one that is not timed.
///   A contender whose passes take long has fewer turns, for about half a second in all.
/// @throws std::runtime_error if a contender's sum changes from pass to pass.
std::vector<Timing> timeSideBySide(const std::vector<Pass>& passes, std::size_t queries, int rounds,
                                   std::size_t base, Clock clock = Clock::kThread);

/// Whether two threads have a core each just now: else nothing can be said of what they gain.
bool haveTwoCores();

/// Nanoseconds of every query on its own, of two contenders in turns: each the smallest of
/// `repeats`, with the clock's own time in it.
std::pair<std::vector<double>, std::vector<double>> timeEachOfTwo(const Query& one,
                                                                  const Query& other,
                                                                  std::size_t queries, int repeats);

}  // namespace box_query::benchmark
