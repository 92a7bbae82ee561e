// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/diagnostics.h"
#include "ros/registration.h"
#include "ros/server.h"

#include <box_query/ros/scene_monitor.h>

#include <ros/node_handle.h>

namespace box_query {

/// The node, whether a process or a nodelet: a SceneMonitor with services in front, markers and
/// diagnostics behind, on threads of their own. Its end waits for the answers that are being worked
/// on, but not for the rest of a batch.
class Node {
 public:
  /// Topics are resolved in the namespace of `nh`; parameters, services and markers are those of
  /// `private_nh`.
  /// @throws std::invalid_argument naming a parameter that is wrong, its value and what is allowed.
  Node(const ros::NodeHandle& nh, ros::NodeHandle& private_nh);

 private:
  SceneMonitor monitor_;
  Server server_;
  Diagnostics diagnostics_;
  Registration registration_;
};

}  // namespace box_query
