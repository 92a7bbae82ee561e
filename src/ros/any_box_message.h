// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A message of any type, decoded straight from the wire by the source that its connection header
/// names: what the monitor subscribes to its topics with.
#pragma once

#include "ros/box_source.h"

#include <map>
#include <string>

#include <boost/shared_ptr.hpp>
#include <ros/message_traits.h>
#include <ros/serialization.h>

namespace box_query {

struct AnyBoxMessage {
  explicit AnyBoxMessage(const Limits& given = Limits()) : limits(given) {}

  Limits limits;
  /// The header of the connection that it came through.
  boost::shared_ptr<const std::map<std::string, std::string>> connection;
  const BoxSource* source = nullptr;  ///< null: its type is not understood, decoded.problem says so
  DecodedMessage decoded;
};

}  // namespace box_query

namespace ros {
namespace message_traits {

template <>
struct IsMessage<box_query::AnyBoxMessage> : TrueType {};
template <>
struct IsMessage<const box_query::AnyBoxMessage> : TrueType {};

template <>
struct MD5Sum<box_query::AnyBoxMessage> {
  static const char* value() { return "*"; }
  static const char* value(const box_query::AnyBoxMessage& /*message*/) { return "*"; }
};

template <>
struct DataType<box_query::AnyBoxMessage> {
  static const char* value() { return "*"; }
  static const char* value(const box_query::AnyBoxMessage& /*message*/) { return "*"; }
};

template <>
struct Definition<box_query::AnyBoxMessage> {
  static const char* value() { return ""; }
  static const char* value(const box_query::AnyBoxMessage& /*message*/) { return ""; }
};

}  // namespace message_traits

namespace serialization {

template <>
struct PreDeserialize<box_query::AnyBoxMessage> {
  static void notify(const PreDeserializeParams<box_query::AnyBoxMessage>& params) {
    const std::map<std::string, std::string>& header = *params.connection_header;
    const auto field = [&header](const char* name) {
      const auto found = header.find(name);
      return found == header.end() ? std::string() : found->second;
    };
    params.message->connection = params.connection_header;
    params.message->source =
        box_query::findSource(field("type"), field("md5sum"), params.message->decoded.problem);
  }
};

template <>
struct Serializer<box_query::AnyBoxMessage> {
  template <typename Stream>
  static void read(Stream& stream, box_query::AnyBoxMessage& message) {
    if (message.source) {
      message.decoded = box_query::decodeMessage(*message.source, stream.getData(),
                                                 stream.getLength(), message.limits);
    }
  }
};

}  // namespace serialization
}  // namespace ros
