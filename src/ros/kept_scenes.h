// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/history.h"

#include <box_query/ros/scene_monitor.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>

namespace box_query {

/// The snapshots before the latest that somebody has got, and may ask for by their ids. All
/// functions may be called from any thread.
class KeptScenes {
 public:
  /// At most Parameters::kept_scenes and max_kept_boxes, with the latest one.
  explicit KeptScenes(const Parameters& parameters);

  /// `replaced` is the latest no more; the one that is has `boxes_now`. Each id is kept once.
  void add(SnapshotPtr replaced, std::size_t boxes_now);
  /// The one with the id of `past`: restored, and added, if it is not here.
  SnapshotPtr restore(const PastScene& past, std::size_t boxes_now);
  /// The one with this id, or null.
  SnapshotPtr find(std::uint64_t id) const;

 private:
  SnapshotPtr findLocked(std::uint64_t id) const;

  const std::size_t max_scenes_;
  const std::size_t max_boxes_;
  std::mutex restore_mutex_;  ///< so that each is restored once; locked before mutex_
  mutable std::mutex mutex_;
  std::deque<SnapshotPtr> kept_;
  std::size_t boxes_ = 0;  ///< in all of them
};

}  // namespace box_query
