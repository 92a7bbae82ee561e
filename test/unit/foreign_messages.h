// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Messages of packages that Debian does not have, as gencpp makes them of their definitions.
/// That these are the public ones is proved elsewhere, by the checksums of genpy.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Vector3.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>

/// A serialiser that roscpp uses for the fields named, in their order.
#define BQ_SERIALIZED(Type, ...)                                                    \
  namespace ros::serialization {                                                    \
  template <>                                                                       \
  struct Serializer<box_query::test::Type> {                                        \
    template <typename Stream, typename T>                                          \
    static void allInOne(Stream& stream, T message) {                               \
      auto& m = message;                                                            \
      const auto next = [&stream](auto&... fields) { (stream.next(fields), ...); }; \
      next(__VA_ARGS__);                                                            \
    }                                                                               \
    ROS_DECLARE_ALLINONE_SERIALIZER                                                 \
  };                                                                                \
  }

namespace box_query::test {

struct JskBoundingBox {
  std_msgs::Header header;
  geometry_msgs::Pose pose;
  geometry_msgs::Vector3 dimensions;
  float value = 0;
  std::uint32_t label = 0;
};

struct JskBoundingBoxArray {
  std_msgs::Header header;
  std::vector<JskBoundingBox> boxes;
};

}  // namespace box_query::test

BQ_SERIALIZED(JskBoundingBox, m.header, m.pose, m.dimensions, m.value, m.label)
BQ_SERIALIZED(JskBoundingBoxArray, m.header, m.boxes)
