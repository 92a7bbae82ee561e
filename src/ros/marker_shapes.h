// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Boxes and queries as rviz draws them.
#pragma once

#include "ros/drawing.h"

#include <box_query/ros/scene_monitor.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <ros/time.h>
#include <visualization_msgs/Marker.h>

namespace box_query {

/// Who a marker is.
struct MarkerName {
  std::string ns;
  std::int32_t id;
};

/// White words that face whoever looks.
visualization_msgs::Marker textMarker(const std::string& frame, const MarkerName& name,
                                      const std::string& words, const Vector3& at);

/// The boxes of a snapshot at ROS time `now`, a triangle list ("boxes/TOPIC") and a line list
/// ("edges/TOPIC") a topic, in the topic's colour. Two such lists hold those that are where they
/// were ("waiting/TOPIC", with yellow edges), or of a topic that is stale ("stale/TOPIC", faint).
/// Edges are at least as long as they are wide, so that a flat or a tiny box is seen.
///
/// "labels/TOPIC" are texts above the first `max_labels` boxes: their labels, or namespace and id.
/// "status", at the origin, says what is missing. All stay until they are replaced.
std::vector<visualization_msgs::Marker> boxMarkers(const Snapshot& snapshot, const ros::Time& now,
                                                   std::size_t max_labels);

/// What is missing at ROS time `now`, a short line a topic; empty if nothing is.
std::string statusText(const Snapshot& snapshot, const ros::Time& now);

std::vector<MarkerName> namesOf(const std::vector<visualization_msgs::Marker>& markers);

/// Markers that take away those of `before` that are not among `markers`.
std::vector<visualization_msgs::Marker> deletions(
    const std::vector<MarkerName>& before, const std::vector<visualization_msgs::Marker>& markers,
    const std::string& frame);

/// Queries, coloured by outcome: red met something, green is free, yellow cannot be known.
/// `id` tells them from those drawn before, which stay for their own `lifetime` [s]; 0: for good.
std::vector<visualization_msgs::Marker> queryMarkers(const std::vector<DrawnQuery>& queries,
                                                     const std::string& frame, double lifetime,
                                                     std::int32_t id);

}  // namespace box_query
