// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_filter.h"

#include "ros/name_order.h"

#include <iterator>
#include <set>
#include <stdexcept>
#include <string_view>

#include <ros/names.h>

namespace box_query {
namespace {

using Names = std::vector<BoxName>;
using Strings = std::vector<std::string>;

std::string lengthsOf(const char* first, std::size_t first_length, const char* second,
                      std::size_t second_length) {
  return std::string(first) + " has " + std::to_string(first_length) + " elements and " + second +
         " " + std::to_string(second_length) + ": ";
}

/// Answers name topics in full; a request may name them as the node's parameter does.
std::string resolved(const std::string& topic) {
  std::string error;
  return ros::names::validate(topic, error) ? ros::names::resolve(topic) : topic;
}

/// Each box once, however often the ranges name it.
void setRanges(std::vector<IndexRange>&& ranges, bool look, BoxMask& mask) {
  std::sort(ranges.begin(), ranges.end(),
            [](const IndexRange& a, const IndexRange& b) { return a.begin < b.begin; });
  std::size_t next = 0;
  for (const IndexRange& range : ranges) {
    for (next = std::max(next, range.begin); next < range.end; ++next) {
      mask.set(next, look);
    }
  }
}

/// A hash table would take several times as long for many names.
std::vector<std::string_view> sorted(const Strings& names) {
  std::vector<std::string_view> views(names.begin(), names.end());
  std::sort(views.begin(), views.end());
  return views;
}

/// The topics of the snapshot that are chosen, each once.
Strings chosenTopics(const BoxFilter& filter, const Strings& topics) {
  if (filter.topics.empty()) {
    return topics;
  }
  std::set<std::string> wanted;
  for (const std::string& topic : filter.topics) {
    wanted.insert(resolved(topic));
  }
  Strings chosen;
  std::copy_if(topics.begin(), topics.end(), std::back_inserter(chosen),
               [&wanted](const std::string& topic) { return wanted.count(topic) > 0; });
  return chosen;
}

/// Of the chosen topics and namespaces.
BoxMask chosen(const BoxFilter& filter, const Names& names, const Strings& topics) {
  if (filter.topics.empty() && filter.namespaces.empty()) {
    return BoxMask(names.size());
  }
  BoxMask mask(names.size(), false);
  std::vector<IndexRange> ranges;
  for (const std::string& topic : chosenTopics(filter, topics)) {
    if (filter.namespaces.empty()) {
      ranges.push_back(rangeOf(names, {topic}));
    }
    for (const std::string& ns : filter.namespaces) {
      ranges.push_back(rangeOf(names, {topic, &ns}));
    }
  }
  setRanges(std::move(ranges), true, mask);
  return mask;
}

void dropOtherLabels(const Strings& labels, const Names& names, BoxMask& mask) {
  const std::vector<std::string_view> wanted = sorted(labels);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (mask[i] && !std::binary_search(wanted.begin(), wanted.end(), names[i].label)) {
      mask.set(i, false);
    }
  }
}

/// Calls visit(range) for the boxes of ignored name `i`, once a topic. @return whether there are
/// any
template <class Visit>
bool visitIgnored(const BoxFilter& filter, std::size_t i, const Names& names, const Strings& topics,
                  Visit&& visit) {
  bool any = false;
  const auto visitIn = [&](const std::string& topic) {
    const IndexRange range = rangeOf(
        names, {topic, filter.ignore_namespaces.empty() ? nullptr : &filter.ignore_namespaces[i],
                filter.ignore_ids.empty() ? nullptr : &filter.ignore_ids[i]});
    any = any || range.begin != range.end;
    visit(range);
  };
  if (filter.ignore_topics.empty()) {
    std::for_each(topics.begin(), topics.end(), visitIn);
  } else {
    visitIn(resolved(filter.ignore_topics[i]));
  }
  return any;
}

/// Whether a box of that topic can pass.
bool mayPass(const BoxFilter& filter, const std::string& topic) {
  const auto isMeant = [&topic](const std::string& name) { return resolved(name) == topic; };
  const bool all_ignored =
      filter.ignore_namespaces.empty() &&
      std::any_of(filter.ignore_topics.begin(), filter.ignore_topics.end(), isMeant);
  return !all_ignored && (filter.topics.empty() ||
                          std::any_of(filter.topics.begin(), filter.topics.end(), isMeant));
}

/// The first few of some names, each once.
class Listing {
 public:
  void add(const std::string& name) {
    if (names_.size() <= kListed || name < *names_.rbegin()) {
      names_.insert(name);
    }
    if (names_.size() > kListed + 1) {
      names_.erase(std::prev(names_.end()));
    }
  }
  std::string text() const {
    std::string text = names_.empty() ? " no boxes" : "";
    std::size_t listed = 0;
    for (auto name = names_.begin(); name != names_.end() && listed < kListed; ++name, ++listed) {
      text += (listed > 0 ? ", '" : " '") + std::string(*name) + "'";
    }
    return text + (names_.size() > kListed ? " and more" : "");
  }
  bool empty() const { return names_.empty(); }

 private:
  static constexpr std::size_t kListed = 10;
  std::set<std::string_view> names_;  // one more than are listed, at most
};

std::string noBoxHas(const char* what, const std::string& name, const Listing& known) {
  return std::string("No box has the ") + what + " '" + name + "': there are" + known.text() +
         (known.empty() ? "." : ". Correct it, unless none is meant to be there now.");
}

std::string unknownTopic(const BoxFilter& filter, const Snapshot& snapshot) {
  Listing known;
  std::set<std::string_view> topics;
  for (const TopicState& topic : snapshot.topics) {
    topics.insert(topic.parameters.topic);
    known.add(topic.parameters.topic);
  }
  for (const std::string& topic : filter.topics) {
    if (topics.count(resolved(topic)) == 0) {
      return "The node does not listen to the topic '" + topic + "': there are" + known.text() +
             ". Correct it.";
    }
  }
  return "";
}

std::string unknownNamespace(const BoxFilter& filter, const Names& names, const Strings& topics) {
  const auto unknown =
      std::find_if(filter.namespaces.begin(), filter.namespaces.end(), [&](const std::string& ns) {
        return std::none_of(topics.begin(), topics.end(), [&](const std::string& topic) {
          const IndexRange range = rangeOf(names, {topic, &ns});
          return range.begin != range.end;
        });
      });
  if (unknown == filter.namespaces.end()) {
    return "";
  }
  Listing known;
  for (std::size_t i = 0; i < names.size();
       i = rangeOf(names, {names[i].topic, &names[i].ns}).end) {
    known.add(names[i].ns);
  }
  return noBoxHas("namespace", *unknown, known);
}

std::string unknownLabel(const BoxFilter& filter, const Names& names) {
  const std::vector<std::string_view> labels = sorted(filter.labels);
  std::vector<bool> seen(labels.size());
  const auto placeOf = [&labels](const std::string& label) {
    return static_cast<std::size_t>(std::lower_bound(labels.begin(), labels.end(), label) -
                                    labels.begin());
  };
  for (const BoxName& name : names) {
    const std::size_t place = placeOf(name.label);
    if (place < labels.size() && labels[place] == name.label) {
      seen[place] = true;
    }
  }
  const auto unknown =
      std::find_if(filter.labels.begin(), filter.labels.end(),
                   [&](const std::string& label) { return !seen[placeOf(label)]; });
  if (unknown == filter.labels.end()) {
    return "";
  }
  Listing known;
  for (const BoxName& name : names) {
    known.add(name.label);
  }
  return noBoxHas("label", *unknown, known);
}

std::string unknownIgnored(const BoxFilter& filter, const Names& names, const Strings& topics) {
  const auto nothing = [](const IndexRange&) {};
  std::size_t i = 0;
  while (i < filter.ignored() && visitIgnored(filter, i, names, topics, nothing)) {
    ++i;
  }
  if (i == filter.ignored()) {
    return "";
  }
  std::string name;
  const auto append = [&name](const char* what, const std::string& value) {
    name += (name.empty() ? "" : ", ") + std::string(what) + " " + value;
  };
  if (!filter.ignore_topics.empty()) {
    append("topic", "'" + filter.ignore_topics[i] + "'");
  }
  if (!filter.ignore_namespaces.empty()) {
    append("namespace", "'" + filter.ignore_namespaces[i] + "'");
  }
  if (!filter.ignore_ids.empty()) {
    append("id", std::to_string(filter.ignore_ids[i]));
  }
  return "There is no box to ignore of " + name + ".";
}

void checkCount(const char* array, std::size_t count, const Limits& limits) {
  if (count > limits.names) {
    throw std::invalid_argument(std::string(array) + " has " + std::to_string(count) +
                                " elements, at most " + std::to_string(limits.names) +
                                " are taken: split the request, or raise ~max_filter_names");
  }
}

void checkNames(const char* array, const Strings& names, const Limits& limits) {
  checkCount(array, names.size(), limits);
  const auto found = std::find_if(names.begin(), names.end(), [&limits](const std::string& name) {
    return name.size() > limits.name_length;
  });
  if (found != names.end()) {
    throw std::invalid_argument(std::string(array) + "[" + std::to_string(found - names.begin()) +
                                "] has " + std::to_string(found->size()) +
                                " bytes: no name has "
                                "more than ~max_name_length, " +
                                std::to_string(limits.name_length));
  }
}

}  // namespace

void check(const BoxFilter& filter, const Limits& limits) {
  checkNames("topics", filter.topics, limits);
  checkNames("namespaces", filter.namespaces, limits);
  checkNames("labels", filter.labels, limits);
  checkNames("ignore_topics", filter.ignore_topics, limits);
  checkNames("ignore_namespaces", filter.ignore_namespaces, limits);
  checkCount("ignore_ids", filter.ignore_ids.size(), limits);
  const std::size_t topics = filter.ignore_topics.size();
  const std::size_t namespaces = filter.ignore_namespaces.size();
  const std::size_t ids = filter.ignore_ids.size();
  if (ids != 0 && namespaces != ids) {
    throw std::invalid_argument(lengthsOf("ignore_namespaces", namespaces, "ignore_ids", ids) +
                                "name every ignored box by its namespace and its id");
  }
  if (topics != 0 && namespaces != 0 && topics != namespaces) {
    throw std::invalid_argument(
        lengthsOf("ignore_topics", topics, "ignore_namespaces", namespaces) +
        "leave it empty (any topic), or give one topic a namespace");
  }
}

std::optional<BoxMask> maskOf(const BoxFilter& filter, const Snapshot& snapshot) {
  if (!filter.filters()) {
    return std::nullopt;
  }
  const Strings topics = topicsOf(snapshot.names);
  BoxMask mask = chosen(filter, snapshot.names, topics);
  if (!filter.labels.empty()) {
    dropOtherLabels(filter.labels, snapshot.names, mask);
  }
  std::vector<IndexRange> ignored;
  for (std::size_t i = 0; i < filter.ignored(); ++i) {
    visitIgnored(filter, i, snapshot.names, topics,
                 [&ignored](const IndexRange& range) { ignored.push_back(range); });
  }
  setRanges(std::move(ignored), false, mask);
  return mask;
}

Completeness completenessOf(const BoxFilter& filter, const Snapshot& snapshot,
                            const ros::Time& now) {
  if (!filter.filters()) {
    return snapshot.completeness(now);
  }
  Completeness result = snapshot.completeness(
      now, [&filter](const std::string& topic) { return mayPass(filter, topic); });
  const std::string unknown = unknownTopic(filter, snapshot);
  if (!unknown.empty()) {
    result.complete = false;
    result.reason += (result.reason.empty() ? "" : " ") + unknown;
  }
  return result;
}

std::string unknownNames(const BoxFilter& filter, const Snapshot& snapshot) {
  if (!filter.filters()) {
    return "";
  }
  const Names& names = snapshot.names;
  const Strings topics = topicsOf(names);
  std::string text;
  for (const std::string& sentence :
       {unknownTopic(filter, snapshot), unknownNamespace(filter, names, topics),
        unknownLabel(filter, names), unknownIgnored(filter, names, topics)}) {
    text += (text.empty() || sentence.empty() ? "" : " ") + sentence;
  }
  return text;
}

}  // namespace box_query
