// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A snapshot made by hand, and answers from it without a master.
#pragma once

#include "ros/answers.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <ros/serialization.h>

namespace box_query::test {

inline geometry_msgs::Point point(double x, double y, double z) {
  return toPoint({x, y, z});
}
inline geometry_msgs::Vector3 vector(double x, double y, double z) {
  return toVector3({x, y, z});
}

/// The bytes of a message: equal for equal answers, NaN included.
template <class Message>
std::vector<std::uint8_t> bytesOf(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

inline OrientedBox cubeAt(double x, double y, double z, double half) {
  return {{x, y, z}, Quaternion::Identity(), {half, half, half}};
}

/// A complete snapshot of topics /a and /b: cubes of half extent 0.5 along the x axis at 2 (topic
/// /a, ns rack, id 1), 4 (/a, rack, 2), 6 (/a, robot, -1) and 8 (/b, rack, 1).
inline Snapshot smallSnapshot() {
  Snapshot snapshot;
  snapshot.id = 7;
  snapshot.stamp = ros::Time(100);
  snapshot.frame = "map";
  snapshot.scene = Scene(
      {cubeAt(2, 0, 0, 0.5), cubeAt(4, 0, 0, 0.5), cubeAt(6, 0, 0, 0.5), cubeAt(8, 0, 0, 0.5)});
  snapshot.names = {{"/a", "rack", 1, "first"},
                    {"/a", "rack", 2, ""},
                    {"/a", "robot", -1, ""},
                    {"/b", "rack", 1, "other"}};
  snapshot.stamps.assign(4, ros::Time(100));
  for (const char* topic : {"/a", "/b"}) {
    TopicState state;
    state.parameters.topic = topic;
    state.heard = true;
    state.last_message = ros::Time(100);
    snapshot.topics.push_back(state);
  }
  return snapshot;
}

/// `count` boxes of all orientations within 20 m.
inline Snapshot randomSnapshot(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> position(-10, 10);
  std::uniform_real_distribution<double> half(0, 3);
  std::normal_distribution<double> normal;
  Snapshot snapshot = smallSnapshot();
  snapshot.names.clear();
  std::vector<Box> boxes;
  for (int i = 0; i < count; ++i) {
    boxes.emplace_back(OrientedBox{
        {position(random), position(random), position(random)},
        Quaternion(normal(random), normal(random), normal(random), normal(random)).normalized(),
        {half(random), half(random), half(random)}});
    snapshot.names.push_back({"/a", "", i, "box " + std::to_string(i)});
  }
  snapshot.scene = Scene(std::move(boxes));
  snapshot.stamps.assign(snapshot.names.size(), ros::Time(100));
  return snapshot;
}

/// A quarter turn about z and a shift, both exact: (x, y, z) in map is (y - 20, 10 - x, z) there.
inline FrameChange quarterTurn() {
  geometry_msgs::Transform pose;
  pose.translation = vector(10, 20, 0);
  pose.rotation.w = pose.rotation.z = std::sqrt(0.5);
  return FrameChange(pose);
}

/// A frame in which nothing stays round.
inline FrameChange crookedFrame() {
  geometry_msgs::Transform pose;
  pose.translation = vector(0.3, -1.7, 2.9);
  pose.rotation.w = 0.5;
  pose.rotation.x = 0.1;
  pose.rotation.y = -0.7;
  pose.rotation.z = 0.5;
  return FrameChange(pose);
}

template <class Request>
struct ResponseTo;
template <>
struct ResponseTo<CastRayRequest> {
  using type = CastRayResponse;
};
template <>
struct ResponseTo<CastRaysRequest> {
  using type = CastRaysResponse;
};
template <>
struct ResponseTo<CheckSegmentRequest> {
  using type = CheckSegmentResponse;
};
template <>
struct ResponseTo<CheckSegmentsRequest> {
  using type = CheckSegmentsResponse;
};
template <>
struct ResponseTo<FindIntersectionsRequest> {
  using type = FindIntersectionsResponse;
};

template <class Request>
auto ask(Request request, const Snapshot& snapshot, const FrameChange& frame = FrameChange(),
         int batch_threads = 1) {
  request.header.frame_id = frame.same() ? snapshot.frame : "other";
  Limits limits;
  limits.coordinate = std::numeric_limits<double>::max();  // what answer() promises by itself
  check(request, limits);
  Context context = {snapshot, ros::Time(101), frame, Drawing(), batch_threads};
  typename ResponseTo<Request>::type response;
  answer(request, context, response);
  return response;
}

/// The sentence with which a request is refused; empty if it is not.
template <class Request>
std::string refusal(Request request, std::size_t max_queries = 1000) {
  Limits limits;
  limits.queries = max_queries;
  try {
    check(request, limits);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace box_query::test
