// SPDX-License-Identifier: BSD-3-Clause
// autoware_msgs/DetectedObjectArray of Autoware.AI's last release, with the meaning that its own
// displays give it: a whole set. The array's header counts, an object's own only where the array's
// names no frame; `space_frame` is not looked at. The class is `label`, ids are the tracker's and
// need not be unique. Objects that a filter has marked as not `valid` are no objects: they are
// ignored and counted. An orientation that is neither given nor called reliable is the identity.
#include "ros/foreign_fields.h"
#include "ros/whole_set.h"

namespace box_query {
namespace {

// Bytes of what has no strings and no elements in its arrays.
constexpr std::size_t kObjectSize = 389;
constexpr std::size_t kLaneSize = 45;
constexpr std::size_t kWaypointSize = 249;

constexpr std::size_t kVectorSize = 3 * sizeof(double);
constexpr std::size_t kTwistSize = 2 * kVectorSize;
constexpr std::size_t kPoseSize = 7 * sizeof(double);

/// autoware_msgs/LaneArray
void skipLanes(WireReader& reader) {
  reader.skip(sizeof(std::int32_t));  // id
  const std::uint32_t lanes = reader.count(kLaneSize);
  for (std::uint32_t lane = 0; lane < lanes && reader.ok(); ++lane) {
    reader.header();
    reader.skip(2 * sizeof(std::int32_t));  // increment, lane_id
    const std::uint32_t waypoints = reader.count(kWaypointSize);
    for (std::uint32_t n = 0; n < waypoints && reader.ok(); ++n) {
      reader.skip(2 * sizeof(std::int32_t));  // gid, lid
      reader.header();
      reader.skip(kPoseSize);
      reader.header();
      reader.skip(kTwistSize);
      // dtlane, change_flag, wpstate, four lane ids, two costs, direction
      reader.skip(8 * sizeof(double) + 4 + (4 + 5) + 4 * 4 + 2 * sizeof(float) + 4);
    }
    reader.skip(4 + 3 * sizeof(float) + 1);  // lane_index, cost, closest object, is_blocked
  }
}

/// sensor_msgs/Image
void skipImage(WireReader& reader) {
  reader.header();
  reader.skip(2 * sizeof(std::uint32_t));  // height, width
  reader.string();                         // encoding
  reader.skip(1 + sizeof(std::uint32_t));  // is_bigendian, step
  skipArray(reader, 1);                    // data
}

void skipStrings(WireReader& reader) {
  const std::uint32_t strings = reader.count(sizeof(std::uint32_t));
  for (std::uint32_t n = 0; n < strings && reader.ok(); ++n) {
    reader.string();
  }
}

void readObject(WireReader& reader, const WireHeader& array, WholeSet& set,
                DecodedMessage& message) {
  const WireHeader own = reader.header();
  const std::int64_t id = reader.number<std::uint32_t>();
  const std::string_view label = reader.name("label");
  reader.skip(5 * sizeof(float));  // score, color
  const bool valid = reader.number<std::uint8_t>() != 0;
  reader.string();  // space_frame
  WireBox box = reader.box();
  reader.skip(kVectorSize + 2 * kTwistSize);  // variance, velocity, acceleration
  skipPointCloud2(reader);
  reader.header();  // of convex_hull
  skipArray(reader, 3 * sizeof(float));
  skipLanes(reader);
  const bool pose_reliable = reader.number<std::uint8_t>() != 0;
  reader.skip(2);   // velocity_reliable, acceleration_reliable
  reader.string();  // image_frame
  reader.skip(4 * sizeof(std::int32_t) + sizeof(float));  // x, y, width, height, angle
  skipImage(reader);
  reader.skip(2);       // indicator_state, behavior_state
  skipStrings(reader);  // user_defined_info
  if (!valid) {
    ++message.ignored;
    return;
  }
  if (!pose_reliable && box.orientation.coeffs() == Eigen::Vector4d::Zero()) {
    box.orientation.setIdentity();
  }
  set.add(array.frame.empty() ? own : array, label, id, box.center, box.orientation, box.size);
}

}  // namespace

void decodeAutowareDetectedObjectArray(WireReader& reader, const Limits& limits,
                                       DecodedMessage& message) {
  const WireHeader array = reader.header();
  const auto read = [&](WholeSet& set, std::uint32_t /*n*/) {
    readObject(reader, array, set, message);
  };
  WholeSet::decode(reader, kObjectSize, limits, array.stamp, message, read);
}

}  // namespace box_query
