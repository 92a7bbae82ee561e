// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The snapshot that an answer names, made anew from what was published.
#pragma once

#include "load/scene_log.h"

#include <box_query/ros/scene_monitor.h>

#include <array>
#include <cstdint>
#include <vector>

namespace box_query::load {

/// Snapshots one after the other, of which neighbours share most messages. For one thread.
class SceneRebuilder {
 public:
  SceneRebuilder();

  /// Valid until the next call.
  const Snapshot& rebuild(std::uint64_t id, const SceneFacts& facts);

 private:
  struct Topic {
    std::vector<std::size_t> order;  ///< places in the message, in the order of the snapshot
    Tick tick = -1;
    std::vector<OrientedBox> boxes;  ///< at that tick, in the fixed frame
  };

  std::array<Topic, kTopics> topics_;
  Snapshot snapshot_;
};

}  // namespace box_query::load
