// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the queries of all requests had to do, on whatever threads.
#pragma once

#include <box_query/batch.h>
#include <box_query/counters.h>

#include <cstddef>
#include <mutex>
#include <thread>

namespace box_query {

/// A sum since start. All functions may be called from any thread.
class QueryTotals {
 public:
  void add(const QueryCounters& counters) {
    const std::lock_guard<std::mutex> lock(mutex_);
    sum_ += counters;
  }
  QueryCounters get() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return sum_;
  }

 private:
  mutable std::mutex mutex_;
  QueryCounters sum_;
};

/// Adds what its thread does during its life; to nothing if `totals` is null.
class CountedQueries {
 public:
  explicit CountedQueries(QueryTotals* totals) : totals_(totals), before_(queryCounters()) {}
  ~CountedQueries() {
    if (totals_ != nullptr) {
      totals_->add(queryCounters() - before_);
    }
  }
  CountedQueries(const CountedQueries&) = delete;
  CountedQueries& operator=(const CountedQueries&) = delete;

 private:
  QueryTotals* totals_;
  QueryCounters before_;
};

/// forEachPart() for a caller that counts its own thread: adds what the others do.
template <typename Work>
void forEachCountedPart(std::size_t count, int max_threads, QueryTotals* totals, Work&& work) {
  const std::thread::id caller = std::this_thread::get_id();
  forEachPart(count, max_threads, [&](std::size_t begin, std::size_t end) {
    const CountedQueries counted(std::this_thread::get_id() == caller ? nullptr : totals);
    work(begin, end);
  });
}

}  // namespace box_query
