// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/bell.h"

#include <atomic>
#include <functional>
#include <thread>
#include <utility>

namespace box_query {

/// Does something again and again, from a thread of its own, until it is stopped. By wall time.
class Periodic {
 public:
  Periodic(Bell::Clock::duration pause, std::function<void()> task)
      : pause_(pause), task_(std::move(task)), thread_([this] { run(); }) {}
  ~Periodic() { stop(); }
  Periodic(const Periodic&) = delete;
  Periodic& operator=(const Periodic&) = delete;

  /// Returns when it is not done any more.
  void stop() {
    stopping_ = true;
    bell_.ring();
    if (thread_.joinable()) {
      thread_.join();
    }
  }

 private:
  void run() {
    while (!stopping_) {
      task_();
      bell_.waitPast(0, Bell::Clock::now() + pause_);
    }
  }

  const Bell::Clock::duration pause_;
  const std::function<void()> task_;
  std::atomic<bool> stopping_{false};
  Bell bell_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace box_query
