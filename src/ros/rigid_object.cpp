// SPDX-License-Identifier: BSD-3-Clause
#include "ros/rigid_object.h"

namespace box_query {
namespace {

Pose poseOf(const IdentifiedBox& box) {
  return {box.box.center, box.box.orientation};
}

/// The object with other poses of its shapes within it.
std::shared_ptr<const RigidObject> rearranged(const RigidObject& object, const BoxChange& move,
                                              std::size_t first_shape) {
  const auto result = std::make_shared<RigidObject>(object);
  for (IdentifiedBox& box : result->boxes) {
    const OrientedBox& shape = move.boxes[1 + first_shape + static_cast<std::size_t>(box.id)].box;
    box.box.center = shape.center;
    box.box.orientation = shape.orientation;
  }
  return result;
}

}  // namespace

BoxChange moved(const std::shared_ptr<const RigidObject>& object, const BoxChange& move,
                std::size_t first_shape) {
  BoxChange change(move.max_coordinate);
  change.ns = move.ns;
  change.frame = move.frame;
  change.stamp = move.stamp;
  change.label = object->label;
  change.object = move.boxes.size() > 1 ? rearranged(*object, move, first_shape) : object;
  change.rejections = object->rejections;
  const Placer placed(poseOf(move.boxes.front()));
  for (const IdentifiedBox& box : change.object->boxes) {
    const Pose now = placed(poseOf(box));
    change.add(box.id, now.position, now.orientation, 2.0 * box.box.half_extents);
  }
  return change;
}

}  // namespace box_query
