// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which messages the scenes that answers name are made of, as ~get_scene says while it keeps them.
#pragma once

#include "load/caller.h"
#include "load/world.h"

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>

namespace box_query::load {

struct SceneFacts {
  std::array<Tick, kTopics> ticks{};  ///< of the message that each topic's boxes came with
  ros::Time stamp;
  bool complete = false;
  std::string reason;
};

/// What the clients have learnt of scenes. All functions may be called from any thread.
class SceneLog {
 public:
  /// Asks the node about the scene at once, since it may soon be forgotten, unless somebody has.
  void learn(std::uint64_t scene_id, Caller& caller);

  /// Of the scenes that the node still knew.
  std::map<std::uint64_t, SceneFacts> facts() const;

 private:
  mutable std::mutex mutex_;
  std::set<std::uint64_t> asked_;
  std::map<std::uint64_t, SceneFacts> facts_;
};

}  // namespace box_query::load
