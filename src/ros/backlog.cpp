// SPDX-License-Identifier: BSD-3-Clause
#include "ros/backlog.h"

#include <utility>

namespace box_query {

void Backlog::add(std::size_t topic_index, RawMessagePtr raw) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Topic& topic = topics_.at(topic_index);
    topic.size += raw->size + kOverhead;
    topic.entries.push_back({added_++, {topic_index, std::move(raw), 0}});
    while (topic.size > max_size_ && topic.entries.size() > 1) {
      const std::size_t dropped = takeFirst(topic).dropped + 1;
      topic.entries.front().message.dropped += dropped;
    }
  }
  changed_.notify_one();
}

std::optional<Backlog::Message> Backlog::take() {
  std::unique_lock<std::mutex> lock(mutex_);
  Topic* topic = nullptr;
  changed_.wait(lock, [&] {
    topic = oldest();
    return closed_ || topic != nullptr;
  });
  return closed_ ? std::nullopt : std::make_optional(takeFirst(*topic));
}

void Backlog::close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
  }
  changed_.notify_one();
}

Backlog::Topic* Backlog::oldest() {
  Topic* oldest = nullptr;
  for (Topic& topic : topics_) {
    if (!topic.entries.empty() &&
        (!oldest || topic.entries.front().number < oldest->entries.front().number)) {
      oldest = &topic;
    }
  }
  return oldest;
}

Backlog::Message Backlog::takeFirst(Topic& topic) {
  Message message = std::move(topic.entries.front().message);
  topic.entries.pop_front();
  topic.size -= message.raw->size + kOverhead;
  return message;
}

}  // namespace box_query
