// SPDX-License-Identifier: BSD-3-Clause
#include "ros/kept_scenes.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace box_query {

KeptScenes::KeptScenes(const Parameters& parameters)
    : max_scenes_(static_cast<std::size_t>(parameters.kept_scenes)),
      max_boxes_(static_cast<std::size_t>(parameters.max_kept_boxes)) {}

void KeptScenes::add(SnapshotPtr replaced, std::size_t boxes_now) {
  std::vector<SnapshotPtr> forgotten;  // freed without the lock
  const std::lock_guard<std::mutex> lock(mutex_);
  if (findLocked(replaced->id)) {
    return;  // it was restored while it was still to be built
  }
  boxes_ += replaced->names.size();
  kept_.push_back(std::move(replaced));
  while (!kept_.empty() && (kept_.size() + 1 > max_scenes_ || boxes_ + boxes_now > max_boxes_)) {
    boxes_ -= kept_.front()->names.size();
    forgotten.push_back(std::move(kept_.front()));
    kept_.pop_front();
  }
}

SnapshotPtr KeptScenes::restore(const PastScene& past, std::size_t boxes_now) {
  const std::lock_guard<std::mutex> lock(restore_mutex_);
  SnapshotPtr scene = find(past.id());
  if (!scene) {
    scene = past.restored();
    add(scene, boxes_now);
  }
  return scene;
}

SnapshotPtr KeptScenes::find(std::uint64_t id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return findLocked(id);
}

SnapshotPtr KeptScenes::findLocked(std::uint64_t id) const {
  const auto found = std::find_if(kept_.begin(), kept_.end(),
                                  [id](const SnapshotPtr& snapshot) { return snapshot->id == id; });
  return found == kept_.end() ? nullptr : *found;
}

}  // namespace box_query
