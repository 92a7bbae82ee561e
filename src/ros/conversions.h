// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Vectors and poses as messages, and the change of frame of a request. Nothing here rounds where
/// the frames are equal.
#pragma once

#include <box_query/geometry.h>

#include <limits>

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Vector3.h>

namespace box_query {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

template <class Message>
Vector3 fromMessage(const Message& xyz) {
  return {xyz.x, xyz.y, xyz.z};
}

template <class Message>
Message toMessage(const Vector3& vector) {
  Message xyz;
  xyz.x = vector.x();
  xyz.y = vector.y();
  xyz.z = vector.z();
  return xyz;
}
inline geometry_msgs::Point toPoint(const Vector3& point) {
  return toMessage<geometry_msgs::Point>(point);
}
inline geometry_msgs::Vector3 toVector3(const Vector3& vector) {
  return toMessage<geometry_msgs::Vector3>(vector);
}

inline geometry_msgs::Quaternion toQuaternion(const Quaternion& rotation) {
  geometry_msgs::Quaternion xyzw;
  xyzw.x = rotation.x();
  xyzw.y = rotation.y();
  xyzw.z = rotation.z();
  xyzw.w = rotation.w();
  return xyzw;
}
inline geometry_msgs::Pose toPose(const Vector3& position, const Quaternion& orientation) {
  geometry_msgs::Pose pose;
  pose.position = toPoint(position);
  pose.orientation = toQuaternion(orientation);
  return pose;
}

/// The point of a segment at parameter t in [0, 1]: exactly an end for 0 and 1, never outside the
/// box that the ends span, never overflowing.
inline Vector3 pointAt(const Segment& segment, double t) {
  const Vector3 point = (1 - t) * segment.start + t * segment.end;
  return point.cwiseMax(segment.start.cwiseMin(segment.end))
      .cwiseMin(segment.start.cwiseMax(segment.end));
}

/// Takes points and directions from the frame of a request into the fixed frame, and back.
class FrameChange {
 public:
  /// Between equal frames: nothing is touched.
  FrameChange() = default;

  /// `pose` is that of the request's frame in the fixed frame.
  explicit FrameChange(const geometry_msgs::Transform& pose)
      : same_(false),
        rotation_(Quaternion(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z)
                      .normalized()
                      .toRotationMatrix()),
        translation_(fromMessage(pose.translation)) {}

  bool same() const { return same_; }

  Vector3 pointIn(const Vector3& point) const {
    return same_ ? point : Vector3(rotation_ * point + translation_);
  }
  Vector3 directionIn(const Vector3& direction) const {
    return same_ ? direction : Vector3(rotation_ * direction);
  }
  Vector3 pointBack(const Vector3& point) const {
    return same_ ? point : Vector3(rotation_.transpose() * (point - translation_));
  }
  Vector3 directionBack(const Vector3& direction) const {
    return same_ ? direction : Vector3(rotation_.transpose() * direction);
  }

 private:
  bool same_ = true;
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();
  Vector3 translation_ = Vector3::Zero();
};

}  // namespace box_query
