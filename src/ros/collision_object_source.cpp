// SPDX-License-Identifier: BSD-3-Clause
// moveit_msgs/CollisionObject of Noetic, with the meaning that MoveIt's planning scene gives it: a
// change of one object. The object's id is the namespace, the n-th primitive has the id n (those
// appended later n + k * 2^32), and the key of the type is the label. A primitive's pose is
// relative to the object's; both are the identity where they are not given. REMOVE without an id
// removes all. What differs: solids other than boxes, meshes and planes are ignored and counted,
// and MOVE, which has no geometry of its own, is rejected by name.
#include "ros/box_source.h"
#include "ros/foreign_fields.h"

#include <algorithm>
#include <string>

namespace box_query {
namespace {

// Operations.
constexpr std::int8_t kAdd = 0;
constexpr std::int8_t kRemove = 1;
constexpr std::int8_t kAppend = 2;
constexpr std::int8_t kMove = 3;

// Bytes of a pose, and of a mesh and a string that are empty.
constexpr std::size_t kPoseSize = 7 * sizeof(double);
constexpr std::size_t kMeshSize = 2 * sizeof(std::uint32_t);
constexpr std::size_t kStringSize = sizeof(std::uint32_t);
constexpr std::size_t kTriangleSize = 3 * sizeof(std::uint32_t);
constexpr std::size_t kPointSize = 3 * sizeof(double);
constexpr std::size_t kPlaneSize = 4 * sizeof(double);

struct Pose {
  Vector3 position = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();
};

Pose readPose(WireReader& reader) {
  Pose pose;
  pose.position = reader.vector();
  pose.orientation = reader.quaternion();
  if (pose.orientation.coeffs() == Eigen::Vector4d::Zero()) {
    pose.orientation.setIdentity();
  }
  return pose;
}

/// A pose that is given in `parent`. An identity leaves it as it is, to the last bit.
Pose placed(const Pose& parent, const Pose& pose) {
  if (parent.orientation.coeffs() == Quaternion::Identity().coeffs()) {
    return {parent.position + pose.position, pose.orientation};
  }
  const Eigen::Matrix3d rotation = parent.orientation.normalized().toRotationMatrix();
  return {parent.position + rotation * pose.position, parent.orientation * pose.orientation};
}

/// Reads the primitives and their poses. The boxes among them come before their poses: a second
/// reader goes along. @return the number of primitives
std::uint32_t readPrimitives(WireReader& reader, const Pose& object, std::size_t max_boxes,
                             BoxChange& change, DecodedMessage& message) {
  const std::uint32_t primitives = reader.count(SolidPrimitive::kSmallest);
  WireReader solids = reader;
  for (std::uint32_t n = 0; n < primitives && reader.ok(); ++n) {
    readSolidPrimitive(reader);
  }
  if (primitives > max_boxes) {
    message.problem = tooManyBoxes(max_boxes);
    return primitives;
  }
  const std::uint32_t poses = reader.count(kPoseSize);
  for (std::uint32_t n = 0; n < std::max(primitives, poses) && reader.ok(); ++n) {
    const Pose pose = placed(object, n < poses ? readPose(reader) : Pose());
    if (n >= primitives) {
      continue;  // a pose too many
    }
    const SolidPrimitive solid = readSolidPrimitive(solids);
    if (solid.type != SolidPrimitive::kBox) {
      ++message.ignored;
    } else if (solid.dimensions != 3) {
      change.reject(Rejection::kShape, 1, "it has " + std::to_string(solid.dimensions), n);
    } else {
      change.add(n, pose.position, pose.orientation, solid.sides);
    }
  }
  return primitives;
}

/// @return the number of meshes and planes
std::uint32_t skipMeshesAndPlanes(WireReader& reader) {
  const std::uint32_t meshes = reader.count(kMeshSize);
  for (std::uint32_t n = 0; n < meshes && reader.ok(); ++n) {
    skipArray(reader, kTriangleSize);
    skipArray(reader, kPointSize);
  }
  skipArray(reader, kPoseSize);
  const std::uint32_t planes = reader.count(kPlaneSize);
  reader.skip(std::uint64_t{planes} * kPlaneSize);
  skipArray(reader, kPoseSize);
  return meshes + planes;
}

void skipSubframes(WireReader& reader) {
  const std::uint32_t names = reader.count(kStringSize);
  for (std::uint32_t n = 0; n < names && reader.ok(); ++n) {
    reader.string();
  }
  skipArray(reader, kPoseSize);
}

/// Makes the change what the operation means.
void apply(std::int8_t operation, bool has_geometry, BoxChange& change) {
  if (operation == kRemove) {
    change.kind = change.ns.empty() ? BoxChange::Kind::kClear : BoxChange::Kind::kRemove;
    return;
  }
  if (operation == kAppend) {
    change.kind = BoxChange::Kind::kAppend;
  }
  if (operation == kMove) {
    change.reject(Rejection::kAction, 1, "MOVE: add it again where it is now", change.id);
  } else if (operation != kAdd && operation != kAppend) {
    change.reject(Rejection::kAction, 1, std::to_string(operation), change.id);
  } else if (!has_geometry) {
    change.reject(Rejection::kShape, 1, "it has no geometry", change.id);
  } else if (isBadFrame(change.frame)) {
    change.reject(Rejection::kFrame, change.boxes.size(), "'" + change.frame + "'", change.id);
  } else {
    return;
  }
  change.boxes.clear();
}

}  // namespace

void decodeCollisionObject(WireReader& reader, std::size_t max_boxes, DecodedMessage& message) {
  BoxChange& change = message.changes.emplace_back();
  change.whole_namespace = true;
  const WireHeader header = reader.header();
  change.stamp = header.stamp;
  change.frame = stripSlash(header.frame);
  const Pose pose = readPose(reader);
  change.ns = reader.string();
  change.label = reader.string();  // type.key
  reader.string();                 // type.db
  const std::uint32_t primitives = readPrimitives(reader, pose, max_boxes, change, message);
  if (!message.problem.empty()) {
    return;
  }
  const std::uint32_t others = skipMeshesAndPlanes(reader);
  skipSubframes(reader);
  const auto operation = reader.number<std::int8_t>();
  message.ignored = operation == kAdd || operation == kAppend ? message.ignored + others : 0;
  apply(operation, primitives > 0 || others > 0, change);
}

}  // namespace box_query
