// SPDX-License-Identifier: BSD-3-Clause
#include "ros/memory.h"

#include <cstddef>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace box_query {
namespace {

constexpr std::size_t kKilobyte = 1 << 10;

/// Pages that the calling thread got from the system.
long pagesSoFar() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt;
}

/// What a scene takes: arrays of many sizes.
long pagesForArrays(std::size_t bytes) {
  const long before = pagesSoFar();
  std::vector<std::unique_ptr<char[]>> arrays;
  for (std::size_t size = kKilobyte; size < bytes; size *= 2) {
    arrays.emplace_back(new char[size]);
    for (std::size_t i = 0; i < size; i += kKilobyte) {
      static_cast<volatile char*>(arrays.back().get())[i] = 1;
    }
  }
  return pagesSoFar() - before;
}

TEST(Memory, ThatWasMadeReadyIsNotGotPageByPage) {
#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "not glibc's malloc";
#endif
  constexpr std::size_t kSize = 2048 * kKilobyte;
  keepFreedMemory();
  long ready = 0;
  long unready = 0;
  std::thread([&] {  // with an arena of its own
    makeMemoryReady(kSize);
    ready = pagesForArrays(kSize);
    unready = pagesForArrays(8 * kSize) - ready;
  })
      .join();
  EXPECT_LT(ready, 50);
  EXPECT_GT(unready, 500);
}

TEST(Memory, OfNoBytesIsReady) {
  makeMemoryReady(0);
}

}  // namespace
}  // namespace box_query
