// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which messages the scenes that answers name are made of, as ~get_scene says while it keeps them.
#pragma once

#include "load/world.h"

#include <array>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace box_query::load {

struct SceneFacts {
  std::array<Tick, kTopics> ticks{};  ///< of the message that each topic's boxes came with
  ros::Time stamp;
  bool complete = false;
  std::string reason;
};

/// Asks, from a thread of its own, about every scene that somebody has noticed.
class SceneLog {
 public:
  SceneLog();
  ~SceneLog();
  SceneLog(const SceneLog&) = delete;
  SceneLog& operator=(const SceneLog&) = delete;

  void notice(std::uint64_t scene_id);

  /// What was learnt of the scenes, once all that were noticed were asked for.
  std::map<std::uint64_t, SceneFacts> facts();
  /// Why others could not be learnt.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<std::uint64_t> noticed_;
  std::vector<std::uint64_t> to_ask_;
  bool busy_ = false;
  bool stopping_ = false;
  std::map<std::uint64_t, SceneFacts> facts_;
  std::vector<std::string> problems_;
  std::thread thread_;
};

}  // namespace box_query::load
