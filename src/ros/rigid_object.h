// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Objects that move as one: a message that moves one has no geometry, so that it is kept.
#pragma once

#include "ros/box_source.h"

#include <memory>
#include <string>
#include <vector>

namespace box_query {

/// X -> orientation X + position.
struct Pose {
  Vector3 position = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();
};

/// Moves poses that are given in `parent`. An identity leaves them as they are, to the last bit.
class Placer {
 public:
  explicit Placer(const Pose& parent)
      : parent_(parent),
        turns_(parent.orientation.coeffs() != Quaternion::Identity().coeffs()),
        rotation_(turns_ ? parent.orientation.normalized().toRotationMatrix()
                         : Eigen::Matrix3d(Eigen::Matrix3d::Identity())) {}

  Pose operator()(const Pose& pose) const {
    Pose placed;
    place(pose.position, pose.orientation, placed.position, placed.orientation);
    return placed;
  }
  /// Straight into where the result is kept: a copy would be waited for.
  void place(const Vector3& position, const Quaternion& orientation, Vector3& placed_position,
             Quaternion& placed_orientation) const {
    if (turns_) {
      placed_position.noalias() = rotation_ * position;
      placed_position = parent_.position + placed_position;
      placed_orientation = parent_.orientation * orientation;
    } else {
      placed_position = parent_.position + position;
      placed_orientation = orientation;
    }
  }

 private:
  Pose parent_;
  bool turns_;
  Eigen::Matrix3d rotation_;
};

/// What a kSet or kAppend change says of an object, in the object's own frame.
struct RigidObject {
  std::string label;
  std::vector<IdentifiedBox> boxes;  ///< their ids are their places among the shapes
  std::size_t shapes = 0;            ///< of any kind
  Rare<Rejected> rejections;         ///< boxes that cannot be moved either
};

/// The change that says the same of the object where a kMove change puts it. Of the shapes that the
/// move counts, those of this object begin at `first_shape`.
/// @pre move.boxes holds the pose of the object and, unless that is all, of so many shapes.
BoxChange moved(const std::shared_ptr<const RigidObject>& object, const BoxChange& move,
                std::size_t first_shape);

}  // namespace box_query
