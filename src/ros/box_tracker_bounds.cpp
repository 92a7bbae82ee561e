// SPDX-License-Identifier: BSD-3-Clause
// What is too much of a topic: what it has, and what of it waits to be taken in.
#include "ros/box_tracker.h"

#include <algorithm>
#include <numeric>
#include <string_view>

namespace box_query {
namespace {

/// What a whole set counts for, as BoxStore has it.
std::size_t sizeOf(const BoxChanges& changes) {
  return std::accumulate(changes.begin(), changes.end(), std::size_t{0},
                         [](std::size_t size, const BoxChange& change) {
                           return size + std::max<std::size_t>(1, change.boxes.size());
                         });
}

std::size_t countNamespaces(const BoxChanges& changes) {
  std::set<std::string_view> names;
  for (const BoxChange& change : changes) {
    names.insert(change.ns);
  }
  return names.size();
}

}  // namespace

void BoxTracker::lose(std::size_t topic, std::size_t messages, const ros::Time& now) {
  if (messages == 0) {
    return;
  }
  ++changes_;
  counts_.dropped_messages += messages;
  dropIfStale(topic, now);  // of before
  topics_.at(topic).lost_word = store_.countWord();
  topics_[topic].lost = "Messages on topic " + parameters_.box_topics[topic].topic +
                        " were dropped: they came faster than they could be taken in; publish "
                        "less, or raise ~max_backlog_memory, and delete all of the topic.";
}

/// Of a whole set: a sentence, or empty.
std::string BoxTracker::tooMuch(const BoxChanges& changes) const {
  const auto max_boxes = static_cast<std::size_t>(parameters_.max_boxes_per_topic);
  const auto max_namespaces = static_cast<std::size_t>(parameters_.max_namespaces);
  if (sizeOf(changes) <= max_boxes &&
      (changes.size() <= max_namespaces || countNamespaces(changes) <= max_namespaces)) {
    return "";
  }
  return "it has more than " + mostOfTopic();
}

std::string BoxTracker::mostOfTopic() const {
  return std::to_string(parameters_.max_boxes_per_topic) + " boxes or " +
         std::to_string(parameters_.max_namespaces) +
         " namespaces; publish fewer, or raise ~max_boxes_per_topic or ~max_namespaces";
}

}  // namespace box_query
