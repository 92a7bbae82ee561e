// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is published under load, as a function of the stamp alone: publishers and checkers need not
/// talk to know the same. Every number has few enough binary digits for nothing to round on the
/// way from message to answer, through tf too: rotations only permute axes.
#pragma once

#include <box_query/geometry.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>

namespace box_query::load {

/// All stamps are multiples of 1/64 s since the epoch.
using Tick = std::int64_t;
constexpr Tick kTicksPerSecond = 64;
/// Transforms are sent at every second tick: in between tf interpolates.
constexpr Tick kTicksPerTransform = 2;

ros::Time timeOf(Tick tick);
/// The last tick that is not after `time`.
Tick tickAt(const ros::Time& time);

constexpr const char* kFixedFrame = "map";
constexpr const char* kRobot = "robot";  ///< turned, moves in map
constexpr const char* kCart = "cart";    ///< moves in map
constexpr const char* kLidar = "lidar";  ///< turned, moves in robot

/// X -> rotation X + translation; the rotation is that of the quaternion.
struct Pose {
  Quaternion quaternion;
  Eigen::Matrix3d rotation;  ///< its entries are 0 and +-1
  Vector3 translation;
};

/// Of the frame in the fixed frame, as tf has it.
Pose poseAt(const std::string& frame, Tick tick);
/// What is sent on /tf.
std::vector<geometry_msgs::TransformStamped> transformsAt(Tick tick);

enum class Type { kCubes, kCubeList, kJsk, kDetections, kObjects, kAutoware, kPlanningScene };

struct TopicOfBoxes {
  std::string name;  ///< resolved
  Type type;
  std::string frame;
};

constexpr std::size_t kTopics = 10;
constexpr std::size_t kBoxesPerTopic = 1000;
/// In the order of their names.
const std::array<TopicOfBoxes, kTopics>& topics();

struct KnownBox {
  std::string ns;
  std::int64_t id;
  std::string label;
  OrientedBox box;
};

/// What the topic says at that time, in its frame, in the order in which a message has it. Names
/// are always the same.
std::vector<KnownBox> boxesAt(std::size_t topic, Tick tick);

/// One box of every topic, and no other, is in one of these namespaces.
std::vector<std::string> witnessNamespaces();

}  // namespace box_query::load
