// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a fuzz target is: a source file that defines these two. With clang it becomes a program of
/// libFuzzer, with any other compiler one that feeds it seeds and their mutations (fuzz_main.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace box_query::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// Inputs to begin with: good ones, of every kind that the target tells apart.
std::vector<Bytes> seeds();

/// These and what libFuzzer has found since.
std::vector<Bytes> corpus();

/// Whatever the bytes are, what they may not do is found out here, by require().
void testOne(const std::uint8_t* data, std::size_t size);

/// Ends the program if a promise does not hold.
inline void require(bool holds, const char* promise) {
  if (!holds) {
    std::fprintf(stderr, "broken: %s\n", promise);
    std::abort();
  }
}
inline void require(bool holds, const std::string& promise) {
  require(holds, promise.c_str());
}

/// What a short input may make the library allocate at once: see allocation_limit.cpp.
void limitAllocations(std::size_t bytes);

/// Limits single allocations during its life: a length that the input only claims must not be
/// believed.
class AllocationLimit {
 public:
  explicit AllocationLimit(std::size_t bytes) { limitAllocations(bytes); }
  ~AllocationLimit() { limitAllocations(SIZE_MAX); }
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;
};

}  // namespace box_query::fuzz
