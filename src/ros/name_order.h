// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Boxes of a snapshot by name. They are in the order of (topic, ns, id), so that those of a topic,
/// of a namespace in it, and of an id in that follow each other.
#pragma once

#include <box_query/ros/scene_monitor.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace box_query {

/// The beginning of a name: null stands for any.
struct NamePrefix {
  const std::string& topic;
  const std::string* ns = nullptr;
  const std::int64_t* id = nullptr;  ///< null without ns
};

/// Orders names by as much as the prefix says.
struct ByPrefix {
  /// Negative, 0 or positive, as std::string::compare().
  static int compare(const BoxName& name, const NamePrefix& prefix) {
    int order = name.topic.compare(prefix.topic);
    if (order == 0 && prefix.ns != nullptr) {
      order = name.ns.compare(*prefix.ns);
    }
    if (order == 0 && prefix.id != nullptr && name.id != *prefix.id) {
      order = name.id < *prefix.id ? -1 : 1;
    }
    return order;
  }
  bool operator()(const BoxName& name, const NamePrefix& prefix) const {
    return compare(name, prefix) < 0;
  }
  bool operator()(const NamePrefix& prefix, const BoxName& name) const {
    return compare(name, prefix) > 0;
  }
};

/// Indices of the boxes whose names begin so.
struct IndexRange {
  std::size_t begin;
  std::size_t end;
};
inline IndexRange rangeOf(const std::vector<BoxName>& names, const NamePrefix& prefix) {
  const auto range = std::equal_range(names.begin(), names.end(), prefix, ByPrefix());
  return {static_cast<std::size_t>(range.first - names.begin()),
          static_cast<std::size_t>(range.second - names.begin())};
}

/// Of each name its place among those of another snapshot, or kNoBox: see Scene::updated().
inline std::vector<std::size_t> placesOf(const std::vector<BoxName>& names,
                                         const std::vector<BoxName>& others) {
  std::vector<std::size_t> places(names.size(), kNoBox);
  std::size_t other = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const NamePrefix whole{names[i].topic, &names[i].ns, &names[i].id};
    int order = -1;
    while (other < others.size() && (order = ByPrefix::compare(others[other], whole)) < 0) {
      ++other;
    }
    if (other < others.size() && order == 0) {
      places[i] = other++;
    }
  }
  return places;
}

/// The topics of the boxes, each once.
inline std::vector<std::string> topicsOf(const std::vector<BoxName>& names) {
  std::vector<std::string> topics;
  for (std::size_t i = 0; i < names.size(); i = rangeOf(names, {topics.back()}).end) {
    topics.push_back(names[i].topic);
  }
  return topics;
}

}  // namespace box_query
