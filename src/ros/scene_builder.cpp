// SPDX-License-Identifier: BSD-3-Clause
#include "ros/scene_builder.h"

#include "ros/memory.h"
#include "ros/name_order.h"

#include <chrono>
#include <utility>

namespace box_query {
namespace {

using Clock = SceneBuilder::Clock;

constexpr std::chrono::milliseconds kGrace(10);
/// [bytes] that a box takes in a snapshot, its scene and its draft, about.
constexpr std::size_t kBoxMemory = 512;
constexpr Clock::time_point kNever = Clock::time_point::max();

}  // namespace

SceneBuilder::SceneBuilder(const Parameters& parameters, BoxTracker& tracker,
                           std::timed_mutex& mutex)
    : parameters_(parameters),
      tracker_(tracker),
      mutex_(mutex),
      latest_(firstOf(tracker)),
      shown_changes_(0),
      behind_since_(kNever),
      kept_(parameters) {}

bool SceneBuilder::build() {
  const std::lock_guard<std::mutex> building(build_mutex_);
  std::unique_lock<std::timed_mutex> lock(mutex_);
  const std::uint64_t changes = tracker_.changes();
  const std::uint64_t boxes = tracker_.boxesVersion();
  if (changes == shown_changes_) {
    return false;  // somebody else was faster
  }
  const Clock::time_point drafted = Clock::now();
  Draft draft = tracker_.draft();
  unbuilt_changes_ += changes - shown_changes_;
  lock.unlock();

  const BuiltPtr before = latest_.read([](const BuiltPtr& built) { return built; });
  const bool same = boxes == shown_boxes_;
  const Snapshot& old = before->snapshot;
  draft.snapshot.scene =
      same ? old.scene
           : old.scene.updated(std::move(draft.boxes), placesOf(draft.snapshot.names, old.names));
  const auto after = std::make_shared<Built>(std::move(draft.snapshot));
  latest_.write(after);
  if (before->handed_out) {  // nobody can get it any more
    kept_.add(snapshotOf(before), after->snapshot.names.size());
  }

  lock.lock();
  if (!same) {
    ++builds_;
    refits_ += after->snapshot.scene.update().rebuilt ? 0 : 1;
    --unbuilt_changes_;
  }
  shown_changes_ = changes;
  shown_boxes_ = boxes;
  behind_since_ = tracker_.changes() == changes ? kNever : drafted;
  lock.unlock();
  built_.ring();
  return !same;
}

void SceneBuilder::buildAhead() {
  if (askedLately()) {
    if (build()) {
      makeMemoryReady(kBoxMemory * latest()->names.size());
    }
    ahead_ = true;
  } else {
    ahead_ = false;
  }
}

bool SceneBuilder::askedLately() {
  if (asked_.exchange(false)) {
    last_asked_ = Clock::now();
  }
  return last_asked_ != Clock::time_point() &&
         std::chrono::duration<double>(Clock::now() - last_asked_).count() <
             parameters_.build_ahead;
}

void SceneBuilder::noteChange() {
  Clock::time_point never = kNever;
  behind_since_.compare_exchange_strong(never, Clock::now());
}

Clock::time_point SceneBuilder::graceEnd() const {
  const Clock::time_point since = behind_since_;
  return (since == kNever ? Clock::now() : since) + kGrace;
}

void SceneBuilder::await(std::uint64_t changes) {
  const Clock::time_point deadline = graceEnd();
  for (std::uint64_t rings = built_.rings(); shown_changes_ < changes && Clock::now() < deadline;
       rings = built_.rings()) {
    built_.waitPast(rings, deadline);
  }
}

SnapshotPtr SceneBuilder::handOut() const {
  if (!asked_.load(std::memory_order_relaxed)) {
    asked_ = true;
  }
  return latest_.read([](const BuiltPtr& built) {
    if (!built->handed_out.load(std::memory_order_relaxed)) {
      built->handed_out = true;
    }
    return snapshotOf(built);
  });
}

SnapshotPtr SceneBuilder::find(std::uint64_t id) const {
  const SnapshotPtr scene = latest();
  return scene->id == id ? scene : kept_.find(id);
}

SnapshotPtr SceneBuilder::restore(const PastScene& past) {
  const SnapshotPtr scene = latest_.read([&past](const BuiltPtr& built) {
    if (built->snapshot.id == past.id()) {
      built->handed_out = true;
    }
    return snapshotOf(built);
  });
  return scene->id == past.id() ? scene : kept_.restore(past, scene->names.size());
}

void SceneBuilder::addCounts(MonitorStatistics& counts) const {
  counts.builds = builds_;
  counts.refits = refits_;
  counts.avoided_builds = unbuilt_changes_;
}

}  // namespace box_query
