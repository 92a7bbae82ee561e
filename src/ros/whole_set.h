// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Decoding of messages that carry the whole set of a topic's boxes.
#pragma once

#include "ros/box_source.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace box_query {

/// Appends the boxes of such a message to its changes. The class of a box is its namespace, so that
/// queries can choose by it, and its label. Boxes of one class, frame and stamp share a change:
/// most messages have few of these. Where they alternate among many, some changes have fewer boxes.
class WholeSet {
 public:
  /// Reads the array of such a message behind its header: calls read(set, n) for each element.
  /// @param least bytes of an element whose strings and arrays are empty
  template <typename Read>
  static void decode(WireReader& reader, std::size_t least, const Limits& limits,
                     const ros::Time& stamp, DecodedMessage& message, Read&& read) {
    const std::uint32_t elements = reader.count(least);
    WholeSet set(elements, limits, stamp, message);
    for (std::uint32_t n = 0; n < elements && reader.ok() && message.problem.empty(); ++n) {
      read(set, n);
    }
  }

  /// Refuses a message that has more boxes than are allowed. `stamp` is that of the message.
  WholeSet(std::uint32_t boxes, const Limits& limits, const ros::Time& stamp,
           DecodedMessage& message);

  /// Checks a box and appends it, or rejects it.
  void add(const WireHeader& header, std::string_view class_name, std::int64_t id,
           const Vector3& center, const Quaternion& orientation, const Vector3& size);
  /// The change of the boxes of a header and class, until the next call of the same.
  BoxChange& changeOf(const WireHeader& header, std::string_view class_name);
  /// The same as add() for a box that is known to be bad.
  void reject(const WireHeader& header, std::string_view class_name, std::int64_t id, Rejection why,
              const std::string& detail);

 private:
  DecodedMessage& message_;
  std::uint32_t boxes_;
  double max_coordinate_;
};

}  // namespace box_query
