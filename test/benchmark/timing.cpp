// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <stdexcept>
#include <thread>

namespace box_query::benchmark {
namespace {

/// Short turns: the machine is in the same state in those that are compared.
constexpr double kTurnNs = 2e5;
/// Long ones on the wall, where threads of other programs are waited for.
constexpr double kWallTurnNs = 2e7;
/// A pass that takes so long is not made warm before it is timed, and has fewer turns.
constexpr double kLongNs = 5e7;
constexpr double kAllTurnsNs = 5e8;

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

/// One contender: how often it is passed in a turn, how many turns it has, and what they took.
class Contender {
 public:
  Contender(const Pass& pass, std::size_t queries, int rounds, Clock clock)
      : pass_(pass), queries_(static_cast<double>(queries)), clock_(clock) {
    double start = time();
    sum_ = pass_();
    double took = time() - start;
    if (took < kLongNs) {
      start = time();
      check();
      took = time() - start;
    }
    is_long_ = took >= kLongNs;
    const double turn = clock == Clock::kThread ? kTurnNs : kWallTurnNs;
    passes_ = std::max(1, static_cast<int>(turn / std::max(1.0, took)));
    rounds_ = std::max(1, std::min(rounds, static_cast<int>(kAllTurnsNs / std::max(1.0, took))));
  }

  void turn(int round) {
    if (round >= rounds_) {
      return;
    }
    if (!is_long_) {
      check();
    }
    const double start = time();
    for (int pass = 0; pass < passes_; ++pass) {
      check();
    }
    ns_.push_back((time() - start) / (passes_ * queries_));
  }

  Timing timing(const Contender& base) const {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(ns_.size(), base.ns_.size()); ++i) {
      ratios.push_back(ns_[i] / base.ns_[i]);
    }
    return {spreadOf(ns_), spreadOf(ratios), sum_};
  }

 private:
  double time() const { return clock_ == Clock::kThread ? threadTime() : now(); }
  void check() const {
    if (pass_() != sum_) {
      throw std::runtime_error("a contender's answers differ from pass to pass");
    }
  }

  const Pass& pass_;
  double queries_;
  Clock clock_;
  std::uint64_t sum_;
  bool is_long_;
  int passes_;
  int rounds_;
  std::vector<double> ns_;
};

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

Spread spreadOf(const std::vector<double>& values) {
  return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75)};
}

std::vector<Timing> timeSideBySide(const std::vector<Pass>& passes, std::size_t queries, int rounds,
                                   std::size_t base, Clock clock) {
  std::vector<Contender> contenders;
  for (const Pass& pass : passes) {
    contenders.emplace_back(pass, queries, rounds, clock);
  }
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t turn = 0; turn < contenders.size(); ++turn) {
      contenders[(turn + static_cast<std::size_t>(round)) % contenders.size()].turn(round);
    }
  }
  std::vector<Timing> timings;
  for (const Contender& contender : contenders) {
    timings.push_back(contender.timing(contenders[base]));
  }
  return timings;
}

bool haveTwoCores() {
  constexpr double kSpinNs = 3e7;
  constexpr double kEnough = 0.9;
  double worked[2] = {};
  const auto spin = [](double& ns) {
    const double end = now() + kSpinNs;
    const double start = threadTime();
    while (now() < end) {
    }
    ns = threadTime() - start;
  };
  std::thread other(spin, std::ref(worked[1]));
  spin(worked[0]);
  other.join();
  return std::min(worked[0], worked[1]) > kEnough * kSpinNs;
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
