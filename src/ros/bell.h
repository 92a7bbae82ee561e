// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace box_query {

/// Wakes threads that wait for something to have happened, by wall time: a ROS clock may stand
/// still.
class Bell {
 public:
  using Clock = std::chrono::steady_clock;

  void ring() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++rings_;
    }
    rung_.notify_all();
  }

  std::uint64_t rings() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return rings_;
  }

  /// Returns once there have been more than `rings` of them, or at the deadline.
  void waitPast(std::uint64_t rings, Clock::time_point deadline) {
    std::unique_lock<std::mutex> lock(mutex_);
    rung_.wait_until(lock, deadline, [&] { return rings_ > rings; });
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable rung_;
  std::uint64_t rings_ = 0;
};

}  // namespace box_query
