// SPDX-License-Identifier: BSD-3-Clause
// operator new with a limit on single blocks.
#include "fuzz/fuzz.h"

#include <atomic>
#include <new>

namespace box_query::fuzz {
namespace {

std::atomic<std::size_t> largest_block{SIZE_MAX};

}  // namespace

void limitAllocations(std::size_t bytes) {
  largest_block = bytes;
}

}  // namespace box_query::fuzz

// Not inlined: g++ 12 would take the pair for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  box_query::fuzz::require(size <= box_query::fuzz::largest_block,
                           "blocks are as large as the input may make them");
  void* const block = std::malloc(size > 0 ? size : 1);
  if (block == nullptr) {
    throw std::bad_alloc();
  }
  return block;
}
[[gnu::noinline]] void operator delete(void* block) noexcept {
  std::free(block);
}
[[gnu::noinline]] void operator delete(void* block, std::size_t /*size*/) noexcept {
  std::free(block);
}
