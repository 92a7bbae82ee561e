// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Whether queries wait for messages, and messages for queries.
#pragma once

#include <cstddef>
#include <cstdint>

namespace box_query::load {

/// One client asks for a ray while a message of many boxes is taken in, and while it is taken back.
struct QueriesBesideMessage {
  double quiet_ms = 0.0;     ///< the longest query before
  double longest_ms = 0.0;   ///< the longest one meanwhile
  double taken_in_ms = 0.0;  ///< from publication to the first answer that knows the boxes
  std::size_t queries = 0;   ///< meanwhile

  double share() const { return longest_ms / taken_in_ms; }
};
QueriesBesideMessage askBesideMessage(std::uint32_t boxes);

/// One client asks for a ray, and looks how old the scene is, while another asks for many.
struct MessagesBesideBatch {
  double quiet_ms = 0.0;   ///< the oldest scene before
  double oldest_ms = 0.0;  ///< the oldest scene meanwhile
  double batch_ms = 0.0;   ///< that the batch took
  std::size_t queries = 0;

  double share() const { return oldest_ms / batch_ms; }
};
MessagesBesideBatch askBesideBatch(std::uint32_t rays);

}  // namespace box_query::load
