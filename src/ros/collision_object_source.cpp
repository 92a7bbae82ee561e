// SPDX-License-Identifier: BSD-3-Clause
// moveit_msgs/CollisionObject of Noetic, with the meaning that MoveIt's planning scene gives it: a
// change of one object. The object's id is the namespace, the n-th primitive has the id n (those
// appended later n + k * 2^32), and the key of the type is the label. A primitive's pose is
// relative to the object's; both are the identity where they are not given. REMOVE without an id
// removes all. MOVE gives the object another pose, and where it lists poses of all shapes, of
// primitives, meshes and planes in this order, those too. What differs: solids other than boxes,
// meshes and planes are ignored and counted, and what is appended is placed by the pose that comes
// with it.
#include "ros/box_checks.h"
#include "ros/collision_object.h"
#include "ros/foreign_fields.h"
#include "ros/number_pairs.h"
#include "ros/rigid_object.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

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

/// Straight into where it is kept: a copy would be waited for. A quaternion of zeros is the
/// identity.
void readPose(const std::uint8_t* bytes, Vector3& position, Quaternion& orientation) {
  copyNumbers(bytes, position);
  const NumberPair xy = loadPair(bytes + sizeof(position));
  const NumberPair zw = loadPair(bytes + sizeof(position) + sizeof(xy));
  const auto is_set = (xy != 0.0) | (zw != 0.0);
  const NumberPair unit_zw = {0.0, 1.0};
  storePair(xy, orientation.coeffs().data());
  storePair((is_set[0] | is_set[1]) != 0 ? zw : unit_zw, orientation.coeffs().data() + 2);
}

/// The n-th of them; the identity if there are fewer.
void readPoseAt(const WireArray& poses, std::uint32_t n, Vector3& position,
                Quaternion& orientation) {
  if (n < poses.count) {
    readPose(poses.elements.bytes() + n * kPoseSize, position, orientation);
  } else {
    position.setZero();
    orientation.setIdentity();
  }
}

Pose poseAt(const WireArray& poses, std::uint32_t n) {
  Pose pose;
  readPoseAt(poses, n, pose.position, pose.orientation);
  return pose;
}

/// What stands at the same places in every object, whatever its operation.
struct Fields {
  Pose pose;
  std::uint32_t primitives = 0;
  std::size_t ignored = 0;               ///< primitives that are no boxes
  std::uint32_t others = 0;              ///< meshes and planes
  std::array<WireArray, 3> shape_poses;  ///< of primitives, meshes, planes
  std::shared_ptr<RigidObject> object;   ///< what a later MOVE moves
};

/// A primitive that is said to be a box.
struct Solid {
  std::uint32_t n;
  std::uint32_t dimensions;
  Vector3 sides;
};
/// Most objects have few: they need no allocation.
using Solids = boost::container::small_vector<Solid, 16>;

/// @param most as many are wanted
Solids readSolids(WireReader& reader, std::size_t most, Fields& fields) {
  Solids solids;
  solids.reserve(std::min<std::size_t>(fields.primitives, most));
  for (std::uint32_t n = 0; n < fields.primitives && reader.ok(); ++n) {
    const SolidPrimitive solid = readSolidPrimitive(reader);
    if (solid.type != SolidPrimitive::kBox) {
      ++fields.ignored;
    } else if (solids.size() < most) {
      solids.push_back({n, solid.dimensions, solid.sides});
    }
  }
  return solids;
}

/// Adds the boxes one by one and keeps those that are good as they are within the object.
void addEach(const Solids& solids, const Placer& placed, Fields& fields, BoxChange& change) {
  for (const Solid& solid : solids) {
    if (solid.dimensions != 3) {
      change.reject(Rejection::kShape, 1, "it has " + std::to_string(solid.dimensions), solid.n);
      continue;
    }
    const Pose in_object = poseAt(fields.shape_poses.front(), solid.n);
    const Pose pose = placed(in_object);
    const std::size_t accepted = change.boxes.size();
    change.add(solid.n, pose.position, pose.orientation, solid.sides);
    if (change.boxes.size() > accepted) {
      fields.object->boxes.emplace_back(solid.n, in_object.position, in_object.orientation,
                                        0.5 * solid.sides);
    }
  }
}

/// The same in less time where all are good.
void addSolids(const Solids& solids, Fields& fields, BoxChange& change) {
  fields.object = std::make_shared<RigidObject>();
  std::vector<IdentifiedBox>& kept = fields.object->boxes;
  BoxList::Each& each = change.boxes.each();
  kept.reserve(solids.size());
  each.resize(solids.size(), boost::container::default_init);
  const Placer placed(fields.pose);
  const WireArray poses = fields.shape_poses.front();
  // Step by step: what was just written would be waited for.
  bool are_boxes = true;
  for (const Solid& solid : solids) {
    are_boxes = are_boxes && solid.dimensions == 3;
    IdentifiedBox& in_object = kept.emplace_back();
    in_object.id = solid.n;
    readPoseAt(poses, solid.n, in_object.box.center, in_object.box.orientation);
    in_object.box.half_extents = 0.5 * solid.sides;
  }
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const OrientedBox& in_object = kept[i].box;
    OrientedBox& box = each[i].box;
    each[i].id = kept[i].id;
    placed.place(in_object.center, in_object.orientation, box.center, box.orientation);
    box.half_extents = in_object.half_extents;
  }
  BoxChecks checks;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const OrientedBox& box = each[i].box;
    checks.see(box.center.data(), box.orientation.coeffs().data(), solids[i].sides.data());
  }
  if (!are_boxes || !checks.areSurelyGood(change.max_coordinate)) {
    each.clear();
    kept.clear();
    addEach(solids, placed, fields, change);
  }
}

/// Reads the primitives and their poses. All primitives come before the first pose.
void readPrimitives(WireReader& reader, const Limits& limits, Fields& fields, BoxChange& change,
                    DecodedMessage& message) {
  fields.primitives = reader.count(SolidPrimitive::kSmallest);
  const Solids solids = readSolids(reader, limits.boxes, fields);
  if (fields.primitives > limits.boxes) {
    message.problem = tooManyBoxes(limits.boxes);
    return;
  }
  fields.shape_poses[0] = reader.array(kPoseSize);
  if (reader.ok()) {
    addSolids(solids, fields, change);
  }
}

void skipMeshesAndPlanes(WireReader& reader, Fields& fields) {
  const std::uint32_t meshes = reader.count(kMeshSize);
  for (std::uint32_t n = 0; n < meshes && reader.ok(); ++n) {
    skipArray(reader, kTriangleSize);
    skipArray(reader, kPointSize);
  }
  fields.shape_poses[1] = reader.array(kPoseSize);
  const std::uint32_t planes = reader.array(kPlaneSize).count;
  fields.shape_poses[2] = reader.array(kPoseSize);
  fields.others = meshes + planes;
}

void skipSubframes(WireReader& reader) {
  const std::uint32_t names = reader.count(kStringSize);
  for (std::uint32_t n = 0; n < names && reader.ok(); ++n) {
    reader.string();
  }
  skipArray(reader, kPoseSize);
}

/// Keeps what a later MOVE moves.
void keep(Fields&& fields, BoxChange& change) {
  RigidObject& object = *fields.object;
  object.shapes = fields.primitives + fields.others;
  object.label = change.label;
  object.rejections = change.rejections;
  const bool is_placed = fields.pose.position != Vector3::Zero() ||
                         fields.pose.orientation.coeffs() != Quaternion::Identity().coeffs();
  if (object.shapes == 1 && !is_placed) {  // MoveIt: the pose of the one shape is the object's
    for (IdentifiedBox& box : object.boxes) {
      box.box.center.setZero();
      box.box.orientation.setIdentity();
    }
  }
  change.object = std::move(fields.object);
}

void add(Fields&& fields, BoxChange& change) {
  if (fields.primitives + fields.others == 0) {
    change.reject(Rejection::kShape, 1, "it has no geometry", change.id);
  } else if (isBadFrame(change.frame)) {
    change.reject(Rejection::kFrame, change.boxes.size(), "'" + change.frame.str() + "'",
                  change.id);
    change.boxes.clear();
  } else if (!change.boxes.empty() || change.rejected() == 0) {
    keep(std::move(fields), change);
  }
}

/// Its own shapes mean nothing.
void move(Fields&& fields, BoxChange& change) {
  BoxChange move(change.max_coordinate);
  move.kind = BoxChange::Kind::kMove;
  move.ns = change.ns;
  move.frame = change.frame;
  move.stamp = change.stamp;
  move.add(0, fields.pose.position, fields.pose.orientation, Vector3::Zero());
  for (const WireArray& poses : fields.shape_poses) {
    for (std::uint32_t n = 0; n < poses.count; ++n) {
      const Pose pose = poseAt(poses, n);
      move.add(n, pose.position, pose.orientation, Vector3::Zero());
    }
  }
  if (isBadFrame(move.frame)) {
    move.boxes.clear();
    move.reject(Rejection::kFrame, 1, "'" + move.frame.str() + "'", 0);
  }
  change = std::move(move);
}

/// Its shapes mean nothing, be they good or bad.
void remove(BoxChange& change) {
  BoxChange removal;
  removal.kind = change.ns.empty() ? BoxChange::Kind::kClear : BoxChange::Kind::kRemove;
  removal.whole_namespace = change.whole_namespace;
  removal.ns = change.ns;
  removal.stamp = change.stamp;
  change = std::move(removal);
}

/// Makes the change what the operation means.
void apply(std::int8_t operation, Fields&& fields, BoxChange& change) {
  switch (operation) {
    case kAppend:
      change.kind = BoxChange::Kind::kAppend;
      add(std::move(fields), change);
      break;
    case kAdd:
      add(std::move(fields), change);
      break;
    case kRemove:
      remove(change);
      break;
    case kMove:
      move(std::move(fields), change);
      break;
    default:
      change.reject(Rejection::kAction, 1, std::to_string(operation), change.id);
      change.boxes.clear();
  }
}

}  // namespace

void decodeCollisionObject(WireReader& reader, const Limits& limits, DecodedMessage& message) {
  readCollisionObject(reader, limits, message);
}

void readCollisionObject(WireReader& reader, const Limits& limits, DecodedMessage& message) {
  const WireHeader header = reader.header();
  Fields fields;
  WireBlock pose = reader.block<kPoseSize>();
  readPose(pose.bytes(), fields.pose.position, fields.pose.orientation);
  const std::string_view id = reader.name("id");
  BoxChange& change = message.changes.emplace_back(limits.coordinate, id, stripSlash(header.frame));
  change.whole_namespace = true;
  change.stamp = header.stamp;
  change.label = reader.name("type.key");
  reader.string();  // type.db
  readPrimitives(reader, limits, fields, change, message);
  if (!message.problem.empty() || !reader.ok()) {
    return;
  }
  skipMeshesAndPlanes(reader, fields);
  skipSubframes(reader);
  const auto operation = reader.number<std::int8_t>();
  const bool has_shapes = operation == kAdd || operation == kAppend;
  message.ignored += has_shapes ? fields.ignored + fields.others : 0;
  apply(operation, std::move(fields), change);
}

}  // namespace box_query
