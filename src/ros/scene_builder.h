// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// From what a tracker knows to snapshots.
#pragma once

#include "ros/bell.h"
#include "ros/box_tracker.h"
#include "ros/built.h"
#include "ros/history.h"
#include "ros/kept_scenes.h"
#include "ros/latest.h"

#include <box_query/ros/scene_monitor.h>

#include <atomic>
#include <cstdint>
#include <mutex>

namespace box_query {

/// Makes the latest snapshot, and keeps those before it that may be asked for by their ids.
///
/// Whoever asks builds what is not built yet. While somebody does, a worker builds ahead as boxes
/// come: then who asks need not wait for boxes, be they ever so many. All functions may be called
/// from any thread; the tracker's mutex, its owner's, is locked while a draft is made, but not
/// while a scene is built.
class SceneBuilder {
 public:
  using Clock = Bell::Clock;

  SceneBuilder(const Parameters& parameters, BoxTracker& tracker, std::timed_mutex& mutex);

  /// Makes the latest snapshot one of all that the tracker knows, unless it is, or somebody else
  /// does. @return whether a scene was built
  bool build();
  /// The same if somebody has got a snapshot within Parameters::build_ahead seconds. For the worker
  /// alone, whenever something may have come.
  void buildAhead();
  /// Whether the worker does that, so that the latest snapshot lags behind by what is being taken
  /// in or built just now.
  bool isAhead() const { return ahead_; }

  /// Whether the tracker knows what the latest snapshot does not show. With its mutex locked, as
  /// the next one.
  bool isBehind() const { return tracker_.changes() != shown_changes_; }
  /// Something is being taken in, or was.
  void noteChange();

  /// Until when somebody waits for what has come: no longer than for a scene of some ten thousand
  /// boxes.
  Clock::time_point graceEnd() const;
  /// Returns when the latest snapshot shows so many changes of the tracker, or the grace is over.
  void await(std::uint64_t changes);

  /// The latest snapshot, never null, to somebody who may ask for it by its id. Takes no lock.
  SnapshotPtr handOut() const;
  /// The same to who only watches.
  SnapshotPtr latest() const { return latest_.read(snapshotOf); }
  /// One that was handed out, or null.
  SnapshotPtr find(std::uint64_t id) const;
  /// One of the past, handed out.
  SnapshotPtr restore(const PastScene& past);

  /// Fills in what it counts, with the tracker's mutex locked.
  void addCounts(MonitorStatistics& counts) const;

 private:
  bool askedLately();

  const Parameters& parameters_;
  BoxTracker& tracker_;
  std::timed_mutex& mutex_;  ///< of the tracker

  std::mutex build_mutex_;                       ///< one at a time; locked before mutex_
  Latest<BuiltPtr> latest_;                      ///< never null; written with build_mutex_ locked
  std::atomic<std::uint64_t> shown_changes_;     ///< of the tracker, that the snapshot shows
  std::uint64_t shown_boxes_ = 0;                ///< with both locked
  std::atomic<Clock::time_point> behind_since_;  ///< when what it does not show came; or never
  Bell built_;

  mutable std::atomic<bool> asked_{false};  ///< since the worker looked
  Clock::time_point last_asked_;            ///< as the worker saw it; its epoch: never yet
  std::atomic<bool> ahead_{false};
  KeptScenes kept_;

  // With the tracker's mutex locked:
  std::uint64_t builds_ = 0;
  std::uint64_t refits_ = 0;
  std::uint64_t unbuilt_changes_ = 0;
};

}  // namespace box_query
