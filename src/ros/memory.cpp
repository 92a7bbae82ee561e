// SPDX-License-Identifier: BSD-3-Clause
#include "ros/memory.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace box_query {
namespace {

constexpr std::size_t kMegabyte = 1 << 20;

std::atomic<bool> is_kept{false};

}  // namespace

void keepFreedMemory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 4 * kMegabyte);
  mallopt(M_TRIM_THRESHOLD, 16 * kMegabyte);
  is_kept = true;
#endif
}

void makeMemoryReady(std::size_t bytes) {
  constexpr std::size_t kPage = 4096;
  constexpr std::size_t kMost = 8 * kMegabyte;
  if (!is_kept) {
    return;
  }
  std::vector<std::unique_ptr<char[]>> blocks;  // all at once: they are different ones
  for (std::size_t left = std::min(bytes, kMost); left > 0;) {
    const std::size_t size = std::min(left, kMegabyte);
    blocks.emplace_back(new char[size]);
    for (std::size_t i = 0; i < size; i += kPage) {
      static_cast<volatile char*>(blocks.back().get())[i] = 0;
    }
    left -= size;
  }
}

}  // namespace box_query
