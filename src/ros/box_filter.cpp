// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_filter.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include <ros/names.h>

namespace box_query {
namespace {

using Names = std::vector<BoxName>;

/// Sets the boxes of `snapshot` whose names are within [lowest, highest] in the order (topic, ns,
/// id), in which they are sorted.
void setRange(const Names& names, const BoxName& lowest, const BoxName& highest, bool look,
              BoxMask& mask) {
  const auto before = [](const BoxName& a, const BoxName& b) {
    return std::tie(a.topic, a.ns, a.id) < std::tie(b.topic, b.ns, b.id);
  };
  const auto begin = std::lower_bound(names.begin(), names.end(), lowest, before);
  const auto end = std::upper_bound(begin, names.end(), highest, before);
  for (auto name = begin; name != end; ++name) {
    mask.set(static_cast<std::size_t>(name - names.begin()), look);
  }
}

std::vector<std::string> topicsOf(const Names& names) {
  std::vector<std::string> topics;
  auto name = names.begin();
  while (name != names.end()) {
    topics.push_back(name->topic);
    name = std::upper_bound(
        name, names.end(), topics.back(),
        [](const std::string& topic, const BoxName& other) { return topic < other.topic; });
  }
  return topics;
}

/// Answers name topics in full; a request may name them as the node's parameter does.
std::string resolved(const std::string& topic) {
  std::string error;
  return ros::names::validate(topic, error) ? ros::names::resolve(topic) : topic;
}

}  // namespace

void check(const BoxFilter& filter) {
  const std::size_t count = filter.ignore_ids.size();
  if (filter.ignore_namespaces.size() != count) {
    throw std::invalid_argument("ignore_namespaces has " +
                                std::to_string(filter.ignore_namespaces.size()) +
                                " elements and ignore_ids " + std::to_string(count) +
                                ": name every ignored box by its namespace and its id");
  }
  if (!filter.ignore_topics.empty() && filter.ignore_topics.size() != count) {
    throw std::invalid_argument("ignore_topics has " + std::to_string(filter.ignore_topics.size()) +
                                " elements and ignore_ids " + std::to_string(count) +
                                ": leave it empty (any topic), or give one topic a box");
  }
}

std::optional<BoxMask> maskOf(const BoxFilter& filter, const Snapshot& snapshot) {
  if (filter.namespaces.empty() && filter.ignore_ids.empty()) {
    return std::nullopt;
  }
  const Names& names = snapshot.names;
  const std::vector<std::string> topics = topicsOf(names);
  BoxMask mask(names.size(), filter.namespaces.empty());
  for (const std::string& topic : topics) {
    for (const std::string& ns : filter.namespaces) {
      setRange(names, {topic, ns, std::numeric_limits<std::int64_t>::min(), ""},
               {topic, ns, std::numeric_limits<std::int64_t>::max(), ""}, true, mask);
    }
  }
  for (std::size_t i = 0; i < filter.ignore_ids.size(); ++i) {
    const auto ignore = [&](const std::string& topic) {
      const BoxName name = {topic, filter.ignore_namespaces[i], filter.ignore_ids[i], ""};
      setRange(names, name, name, false, mask);
    };
    if (filter.ignore_topics.empty()) {
      std::for_each(topics.begin(), topics.end(), ignore);
    } else {
      ignore(resolved(filter.ignore_topics[i]));
    }
  }
  return mask;
}

}  // namespace box_query
