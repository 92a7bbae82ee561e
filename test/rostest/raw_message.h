// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Bytes that claim to be a MarkerArray.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <visualization_msgs/MarkerArray.h>

namespace box_query {

struct RawMarkerArray {
  std::vector<std::uint8_t> bytes;

  static RawMarkerArray of(const visualization_msgs::MarkerArray& message) {
    namespace ser = ros::serialization;
    RawMarkerArray raw;
    raw.bytes.resize(ser::serializationLength(message));
    ser::OStream stream(raw.bytes.data(), static_cast<std::uint32_t>(raw.bytes.size()));
    ser::serialize(stream, message);
    return raw;
  }
};

}  // namespace box_query

namespace ros {
namespace message_traits {

template <>
struct IsMessage<box_query::RawMarkerArray> : TrueType {};

template <>
struct MD5Sum<box_query::RawMarkerArray> {
  static const char* value() { return MD5Sum<visualization_msgs::MarkerArray>::value(); }
  static const char* value(const box_query::RawMarkerArray& /*message*/) { return value(); }
};

template <>
struct DataType<box_query::RawMarkerArray> {
  static const char* value() { return DataType<visualization_msgs::MarkerArray>::value(); }
  static const char* value(const box_query::RawMarkerArray& /*message*/) { return value(); }
};

template <>
struct Definition<box_query::RawMarkerArray> {
  static const char* value() { return Definition<visualization_msgs::MarkerArray>::value(); }
  static const char* value(const box_query::RawMarkerArray& /*message*/) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<box_query::RawMarkerArray> {
  template <typename Stream>
  static void write(Stream& stream, const box_query::RawMarkerArray& message) {
    if (!message.bytes.empty()) {
      std::memcpy(stream.advance(serializedLength(message)), message.bytes.data(),
                  message.bytes.size());
    }
  }
  static std::uint32_t serializedLength(const box_query::RawMarkerArray& message) {
    return static_cast<std::uint32_t>(message.bytes.size());
  }
};

}  // namespace serialization
}  // namespace ros
