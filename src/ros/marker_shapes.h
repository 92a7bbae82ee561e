// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Boxes and queries as rviz draws them.
#pragma once

#include "ros/drawing.h"

#include <box_query/ros/scene_monitor.h>

#include <cstdint>
#include <string>
#include <vector>

#include <visualization_msgs/Marker.h>

namespace box_query {

/// The boxes of a snapshot, a triangle list ("boxes/TOPIC") and a line list ("edges/TOPIC") a
/// topic. They stay until they are replaced. Edges are at least as long as they are wide, so that a
/// flat or a tiny box is seen.
std::vector<visualization_msgs::Marker> boxMarkers(const Snapshot& snapshot);

/// Markers that take away those of `before` whose topics have no boxes in `now`.
std::vector<visualization_msgs::Marker> deletedBoxMarkers(const Snapshot& before,
                                                          const Snapshot& now);

/// Queries, coloured by outcome: red met something, green is free, yellow cannot be known.
/// `id` tells them from those drawn before, which stay for their own `lifetime` [s].
std::vector<visualization_msgs::Marker> queryMarkers(const std::vector<DrawnQuery>& queries,
                                                     const std::string& frame, double lifetime,
                                                     std::int32_t id);

}  // namespace box_query
