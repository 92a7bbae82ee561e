// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/raw_message.h"

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

namespace box_query {

/// The messages that have come and wait to be taken in, in the order in which they came. What those
/// of one topic take is bounded: the oldest are dropped, and counted; the latest stays. roscpp's
/// own queues know no bytes, and do not say what they drop.
///
/// Any number of threads may add, one takes.
class Backlog {
 public:
  struct Message {
    std::size_t topic = 0;
    RawMessagePtr raw;
    /// Messages of its topic that came after the one that was taken before, and were dropped.
    std::size_t dropped = 0;
  };

  /// Memory of a message beside its bytes, about.
  static constexpr std::size_t kOverhead = 256;

  /// @param max_size [bytes] of the messages of each topic
  Backlog(std::size_t topics, std::size_t max_size) : max_size_(max_size), topics_(topics) {}

  void add(std::size_t topic, RawMessagePtr raw);

  /// Waits for the next message. Nothing once it is closed, even if some are left.
  std::optional<Message> take();

  void close();

 private:
  struct Entry {
    std::uint64_t number;  ///< in the order in which they came
    Message message;
  };
  struct Topic {
    std::deque<Entry> entries;
    std::size_t size = 0;  ///< [bytes] of all of them
  };

  /// The topic whose message is the oldest; null if there is none.
  Topic* oldest();
  static Message takeFirst(Topic& topic);

  const std::size_t max_size_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Topic> topics_;
  std::uint64_t added_ = 0;
  bool closed_ = false;
};

}  // namespace box_query
