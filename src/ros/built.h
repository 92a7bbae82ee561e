// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/box_tracker.h"

#include <box_query/ros/scene_monitor.h>

#include <atomic>
#include <memory>
#include <utility>

namespace box_query {

/// A snapshot, and whether somebody has got it, who may ask for it by its id.
struct Built {
  explicit Built(Snapshot&& given) : snapshot(std::move(given)) {}
  const Snapshot snapshot;
  std::atomic<bool> handed_out{false};
};
using BuiltPtr = std::shared_ptr<Built>;

/// Before anything was received.
inline BuiltPtr firstOf(BoxTracker& tracker) {
  return std::make_shared<Built>(std::move(tracker.draft().snapshot));
}

inline SnapshotPtr snapshotOf(const BuiltPtr& built) {
  return {built, &built->snapshot};
}

}  // namespace box_query
