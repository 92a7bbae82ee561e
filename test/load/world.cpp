// SPDX-License-Identifier: BSD-3-Clause
#include "load/world.h"

#include "ros/conversions.h"

#include <cmath>
#include <random>

namespace box_query::load {
namespace {

constexpr std::uint32_t kTick = 15625000;  // [ns]

Pose composed(const Pose& outer, const Pose& inner) {
  return {outer.quaternion * inner.quaternion, outer.rotation * inner.rotation,
          outer.rotation * inner.translation + outer.translation};
}

/// A number that goes up and down again, in steps of 1/16.
double swing(Tick step, Tick period) {
  const Tick phase = ((step % (2 * period)) + 2 * period) % (2 * period);
  return static_cast<double>(phase < period ? phase : 2 * period - phase) / 16.0;
}

/// In its parent, at the time of the n-th transform.
Pose sentPose(const std::string& frame, Tick n) {
  Pose pose = {Quaternion::Identity(), Eigen::Matrix3d::Identity(), Vector3::Zero()};
  if (frame == kRobot) {
    pose.quaternion = Quaternion(0.5, 0.5, 0.5, 0.5);
    pose.rotation << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    pose.translation = {swing(3 * n, 128), swing(5 * n, 96) - 4.0, 0.25};
  } else if (frame == kCart) {
    pose.translation = {swing(7 * n, 160), -swing(2 * n, 64), 0.5};
  } else if (frame == kLidar) {
    pose.quaternion = Quaternion(0.0, 0.0, 0.0, 1.0);
    pose.rotation << -1, 0, 0, 0, -1, 0, 0, 0, 1;
    pose.translation = {1.0, swing(n, 16), 0.75};
  }
  return pose;
}

Pose poseInParent(const std::string& frame, Tick tick) {
  Pose pose = sentPose(frame, tick / kTicksPerTransform);
  if (tick % kTicksPerTransform != 0) {
    pose.translation =
        0.5 * (pose.translation + sentPose(frame, tick / kTicksPerTransform + 1).translation);
  }
  return pose;
}

/// Multiples of 1/16, their length within 0.5 % of 1: products with half quaternions are exact.
Quaternion coarseQuaternion(std::mt19937& random) {
  std::uniform_int_distribution<int> digit(-16, 16);
  for (;;) {
    const std::array<int, 4> q = {digit(random), digit(random), digit(random), digit(random)};
    const int squared = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (std::abs(squared - 256) <= 2) {
      return Quaternion(q[0] / 16.0, q[1] / 16.0, q[2] / 16.0, q[3] / 16.0);
    }
  }
}

/// The boxes of a topic before they move.
std::vector<KnownBox> restingBoxes(std::size_t topic) {
  const Type type = topics()[topic].type;
  std::mt19937 random(static_cast<unsigned>(topic));
  std::uniform_int_distribution<int> across(-40 * 64, 40 * 64);
  std::uniform_int_distribution<int> up(0, 6 * 64);
  std::uniform_int_distribution<int> half(1, 12);
  const auto ns_of = [type](std::size_t i) -> std::string {
    const bool witness = i + 1 == kBoxesPerTopic;
    switch (type) {
      case Type::kCubeList:
        return witness ? "witness" : "list";
      case Type::kJsk:
      case Type::kDetections:
        return witness ? "9" : std::to_string(i % 4);
      case Type::kObjects:
        return witness ? "BARRIER" : i % 2 == 0 ? "CAR" : "TRUCK";
      default:
        return witness ? "witness" : i % 2 == 0 ? "pallet" : "rack";
    }
  };
  std::vector<KnownBox> boxes;
  for (std::size_t i = 0; i < kBoxesPerTopic; ++i) {
    KnownBox known;
    known.ns = ns_of(i);
    known.label = known.ns;
    known.id = static_cast<std::int64_t>(i);
    known.box.center = Vector3(across(random), across(random), up(random)) / 64.0;
    known.box.orientation = coarseQuaternion(random);
    known.box.half_extents = Vector3(half(random), half(random), half(random)) / 16.0;
    if (type == Type::kCubeList) {
      known.id = i + 1 == kBoxesPerTopic ? 0 : known.id << 32;
      known.box.orientation.setIdentity();
      known.box.half_extents = Vector3(0.25, 0.5, 0.375);
    } else if (type == Type::kPlanningScene) {  // ids are places in the object
      known.id = i + 1 == kBoxesPerTopic ? 0 : known.id / 2;
    }
    boxes.push_back(known);
  }
  return boxes;
}

}  // namespace

ros::Time timeOf(Tick tick) {
  return ros::Time(static_cast<std::uint32_t>(tick / kTicksPerSecond),
                   static_cast<std::uint32_t>(tick % kTicksPerSecond) * kTick);
}

Tick tickAt(const ros::Time& time) {
  return Tick{time.sec} * kTicksPerSecond + time.nsec / kTick;
}

Pose poseAt(const std::string& frame, Tick tick) {
  const Pose pose = poseInParent(frame, tick);
  return frame == kLidar ? composed(poseInParent(kRobot, tick), pose) : pose;
}

std::vector<geometry_msgs::TransformStamped> transformsAt(Tick tick) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const char* frame : {kRobot, kCart, kLidar}) {
    const Pose pose = poseInParent(frame, tick);
    geometry_msgs::TransformStamped& transform = transforms.emplace_back();
    transform.header.stamp = timeOf(tick);
    transform.header.frame_id = frame == kLidar ? kRobot : kFixedFrame;
    transform.child_frame_id = frame;
    transform.transform.translation = toVector3(pose.translation);
    transform.transform.rotation = toQuaternion(pose.quaternion);
  }
  return transforms;
}

const std::array<TopicOfBoxes, kTopics>& topics() {
  static const std::array<TopicOfBoxes, kTopics> all = {{
      {"/load/0", Type::kCubes, kFixedFrame},
      {"/load/1", Type::kCubes, kRobot},
      {"/load/2", Type::kCubeList, kCart},
      {"/load/3", Type::kJsk, kFixedFrame},
      {"/load/4", Type::kJsk, kRobot},
      {"/load/5", Type::kDetections, kFixedFrame},
      {"/load/6", Type::kObjects, kCart},
      {"/load/7", Type::kAutoware, kRobot},
      {"/load/8", Type::kPlanningScene, kFixedFrame},
      {"/load/9", Type::kCubes, kFixedFrame},
  }};
  return all;
}

std::vector<KnownBox> boxesAt(std::size_t topic, Tick tick) {
  static const auto resting = [] {
    std::array<std::vector<KnownBox>, kTopics> all;
    for (std::size_t each = 0; each < kTopics; ++each) {
      all[each] = restingBoxes(each);
    }
    return all;
  }();
  std::vector<KnownBox> boxes = resting.at(topic);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Tick step = tick + static_cast<Tick>(37 * i);
    boxes[i].box.center += Vector3(swing(step, 32), swing(3 * step, 48), 0.0);
  }
  return boxes;
}

std::vector<std::string> witnessNamespaces() {
  return {"witness", "9", "BARRIER"};
}

}  // namespace box_query::load
