// SPDX-License-Identifier: BSD-3-Clause
#include "scene/parallel.h"
#include "scene/thread_sanitizer.h"

#include <box_query/batch.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <mutex>

namespace box_query {
namespace {

/// Queries that are worth a thread: ten microseconds and more.
constexpr std::size_t kPart = 128;

/// The exception of the lowest part that threw.
class LowestException {
 public:
  void take(std::size_t begin) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (begin < begin_) {
      exception_ = std::current_exception();
      begin_ = begin;
    }
  }
  /// Whether what comes at or behind `begin` cannot be the lowest any more.
  bool isBefore(std::size_t begin) const { return begin_.load(std::memory_order_relaxed) < begin; }
  void rethrow() const {
    if (exception_ != nullptr) {
      std::rethrow_exception(exception_);
    }
  }

 private:
  std::mutex mutex_;
  std::exception_ptr exception_;
  std::atomic<std::size_t> begin_{std::numeric_limits<std::size_t>::max()};
};

/// Work on `count` queries, by parts of kPart.
class PartsOfWork final : public ParallelWork {
 public:
  using Work = std::function<void(std::size_t begin, std::size_t end)>;
  PartsOfWork(std::size_t count, const Work& work) : count_(count), work_(work) {}

  void runOn(std::size_t threads) {
    begun_.release();
    runInParallel((count_ - 1) / kPart + 1, threads, *this);
    ended_.acquire();
    lowest_.rethrow();
  }

  void run(std::size_t first_part, std::size_t end_part) noexcept override {
    begun_.acquire();
    const std::size_t begin = first_part * kPart;
    if (!lowest_.isBefore(begin)) {
      try {
        work_(begin, std::min(end_part * kPart, count_));
      } catch (...) {
        lowest_.take(begin);
      }
    }
    ended_.release();
  }

 private:
  const std::size_t count_;
  const Work& work_;
  LowestException lowest_;
  UnseenOrder begun_;
  UnseenOrder ended_;
};

/// forEachPart() with the counters that the options ask for.
template <typename Work>
void forEachCountedPart(std::size_t count, const BatchOptions& options, Work&& work) {
  std::mutex mutex;
  forEachPart(count, options.max_threads, [&](std::size_t begin, std::size_t end) {
    const QueryCounters before = queryCounters();
    work(begin, end);
    if (options.counters != nullptr) {
      const std::lock_guard<std::mutex> lock(mutex);
      *options.counters += queryCounters() - before;
    }
  });
}

template <typename Answer, typename Query, typename Ask>
std::vector<Answer> askEach(const std::vector<Query>& queries, const BatchOptions& options,
                            Ask&& ask) {
  std::vector<Answer> answers(queries.size());
  forEachCountedPart(queries.size(), options, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      answers[i] = ask(queries[i]);
    }
  });
  return answers;
}

}  // namespace

void forEachPart(std::size_t count, int max_threads,
                 const std::function<void(std::size_t begin, std::size_t end)>& work) {
  const std::size_t wanted = max_threads > 0 ? static_cast<std::size_t>(max_threads) : 0;
  const std::size_t parts = count / kPart + (count % kPart != 0 ? 1 : 0);
  const std::size_t threads =
      parts < 2 ? 1 : std::min(parts, wanted != 0 ? wanted : defaultThreads());
  if (threads > 1) {
    PartsOfWork(count, work).runOn(threads);
  } else if (count > 0) {
    work(0, count);
  }
}

std::vector<Hit> castEach(const Scene& scene, const std::vector<Ray>& rays,
                          const BatchOptions& options) {
  std::vector<Hit> hits(rays.size());
  forEachCountedPart(rays.size(), options, [&](std::size_t begin, std::size_t end) {
    scene.cast(&rays[begin], end - begin, &hits[begin], options.max_range, options.mask);
  });
  return hits;
}

std::vector<ClosestBox> castClosestEach(const Scene& scene, const std::vector<Ray>& rays,
                                        const BatchOptions& options) {
  std::vector<ClosestBox> closest(rays.size());
  forEachCountedPart(rays.size(), options, [&](std::size_t begin, std::size_t end) {
    scene.castClosest(&rays[begin], end - begin, &closest[begin], options.max_range, options.mask);
  });
  return closest;
}

std::vector<std::uint8_t> castAnyEach(const Scene& scene, const std::vector<Ray>& rays,
                                      const BatchOptions& options) {
  std::vector<std::uint8_t> any(rays.size());
  forEachCountedPart(rays.size(), options, [&](std::size_t begin, std::size_t end) {
    scene.castAny(&rays[begin], end - begin, &any[begin], options.max_range, options.mask);
  });
  return any;
}

std::vector<std::uint8_t> isClearEach(const Scene& scene, const std::vector<Segment>& segments,
                                      double radius, const BatchOptions& options) {
  std::vector<std::uint8_t> clear(segments.size());
  forEachCountedPart(segments.size(), options, [&](std::size_t begin, std::size_t end) {
    scene.isClear(&segments[begin], end - begin, &clear[begin], radius, options.mask);
  });
  return clear;
}

std::vector<Clearance> clearanceEach(const Scene& scene, const std::vector<Segment>& segments,
                                     const BatchOptions& options) {
  std::vector<Clearance> clearances(segments.size());
  forEachCountedPart(segments.size(), options, [&](std::size_t begin, std::size_t end) {
    scene.clearance(&segments[begin], end - begin, &clearances[begin], options.mask);
  });
  return clearances;
}

std::vector<Blockage> firstBlockageEach(const Scene& scene, const std::vector<Segment>& segments,
                                        double radius, const BatchOptions& options) {
  return askEach<Blockage>(segments, options, [&](const Segment& segment) {
    return scene.firstBlockage(segment, radius, options.mask);
  });
}

}  // namespace box_query
