// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A message of any type as it came, with what its connection header says of it: what the monitor
/// subscribes to its topics with.
#pragma once

#include "ros/box_source.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string>

#include <boost/shared_ptr.hpp>
#include <ros/message_traits.h>
#include <ros/serialization.h>

namespace box_query {

struct RawMessage {
  /// The header of the connection that it came through.
  boost::shared_ptr<const std::map<std::string, std::string>> connection;
  const BoxSource* source = nullptr;  ///< null: its type is not understood, `problem` says so
  std::string problem;
  /// None where its type is not understood. Shared, since roscpp wants messages that can be copied.
  std::shared_ptr<const std::uint8_t[]> bytes;
  std::size_t size = 0;
};

using RawMessagePtr = boost::shared_ptr<const RawMessage>;

}  // namespace box_query

namespace ros {
namespace message_traits {

template <>
struct IsMessage<box_query::RawMessage> : TrueType {};
template <>
struct IsMessage<const box_query::RawMessage> : TrueType {};

template <>
struct MD5Sum<box_query::RawMessage> {
  static const char* value() { return "*"; }
  static const char* value(const box_query::RawMessage& /*message*/) { return "*"; }
};

template <>
struct DataType<box_query::RawMessage> {
  static const char* value() { return "*"; }
  static const char* value(const box_query::RawMessage& /*message*/) { return "*"; }
};

template <>
struct Definition<box_query::RawMessage> {
  static const char* value() { return ""; }
  static const char* value(const box_query::RawMessage& /*message*/) { return ""; }
};

}  // namespace message_traits

namespace serialization {

template <>
struct PreDeserialize<box_query::RawMessage> {
  static void notify(const PreDeserializeParams<box_query::RawMessage>& params) {
    const std::map<std::string, std::string>& header = *params.connection_header;
    const auto field = [&header](const char* name) {
      const auto found = header.find(name);
      return found == header.end() ? std::string() : found->second;
    };
    params.message->connection = params.connection_header;
    params.message->source =
        box_query::findSource(field("type"), field("md5sum"), params.message->problem);
  }
};

template <>
struct Serializer<box_query::RawMessage> {
  template <typename Stream>
  static void read(Stream& stream, box_query::RawMessage& message) {
    if (message.source) {
      message.size = stream.getLength();
      const std::shared_ptr<std::uint8_t[]> bytes(new std::uint8_t[message.size]);
      std::copy_n(stream.getData(), message.size, bytes.get());
      message.bytes = bytes;
    }
  }
};

}  // namespace serialization
}  // namespace ros
