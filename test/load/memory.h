// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Resident memory of another process.
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace box_query::load {

/// Process id of a node, as it says itself.
/// @throws std::runtime_error where no such node can be asked
int processOf(const std::string& node);

/// Looks at the memory of a process twice a second until it is stopped.
class MemoryWatch {
 public:
  explicit MemoryWatch(int pid);
  ~MemoryWatch();
  MemoryWatch(const MemoryWatch&) = delete;
  MemoryWatch& operator=(const MemoryWatch&) = delete;

  void stop();
  /// Once stopped: [MB] at the last look up to that many seconds after the first.
  double at(double seconds) const;

 private:
  std::atomic<bool> stopping_{false};
  std::vector<std::pair<double, double>> looks_;  ///< [s] since the first, [MB]
  std::thread thread_;
};

}  // namespace box_query::load
