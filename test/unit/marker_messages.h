// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Markers with a value in every field that matters, decoded as what roscpp sends of them.
#pragma once

#include "unit/source_fixture.h"

#include <string>
#include <vector>

#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

namespace box_query::test {

/// By the checksum that roscpp has of the type.
template <typename Message>
DecodedMessage decode(const Message& message, std::size_t max_boxes = kPlenty) {
  std::string problem;
  const BoxSource* source = findSource(ros::message_traits::datatype<Message>(),
                                       ros::message_traits::md5sum<Message>(), problem);
  if (source == nullptr) {
    throw std::invalid_argument(problem);
  }
  const Bytes bytes = wire(message);
  Limits limits;
  limits.boxes = max_boxes;
  return decodeMessage(*source, bytes.data(), bytes.size(), limits);
}

inline visualization_msgs::Marker cube() {
  visualization_msgs::Marker marker;
  marker.header.frame_id = "odom";
  marker.header.stamp = ros::Time(1234, 5678);
  marker.ns = "crates";
  marker.id = -3;
  marker.type = visualization_msgs::Marker::CUBE;
  marker.pose.position.x = 0.1;
  marker.pose.position.y = -0.2;
  marker.pose.position.z = 0.3;
  marker.pose.orientation.z = 0.6;
  marker.pose.orientation.w = 0.8;
  marker.scale.x = 1.0;
  marker.scale.y = 0.0;
  marker.scale.z = 3.0;
  marker.lifetime = ros::Duration(2, 500);
  marker.frame_locked = true;
  marker.text = "fragile";
  marker.colors.resize(2);
  marker.mesh_resource = "package://none";
  return marker;
}

inline visualization_msgs::Marker cubeList() {
  visualization_msgs::Marker marker = cube();
  marker.type = visualization_msgs::Marker::CUBE_LIST;
  marker.points.resize(3);
  marker.points[1].x = 1.0;
  marker.points[2].y = 2.0;
  return marker;
}

}  // namespace box_query::test
