// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Threads of TBB, behind an interface that does not show it.
#pragma once

#include <cstddef>

namespace box_query {

/// What several threads do at once, each with an index range of its own.
class ParallelWork {
 public:
  virtual ~ParallelWork() = default;
  virtual void run(std::size_t begin, std::size_t end) noexcept = 0;
};

/// Calls run() for ranges that make up [0, count), on up to `threads` threads at once, and returns
/// when all are done.
void runInParallel(std::size_t count, std::size_t threads, ParallelWork& work);

/// Threads that TBB uses unless told otherwise.
std::size_t defaultThreads();

}  // namespace box_query
