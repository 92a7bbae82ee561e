// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What tests of the node through its services share.
#pragma once

#include "rostest/monitor_fixture.h"
#include "unit/answer_fixture.h"

#include <string>

#include <ros/service.h>

namespace box_query::test {

/// Bytes that are sent as they are, under the checksum of CastRays.
struct RawRequest {
  std::vector<std::uint8_t> bytes;
};

}  // namespace box_query::test

template <>
struct ros::service_traits::MD5Sum<box_query::test::RawRequest> {
  static const char* value() { return ros::service_traits::md5sum<box_query::CastRays>(); }
  static const char* value(const box_query::test::RawRequest& /*request*/) { return value(); }
};

template <>
struct ros::serialization::Serializer<box_query::test::RawRequest> {
  template <class Stream>
  static void write(Stream& stream, const box_query::test::RawRequest& request) {
    const auto size = static_cast<std::uint32_t>(request.bytes.size());
    std::copy_n(request.bytes.begin(), size, stream.advance(size));
  }
  static std::uint32_t serializedLength(const box_query::test::RawRequest& request) {
    return static_cast<std::uint32_t>(request.bytes.size());
  }
};

namespace box_query::test {

/// Calls a service of the node; retries where the connection fails, as roscpp's clients do now and
/// then, and nothing else.
template <class Service>
typename Service::Response call(const std::string& service,
                                const typename Service::Request& request) {
  const std::string name = "/box_query/" + service;
  Service both;
  both.request = request;
  EXPECT_TRUE(ros::service::waitForService(name, ros::Duration(20))) << name;
  for (int attempt = 0; attempt < 5; ++attempt) {
    if (ros::service::call(name, both)) {
      return both.response;
    }
  }
  ADD_FAILURE() << "no answer from " << name;
  return {};
}

inline CastRayResponse cast(const CastRayRequest& request) {
  return call<CastRay>("cast_ray", request);
}
inline CheckSegmentResponse checkSegment(const CheckSegmentRequest& request) {
  return call<CheckSegment>("check_segment", request);
}
inline GetSceneResponse scene(std::uint64_t id = 0) {
  GetSceneRequest request;
  request.scene_id = id;
  return call<GetScene>("get_scene", request);
}

template <class Request>
Request requestIn(const std::string& frame) {
  Request request;
  request.header.frame_id = frame;
  return request;
}

inline CastRayRequest ray(const std::string& frame, const geometry_msgs::Point& origin,
                          const geometry_msgs::Vector3& direction) {
  auto request = requestIn<CastRayRequest>(frame);
  request.origin = origin;
  request.direction = direction;
  return request;
}

/// Whether the node comes to know `boxes` boxes.
inline bool nodeHas(std::size_t boxes) {
  return eventually([boxes] { return scene().poses.size() == boxes; });
}

/// 40 boxes of all orientations within 24 m, in the fixed frame.
inline visualization_msgs::MarkerArray randomBoxes(unsigned seed) {
  const Snapshot snapshot = randomSnapshot(40, seed);
  std::vector<visualization_msgs::Marker> markers;
  for (int i = 0; i < 40; ++i) {
    const OrientedBox& box = boxOf(snapshot, static_cast<std::size_t>(i));
    visualization_msgs::Marker marker = cube("map", i, 0);
    marker.ns = i % 2 == 0 ? "even" : "odd";
    marker.pose = toPose(box.center, box.orientation);
    marker.scale = toVector3(2 * box.half_extents);
    markers.push_back(marker);
  }
  return array(markers);
}

}  // namespace box_query::test
