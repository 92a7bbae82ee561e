// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/bell.h"

#include <functional>
#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <ros/node_handle.h>
#include <ros/time.h>
#include <tf2/buffer_core.h>
#include <tf2_ros/transform_listener.h>

namespace box_query {

/// What tf says, kept on a thread of its own.
class Transforms {
 public:
  /// `changed` is called after every transform, from the thread that receives them.
  Transforms(const ros::NodeHandle& nh, const ros::Duration& history,
             std::function<void()> changed);

  const tf2::BufferCore& buffer() const { return buffer_; }

  /// See SceneMonitor::lookUpTransform().
  std::string lookUp(const std::string& target, const std::string& source, const ros::Time& stamp,
                     double timeout, geometry_msgs::TransformStamped& transform);

  /// Forgets all but the static transforms.
  void clear() { buffer_.clear(); }

 private:
  Bell bell_;
  tf2::BufferCore buffer_;
  tf2_ros::TransformListener listener_;  // last: its thread rings the bell
};

}  // namespace box_query
