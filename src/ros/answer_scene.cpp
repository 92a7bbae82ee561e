// SPDX-License-Identifier: BSD-3-Clause
#include "ros/answers.h"
#include "ros/box_filter.h"
#include "ros/named_boxes.h"
#include "ros/request_checks.h"

namespace box_query {
namespace {

OrientedBox oriented(const OrientedBox& box) {
  return box;
}

OrientedBox oriented(const AlignedBox& box) {
  return {0.5 * box.min + 0.5 * box.max, Quaternion::Identity(), 0.5 * box.max - 0.5 * box.min};
}

}  // namespace

void check(const GetSceneRequest& request, const Limits& limits) {
  check(BoxFilter(request), limits);
  checkTime({"scene_time"}, request.scene_time);
  if (request.scene_id != 0 && !request.scene_time.isZero()) {
    throw std::invalid_argument("scene_id and scene_time are both given: give one of them");
  }
}

void answer(const GetSceneRequest& request, const Snapshot& snapshot, const ros::Time& now,
            GetSceneResponse& response) {
  describeScene(request, snapshot, now, response);
  const auto mask = maskOf(BoxFilter(request), snapshot);
  for (std::size_t i = 0; i < snapshot.names.size(); ++i) {
    if (mask && !(*mask)[i]) {
      continue;
    }
    const OrientedBox box =
        std::visit([](const auto& solid) { return oriented(solid); }, snapshot.scene.boxes()[i]);
    response.poses.push_back(toPose(box.center, box.orientation));
    response.sizes.push_back(toVector3(2 * box.half_extents));
    response.stamps.push_back(snapshot.stamps[i]);
    appendName(snapshot.names[i], response);
  }
}

}  // namespace box_query
