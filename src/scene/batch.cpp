// SPDX-License-Identifier: BSD-3-Clause
#include <box_query/batch.h>

#include <algorithm>
#include <exception>
#include <mutex>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace box_query {
namespace {

/// Queries that are worth a thread: ten microseconds and more.
constexpr std::size_t kPart = 128;

/// The exception of the lowest part that threw.
class LowestException {
 public:
  void take(std::size_t begin) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (exception_ == nullptr || begin < begin_) {
      exception_ = std::current_exception();
      begin_ = begin;
    }
  }
  /// Whether what comes at or behind `begin` cannot be the lowest any more.
  bool isBefore(std::size_t begin) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return exception_ != nullptr && begin_ < begin;
  }
  void rethrow() {
    if (exception_ != nullptr) {
      std::rethrow_exception(exception_);
    }
  }

 private:
  std::mutex mutex_;
  std::exception_ptr exception_;
  std::size_t begin_ = 0;
};

std::size_t threadsFor(int max_threads) {
  const int cores = tbb::task_arena(tbb::task_arena::automatic).max_concurrency();
  return static_cast<std::size_t>(std::max(max_threads > 0 ? max_threads : cores, 1));
}

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
  const std::size_t parts = count / kPart + (count % kPart != 0 ? 1 : 0);
  const std::size_t threads = parts < 2 ? 1 : std::min(parts, threadsFor(max_threads));
  if (threads < 2) {
    if (count > 0) {
      work(0, count);
    }
    return;
  }
  LowestException lowest;
  tbb::task_arena arena(static_cast<int>(threads));
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, parts),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        const std::size_t begin = range.begin() * kPart;
                        if (lowest.isBefore(begin)) {
                          return;
                        }
                        try {
                          work(begin, std::min(range.end() * kPart, count));
                        } catch (...) {
                          lowest.take(begin);
                        }
                      });
  });
  lowest.rethrow();
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
  return askEach<std::uint8_t>(segments, options, [&](const Segment& segment) {
    return std::uint8_t{scene.isClear(segment, radius, options.mask)};
  });
}

std::vector<Clearance> clearanceEach(const Scene& scene, const std::vector<Segment>& segments,
                                     const BatchOptions& options) {
  return askEach<Clearance>(segments, options, [&](const Segment& segment) {
    return scene.clearance(segment, options.mask);
  });
}

std::vector<Blockage> firstBlockageEach(const Scene& scene, const std::vector<Segment>& segments,
                                        double radius, const BatchOptions& options) {
  return askEach<Blockage>(segments, options, [&](const Segment& segment) {
    return scene.firstBlockage(segment, radius, options.mask);
  });
}

}  // namespace box_query
