// SPDX-License-Identifier: BSD-3-Clause
// Never built with ThreadSanitizer (see CMakeLists.txt), as TBB is not: what their code has in
// common is ordered where that does not see it.
#include "scene/parallel.h"

#include <algorithm>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace box_query {

void runInParallel(std::size_t count, std::size_t threads, ParallelWork& work) {
  using Range = tbb::blocked_range<std::size_t>;
  tbb::task_arena arena(static_cast<int>(threads));
  arena.execute([&] {
    tbb::parallel_for(Range(0, count),
                      [&work](const Range& range) { work.run(range.begin(), range.end()); });
  });
}

std::size_t defaultThreads() {
  const int cores = tbb::task_arena(tbb::task_arena::automatic).max_concurrency();
  return static_cast<std::size_t>(std::max(cores, 1));
}

}  // namespace box_query
