// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_filter.h"

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <ros/names.h>

namespace box_query {
namespace {

using Names = std::vector<BoxName>;

BoxName lowestOf(const std::string& topic, const std::string& ns) {
  return {topic, ns, std::numeric_limits<std::int64_t>::min(), ""};
}
BoxName highestOf(const std::string& topic, const std::string& ns) {
  return {topic, ns, std::numeric_limits<std::int64_t>::max(), ""};
}

/// The names within [lowest, highest] in the order (topic, ns, id), in which they are sorted.
std::pair<Names::const_iterator, Names::const_iterator> rangeOf(const Names& names,
                                                                const BoxName& lowest,
                                                                const BoxName& highest) {
  const auto before = [](const BoxName& a, const BoxName& b) {
    return std::tie(a.topic, a.ns, a.id) < std::tie(b.topic, b.ns, b.id);
  };
  const auto begin = std::lower_bound(names.begin(), names.end(), lowest, before);
  return {begin, std::upper_bound(begin, names.end(), highest, before)};
}

void setRange(const Names& names, const BoxName& lowest, const BoxName& highest, bool look,
              BoxMask& mask) {
  const auto [begin, end] = rangeOf(names, lowest, highest);
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

std::set<std::string> namespacesOf(const Names& names) {
  std::set<std::string> namespaces;
  auto name = names.begin();
  while (name != names.end()) {
    namespaces.insert(name->ns);
    name =
        std::upper_bound(name, names.end(), *name, [](const BoxName& last, const BoxName& other) {
          return std::tie(last.topic, last.ns) < std::tie(other.topic, other.ns);
        });
  }
  return namespaces;
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

std::string unknownNamespace(const BoxFilter& filter, const Snapshot& snapshot) {
  if (filter.namespaces.empty()) {
    return "";
  }
  const std::vector<std::string> topics = topicsOf(snapshot.names);
  const auto unknown =
      std::find_if(filter.namespaces.begin(), filter.namespaces.end(), [&](const std::string& ns) {
        return std::none_of(topics.begin(), topics.end(), [&](const std::string& topic) {
          const auto range = rangeOf(snapshot.names, lowestOf(topic, ns), highestOf(topic, ns));
          return range.first != range.second;
        });
      });
  if (unknown == filter.namespaces.end()) {
    return "";
  }
  const std::set<std::string> known = namespacesOf(snapshot.names);
  constexpr std::size_t kListed = 10;
  std::string list;
  std::size_t listed = 0;
  for (auto ns = known.begin(); ns != known.end() && listed < kListed; ++ns, ++listed) {
    list += (listed > 0 ? ", '" : "'") + *ns + "'";
  }
  if (known.size() > listed) {
    list += " and " + std::to_string(known.size() - listed) + " more";
  }
  return "No box has the namespace '" + *unknown + "': " +
         (known.empty()
              ? "there are no boxes."
              : "there are " + list + ". Correct it, unless none is meant to be there now.");
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
      setRange(names, lowestOf(topic, ns), highestOf(topic, ns), true, mask);
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
