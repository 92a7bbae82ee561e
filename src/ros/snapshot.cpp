// SPDX-License-Identifier: BSD-3-Clause
#include "ros/nanoseconds.h"

#include <box_query/ros/scene_monitor.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace box_query {
namespace {

/// ros::Time's own difference throws where it does not fit into a ros::Duration.
double secondsBetween(const ros::Time& from, const ros::Time& to) {
  return 1e-9 * static_cast<double>(nanoseconds(to) - nanoseconds(from));
}

}  // namespace

bool TopicState::isStale(const ros::Time& now) const {
  return nanoseconds(now) >= staleAt();
}

std::int64_t TopicState::staleAt() const {
  if (!heard || parameters.timeout <= 0.0) {
    return std::numeric_limits<std::int64_t>::max();
  }
  return nanoseconds(last_message) + std::llround(parameters.timeout * 1e9) + 1;
}

std::string TopicState::missing(const ros::Time& now) const {
  std::ostringstream text;
  const char* separator = "";
  if (!problem.empty()) {
    text << problem;
    separator = " ";
  } else if (!heard && parameters.required) {
    text << "No boxes have come on topic " << parameters.topic
         << ": start what publishes them, or correct ~box_topics.";
    separator = " ";
  }
  if (isStale(now)) {
    text << separator << "Topic " << parameters.topic << " is stale: its last message came "
         << secondsBetween(last_message, now) << " s ago, and its timeout is " << parameters.timeout
         << " s" << (parameters.drop_stale ? ", after which its boxes are dropped" : "")
         << ": check what publishes it.";
  }
  return text.str();
}

Completeness Snapshot::completeness(
    const ros::Time& now, const std::function<bool(const std::string& topic)>& matters) const {
  Completeness result;
  if (now.isZero()) {  // then lifetimes never end, and nothing grows stale
    result.reason = "The ROS clock has not started: publish /clock, or unset /use_sim_time.";
  } else if (clock_gone) {
    std::ostringstream text;
    text << "Nobody publishes /clock any more, and the time stands at " << now
         << ": start what publishes it.";
    result.reason = text.str();
  }
  for (const TopicState& topic : topics) {
    if (matters && !matters(topic.parameters.topic)) {
      continue;
    }
    const std::string missing = topic.missing(now);
    if (!missing.empty()) {
      result.reason += (result.reason.empty() ? "" : " ") + missing;
    }
  }
  result.complete = result.reason.empty();
  return result;
}

double Snapshot::age(const ros::Time& now) const {
  return stamp.isZero() ? std::numeric_limits<double>::infinity() : secondsBetween(stamp, now);
}

}  // namespace box_query
