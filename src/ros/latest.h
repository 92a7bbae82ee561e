// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A value that is read without a lock while it is replaced.
#pragma once

#include <array>
#include <atomic>
#include <thread>
#include <utility>

namespace box_query {

/// Left-Right after P. Ramalhete and A. Correia, "A Concurrency Control Technique with Wait-Free
/// Population Oblivious Reads", 2015. Readers, any number of them, take a fixed number of steps
/// whatever the writer does; the writer waits until those of the value before have left.
/// std::atomic_load of a std::shared_ptr locks a mutex in libstdc++, and so may wait for a writer
/// that is not running.
template <class T>
class Latest {
 public:
  explicit Latest(T value) : values_{value, value} {}

  /// `look` at the value, which stays as it is meanwhile. It must not wait for a writer.
  template <class Look>
  auto read(Look&& look) const {
    const Reading reading(readers_[period_]);
    return std::forward<Look>(look)(values_[side_]);
  }

  /// Replaces the value. When this returns no reader is left that looks at the one before, and
  /// nothing of that is kept. One writer at a time.
  void write(const T& value) {
    const unsigned hidden = 1 - side_;
    values_[hidden] = value;
    side_ = hidden;
    const unsigned before = period_;
    waitForReaders(1 - before);
    period_ = 1 - before;
    waitForReaders(before);
    values_[1 - hidden] = value;
  }

 private:
  using Count = std::atomic<unsigned>;
  struct Reading {
    explicit Reading(Count& given) : count(given) { ++count; }
    ~Reading() { --count; }
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;
    Count& count;
  };

  void waitForReaders(unsigned period) const {
    while (readers_[period] != 0) {
      std::this_thread::yield();
    }
  }

  std::array<T, 2> values_;
  std::atomic<unsigned> side_{0};    ///< of the value to read
  std::atomic<unsigned> period_{0};  ///< whose counter readers that come now use
  mutable std::array<Count, 2> readers_{};
};

}  // namespace box_query
