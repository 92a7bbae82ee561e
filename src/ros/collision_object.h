// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/box_source.h"

namespace box_query {

/// Reads a moveit_msgs/CollisionObject and appends what it says to the changes; as a decoder does.
void readCollisionObject(WireReader& reader, const Limits& limits, DecodedMessage& message);

}  // namespace box_query
