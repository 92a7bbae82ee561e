// SPDX-License-Identifier: BSD-3-Clause
#include "ros/diagnostics.h"

#include <algorithm>
#include <chrono>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <diagnostic_msgs/DiagnosticStatus.h>

namespace box_query {
namespace {

constexpr std::chrono::seconds kPeriod(1);

/// OK, or WARN with what is missing.
void summarize(const std::string& missing, diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (missing.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "complete");
  } else {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, missing);
  }
}

std::size_t boxesOf(const Snapshot& snapshot, const std::string& topic) {
  struct Before {
    bool operator()(const BoxName& a, const std::string& b) const { return a.topic < b; }
    bool operator()(const std::string& a, const BoxName& b) const { return a < b.topic; }
  };
  const auto range =
      std::equal_range(snapshot.names.begin(), snapshot.names.end(), topic, Before());
  return static_cast<std::size_t>(range.second - range.first);
}

}  // namespace

Diagnostics::Diagnostics(ros::NodeHandle& private_nh, SceneMonitor& monitor, const Server& server)
    : monitor_(monitor),
      server_(server),
      subscribers_(private_nh.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1)),
      updater_(private_nh, private_nh, private_nh.getNamespace()),
      time_(Bell::Clock::now()) {
  updater_.setHardwareID("none");
  updater_.add("scene", [this](Status& status) { describeScene(status); });
  const SnapshotPtr scene = monitor.watchedScene();
  for (std::size_t topic = 0; topic < scene->topics.size(); ++topic) {
    updater_.add("topic " + scene->topics[topic].parameters.topic,
                 [this, topic](Status& status) { describeTopic(topic, status); });
  }
  updater_.add("work", [this](Status& status) { describeWork(status); });
  thread_ = std::thread([this] { run(); });
}

Diagnostics::~Diagnostics() {
  stopping_ = true;
  bell_.ring();
  thread_.join();
}

void Diagnostics::run() {
  while (!stopping_) {
    if (subscribers_.getNumSubscribers() > 0) {
      look();
      updater_.force_update();
    }
    bell_.waitPast(0, Bell::Clock::now() + kPeriod);
  }
}

void Diagnostics::look() {
  const Bell::Clock::time_point time = Bell::Clock::now();
  interval_ = std::chrono::duration<double>(time - time_).count();
  time_ = time;
  scene_ = monitor_.watchedScene();
  statistics_ = monitor_.statistics();
  now_ = ros::Time::now();
}

double Diagnostics::rate(const std::string& what, std::uint64_t count) {
  std::uint64_t& before = counts_[what];
  const auto difference = static_cast<double>(count - before);
  before = count;
  return interval_ > 0.0 ? difference / interval_ : 0.0;
}

void Diagnostics::describeScene(Status& status) const {
  summarize(scene_->completeness(now_).reason, status);
  std::size_t waiting = 0;
  for (const TopicState& topic : scene_->topics) {
    waiting += topic.waiting;
  }
  status.add("frame", scene_->frame);
  status.add("scene id", scene_->id);
  status.add("boxes", scene_->scene.size());
  status.add("age [s]", scene_->age(now_));
  status.add("boxes that wait for their transform", waiting);
}

void Diagnostics::describeTopic(std::size_t index, Status& status) {
  const TopicState& topic = scene_->topics[index];
  const std::string& name = topic.parameters.topic;
  summarize(topic.missing(now_), status);
  status.add("messages [1/s]", rate(name, topic.messages));
  if (topic.heard) {
    status.add("age of its last message [s]", (now_ - topic.last_message).toSec());
  }
  status.add("boxes", boxesOf(*scene_, name));
  status.add("boxes that wait for their transform", topic.waiting);
  status.add("boxes of its last word that were rejected", topic.rejected);
}

/// Counts since start, and what was not needed and so not done.
void Diagnostics::describeWork(Status& status) {
  const MonitorStatistics& counts = statistics_;
  const RequestCounts requests = server_.counts();
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "counts since start");
  status.add("requests answered [1/s]", rate("answered", requests.answered));
  status.add("boxes received [1/s]", rate("received", counts.boxes));
  status.add("requests answered", requests.answered);
  status.add("requests refused", requests.refused);
  status.add("messages", counts.messages);
  status.add("messages refused: malformed or too large", counts.malformed_messages);
  status.add("messages refused: unknown type", counts.unknown_type_messages);
  status.add("messages dropped: too many waited", counts.dropped_messages);
  status.add("boxes received", counts.boxes);
  for (const auto& [reason, boxes] : counts.rejections) {
    status.add("boxes rejected: " + reason, boxes);
  }
  status.add("boxes given up: no transform", counts.given_up_boxes);
  status.add("boxes given up: too many waited", counts.overflowed_boxes);
  status.add("boxes expired", counts.expired_boxes);
  status.add("boxes dropped: stale topic", counts.dropped_boxes);
  status.add("markers ignored: no box", counts.ignored_markers);
  status.add("scenes built", counts.builds);
  status.add("scenes refitted of these", counts.refits);
  status.add("scenes not built", counts.avoided_builds);
  status.add("boxes not transformed", counts.avoided_transforms);
  const QueryCounters queries = server_.queryCounts();
  status.add("bounds compared in float, by sixteen", queries.nodes);
  status.add("boxes compared in double", queries.boxes);
  status.add("boxes rotated for, of these", queries.turned_boxes);
  status.add("decisions that double left open", queries.certified_decisions);
  status.add("decisions made exactly", queries.exact_decisions);
  status.add("numbers rounded exactly", queries.exact_roundings);
}

}  // namespace box_query
