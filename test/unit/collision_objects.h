// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Objects of MoveIt, and what a topic has after messages of them.
#pragma once

#include "ros/box_tracker.h"
#include "unit/foreign_messages.h"
#include "unit/source_fixture.h"

#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <tf2/buffer_core.h>

namespace box_query::test {

enum Operation : std::int8_t { kAdd, kRemove, kAppend, kMove };

inline SolidPrimitive solid(std::uint8_t type, const std::vector<double>& dimensions) {
  SolidPrimitive primitive;
  primitive.type = type;
  primitive.dimensions = dimensions;
  return primitive;
}

inline geometry_msgs::Pose poseAt(double x, double yaw = 0.0) {
  geometry_msgs::Pose pose;
  pose.position.x = x;
  pose.orientation.z = std::sin(yaw / 2);
  pose.orientation.w = std::cos(yaw / 2);
  return pose;
}

/// Boxes at the places given, in the frame of the object.
inline CollisionObject object(const std::string& id, const std::vector<double>& places,
                              Operation operation = kAdd) {
  CollisionObject message;
  message.header.frame_id = "/map";
  message.header.stamp = ros::Time(1234, 5678);
  message.id = id;
  message.type_key = "furniture";
  message.type_db = "shop";
  message.pose = poseAt(0.0);
  for (const double x : places) {
    message.primitives.push_back(solid(1, {1.0, 0.0, 3.0}));
    message.primitive_poses.push_back(poseAt(x));
  }
  message.operation = operation;
  return message;
}

/// "ns/id:x" of every box that a tracker has after these messages, in the order of snapshots.
inline std::string contentsAfter(const char* type, std::vector<DecodedMessage> messages) {
  Parameters parameters;
  parameters.box_topics = {TopicParameters()};
  const tf2::BufferCore tf;
  BoxTracker tracker(parameters, tf);
  for (DecodedMessage& message : messages) {
    tracker.receive(0, &sourceNamed(type), std::move(message), ros::Time(100));
  }
  const Draft draft = tracker.draft();
  std::string text;
  for (std::size_t i = 0; i < draft.boxes.size(); ++i) {
    const BoxName& name = draft.snapshot.names[i];
    text += name.ns + "/" + std::to_string(name.id) + ":" +
            std::to_string(std::lround(std::get<OrientedBox>(draft.boxes[i]).center.x())) + " ";
  }
  const std::size_t rejected = draft.snapshot.topics.at(0).rejected;
  return text + (rejected > 0 ? "rejected " + std::to_string(rejected) : "");
}

}  // namespace box_query::test
