// SPDX-License-Identifier: BSD-3-Clause
// Never built with ThreadSanitizer (see CMakeLists.txt), as TBB is not: what their code has in
// common is ordered where that does not see it.
#include "scene/parallel.h"

#include <algorithm>
#include <map>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

namespace box_query {
namespace {

/// The arena of this thread for so many threads. It stays: until others have come to a new one, a
/// thousand rays are done. (One of its own, or else threads that call at once would wait for room.)
tbb::task_arena& arenaOf(std::size_t threads) {
  thread_local std::map<std::size_t, tbb::task_arena> arenas;
  return arenas.try_emplace(threads, static_cast<int>(threads)).first->second;
}

}  // namespace

void runInParallel(std::size_t count, std::size_t threads, ParallelWork& work) {
  using Range = tbb::blocked_range<std::size_t>;
  // Numbers are rounded as this thread does now, not as it did when its arena was made.
  tbb::task_group_context context(tbb::task_group_context::bound,
                                  tbb::task_group_context::fp_settings);
  const auto run_ranges = [&] {
    tbb::parallel_for(
        Range(0, count), [&work](const Range& range) { work.run(range.begin(), range.end()); },
        context);
  };
  // Where a part asks and waits, another part must not begin on its thread: it may hold a lock.
  arenaOf(threads).execute([&] { tbb::this_task_arena::isolate(run_ranges); });
}

std::size_t defaultThreads() {
  const int cores = tbb::task_arena(tbb::task_arena::automatic).max_concurrency();
  return static_cast<std::size_t>(std::max(cores, 1));
}

}  // namespace box_query
