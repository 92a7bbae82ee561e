// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A batch of minutes: its rays pass through the corner of every box's bounds and miss the box, so
/// that each is looked at.
#pragma once

#include <box_query/CastRays.h>

#include <cmath>
#include <cstddef>

#include <visualization_msgs/Marker.h>

namespace box_query::test {

inline visualization_msgs::Marker boxesOfLongBatch() {
  visualization_msgs::Marker boxes;
  boxes.header.frame_id = "map";
  boxes.type = visualization_msgs::Marker::CUBE_LIST;
  boxes.pose.orientation.x = std::sqrt(0.5 - std::sqrt(0.125));
  boxes.pose.orientation.w = std::sqrt(0.5 + std::sqrt(0.125));
  boxes.scale.x = boxes.scale.y = boxes.scale.z = 0.5;
  boxes.points.resize(20000);
  for (std::size_t i = 0; i < boxes.points.size(); ++i) {
    boxes.points[i].x = static_cast<double>(i);
  }
  return boxes;
}

inline CastRays longBatch() {
  CastRays batch;
  batch.request.header.frame_id = "map";
  batch.request.origins.resize(1);
  batch.request.origins[0].y = batch.request.origins[0].z = 0.3;
  geometry_msgs::Vector3 along;
  along.x = 1;
  batch.request.directions.assign(1000000, along);
  return batch;
}

}  // namespace box_query::test
