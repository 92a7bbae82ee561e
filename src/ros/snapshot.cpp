// SPDX-License-Identifier: BSD-3-Clause
#include <box_query/ros/scene_monitor.h>

#include <limits>
#include <sstream>

namespace box_query {
namespace {

/// ros::Time's own difference throws where it does not fit into a ros::Duration.
double secondsBetween(const ros::Time& from, const ros::Time& to) {
  return 1e-9 * static_cast<double>(static_cast<std::int64_t>(to.toNSec()) -
                                    static_cast<std::int64_t>(from.toNSec()));
}

/// What keeps the topic from being known, as sentences; empty if nothing does.
std::string missingOf(const TopicState& topic, const ros::Time& now) {
  std::ostringstream text;
  const std::string& name = topic.parameters.topic;
  const char* separator = "";
  if (!topic.problem.empty()) {
    text << topic.problem;
    separator = " ";
  } else if (!topic.heard && topic.parameters.required) {
    text << "No boxes have come on topic " << name
         << ": start what publishes them, or correct ~box_topics.";
    separator = " ";
  }
  if (topic.isStale(now)) {
    text << separator << "Topic " << name << " is stale: its last message came "
         << secondsBetween(topic.last_message, now) << " s ago, and its timeout is "
         << topic.parameters.timeout << " s"
         << (topic.parameters.drop_stale ? ", after which its boxes are dropped" : "")
         << ": check what publishes it.";
  }
  return text.str();
}

}  // namespace

bool TopicState::isStale(const ros::Time& now) const {
  return heard && parameters.timeout > 0.0 &&
         secondsBetween(last_message, now) > parameters.timeout;
}

Completeness Snapshot::completeness(const ros::Time& now) const {
  Completeness result;
  if (now.isZero()) {  // then lifetimes never end, and nothing grows stale
    result.reason = "The ROS clock has not started: publish /clock, or unset /use_sim_time.";
  }
  for (const TopicState& topic : topics) {
    const std::string missing = missingOf(topic, now);
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
