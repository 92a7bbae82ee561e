// SPDX-License-Identifier: BSD-3-Clause
// moveit_msgs/PlanningScene of Noetic: the collision objects of its world, all of the topic's or,
// in a diff, changes. An object that is attached to the robot leaves the world: its boxes are
// ignored and counted, as is an octomap. One that is detached comes back where the robot holds it,
// which is not known here: it is rejected unless the world of the same message has it. Frames are
// tf's, not those of fixed_frame_transforms.
#include "ros/collision_object.h"
#include "ros/foreign_fields.h"

#include <utility>

namespace box_query {
namespace {

// Bytes of the smallest elements of arrays.
constexpr std::size_t kString = sizeof(std::uint32_t);
constexpr std::size_t kArray = sizeof(std::uint32_t);
constexpr std::size_t kHeader = 3 * sizeof(std::uint32_t) + kString;
constexpr std::size_t kPose = 7 * sizeof(double);   // also a transform
constexpr std::size_t kTwist = 6 * sizeof(double);  // also a wrench
constexpr std::size_t kColor = 4 * sizeof(float);
constexpr std::size_t kObject = kHeader + kPose + 11 * kArray + 1;

void skipStrings(WireReader& reader) {
  const std::uint32_t strings = reader.count(kString);
  for (std::uint32_t n = 0; n < strings && reader.ok(); ++n) {
    reader.string();
  }
}

/// An array whose elements are a string and so many bytes.
void skipNamed(WireReader& reader, std::size_t bytes) {
  const std::uint32_t elements = reader.count(kString + bytes);
  for (std::uint32_t n = 0; n < elements && reader.ok(); ++n) {
    reader.string();
    reader.skip(bytes);
  }
}

void skipJointState(WireReader& reader) {
  reader.header();
  skipStrings(reader);
  for (int array = 0; array < 3; ++array) {
    skipArray(reader, sizeof(double));
  }
}

void skipMultiDofJointState(WireReader& reader) {
  reader.header();
  skipStrings(reader);
  skipArray(reader, kPose);
  skipArray(reader, kTwist);
  skipArray(reader, kTwist);
}

void skipJointTrajectory(WireReader& reader) {
  reader.header();
  skipStrings(reader);
  const std::uint32_t points = reader.count(4 * kArray + 8);
  for (std::uint32_t n = 0; n < points && reader.ok(); ++n) {
    for (int array = 0; array < 4; ++array) {
      skipArray(reader, sizeof(double));
    }
    reader.duration();
  }
}

void skipTransforms(WireReader& reader) {
  const std::uint32_t transforms = reader.count(kHeader + kString + kPose);
  for (std::uint32_t n = 0; n < transforms && reader.ok(); ++n) {
    reader.header();
    reader.string();
    reader.skip(kPose);
  }
}

void skipAllowedCollisionMatrix(WireReader& reader) {
  skipStrings(reader);
  const std::uint32_t rows = reader.count(kArray);
  for (std::uint32_t n = 0; n < rows && reader.ok(); ++n) {
    skipArray(reader, 1);
  }
  skipStrings(reader);
  skipArray(reader, 1);
}

/// What an attached object means for the world.
BoxChange left(const BoxChange& attached) {
  BoxChange change;
  change.whole_namespace = true;
  change.ns = attached.ns;
  change.stamp = attached.stamp;
  if (attached.kind == BoxChange::Kind::kSet || attached.kind == BoxChange::Kind::kAppend) {
    change.kind = BoxChange::Kind::kRemove;
  } else {
    change.reject(Rejection::kAction, 1, "it is detached: add it to the world", 0);
  }
  return change;
}

void readAttachedObject(WireReader& reader, const Limits& limits, DecodedMessage& message) {
  reader.string();  // link_name
  DecodedMessage attached;
  readCollisionObject(reader, limits, attached);
  skipStrings(reader);  // touch_links
  skipJointTrajectory(reader);
  reader.skip(sizeof(double));  // weight
  message.problem = attached.problem;
  const BoxChange& object = attached.changes.front();
  message.ignored += attached.ignored + object.boxes.size();
  message.changes.push_back(left(object));
}

/// @return how many there are: 0 or 1.
std::size_t readOctomap(WireReader& reader) {
  reader.header();
  reader.skip(kPose);
  reader.header();
  reader.skip(1);  // binary
  reader.string();
  reader.skip(sizeof(double));  // resolution
  const std::uint32_t size = reader.count(1);
  reader.skip(size);
  return size > 0 ? 1 : 0;
}

/// An array of objects, each of which `read` makes one change of.
template <class Read>
void readObjects(WireReader& reader, std::size_t smallest, const Limits& limits, Read read,
                 DecodedMessage& message) {
  const std::uint32_t objects = reader.count(smallest);
  std::size_t boxes = 0;
  for (std::uint32_t n = 0; n < objects && reader.ok() && message.problem.empty(); ++n) {
    Limits rest = limits;
    rest.boxes -= boxes;
    read(reader, rest, message);
    boxes += message.changes.back().boxes.size();
    if (!message.problem.empty()) {
      message.problem = tooManyBoxes(limits.boxes);
    }
  }
}

}  // namespace

void decodePlanningScene(WireReader& reader, const Limits& limits, DecodedMessage& message) {
  reader.string();  // name
  skipJointState(reader);
  skipMultiDofJointState(reader);
  readObjects(reader, kString + kObject, limits, readAttachedObject, message);
  reader.skip(1);   // robot_state.is_diff
  reader.string();  // robot_model_name
  skipTransforms(reader);
  skipAllowedCollisionMatrix(reader);
  skipNamed(reader, sizeof(double));  // link_padding
  skipNamed(reader, sizeof(double));  // link_scale
  skipNamed(reader, kColor);          // object_colors
  readObjects(reader, kObject, limits, readCollisionObject, message);
  if (!message.problem.empty()) {
    return;
  }
  message.ignored += readOctomap(reader);
  message.whole = reader.number<std::uint8_t>() == 0;  // is_diff
}

}  // namespace box_query
