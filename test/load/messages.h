// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The topics of load/world.h on the wire, and publishers of any type.
#pragma once

#include "load/world.h"

#include <cstdint>
#include <string>
#include <vector>

#include <ros/message_traits.h>
#include <ros/node_handle.h>
#include <ros/serialization.h>

namespace box_query::load {

/// Bytes of a message, or of a request or a response, of whatever type its connection is.
struct Bytes {
  std::vector<std::uint8_t> data;
};

template <class Message>
Bytes bytesOf(const Message& message) {
  Bytes bytes;
  bytes.data.resize(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data.data(),
                                     static_cast<std::uint32_t>(bytes.data.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

template <class Message>
Message messageFrom(const Bytes& bytes) {
  Message message;
  // The stream only reads.
  ros::serialization::IStream stream(const_cast<std::uint8_t*>(bytes.data.data()),
                                     static_cast<std::uint32_t>(bytes.data.size()));
  ros::serialization::deserialize(stream, message);
  return message;
}

/// What the topic sends at that time.
Bytes messageAt(std::size_t topic, Tick tick);

/// An array of markers: one list of that many cubes, far from everything else.
Bytes pileOf(std::uint32_t boxes, const ros::Time& stamp);
constexpr const char* kPileTopic = "/load/pile";

/// A publisher of Bytes on a topic of that type of boxes.
ros::Publisher advertise(ros::NodeHandle& nh, const std::string& topic, const std::string& type,
                         std::uint32_t queue_size);
/// The ROS type of a topic's messages.
const char* rosType(Type type);

}  // namespace box_query::load

namespace ros {
namespace message_traits {

template <>
struct IsMessage<box_query::load::Bytes> : TrueType {};

template <>
struct MD5Sum<box_query::load::Bytes> {
  static const char* value() { return "*"; }
  static const char* value(const box_query::load::Bytes& /*message*/) { return value(); }
};

template <>
struct DataType<box_query::load::Bytes> {
  static const char* value() { return "*"; }
  static const char* value(const box_query::load::Bytes& /*message*/) { return value(); }
};

template <>
struct Definition<box_query::load::Bytes> {
  static const char* value() { return ""; }
  static const char* value(const box_query::load::Bytes& /*message*/) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<box_query::load::Bytes> {
  template <class Stream>
  static void write(Stream& stream, const box_query::load::Bytes& bytes) {
    const auto size = static_cast<std::uint32_t>(bytes.data.size());
    std::copy_n(bytes.data.begin(), size, stream.advance(size));
  }
  template <class Stream>
  static void read(Stream& stream, box_query::load::Bytes& bytes) {
    const std::uint32_t size = stream.getLength();
    const std::uint8_t* begin = stream.advance(size);
    bytes.data.assign(begin, begin + size);
  }
  static std::uint32_t serializedLength(const box_query::load::Bytes& bytes) {
    return static_cast<std::uint32_t>(bytes.data.size());
  }
};

}  // namespace serialization
}  // namespace ros
