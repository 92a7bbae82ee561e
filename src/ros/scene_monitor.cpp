// SPDX-License-Identifier: BSD-3-Clause
// The walk: box message -> source -> store -> placement (BoxTracker) -> new Scene -> one pointer
// swapped (SceneBuilder). Here is what the threads do that hear boxes and tf, and the worker that
// places what waited and builds ahead.
#include "ros/bell.h"
#include "ros/box_topics.h"
#include "ros/box_tracker.h"
#include "ros/history.h"
#include "ros/nanoseconds.h"
#include "ros/publisher_watch.h"
#include "ros/registration.h"
#include "ros/scene_builder.h"
#include "ros/transforms.h"

#include <box_query/ros/scene_monitor.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include <ros/console.h>
#include <ros/names.h>

namespace box_query {
namespace {

using Clock = Bell::Clock;

/// At the latest after this the worker looks at the clocks and at locked frames by itself.
constexpr std::chrono::milliseconds kTick(50);
/// [ns] The system clock may be set back by this much; boxes then live that much longer.
constexpr std::int64_t kClockStep = 1000000000;

/// The parameters with names as the rest of the program compares them.
Parameters resolved(const ros::NodeHandle& nh, Parameters parameters) {
  parameters.fixed_frame = std::string(stripSlash(parameters.fixed_frame));
  std::set<std::string> names;
  for (TopicParameters& topic : parameters.box_topics) {
    topic.topic = nh.resolveName(topic.topic);
    if (!names.insert(topic.topic).second) {
      throw std::invalid_argument("box_topics names " + topic.topic + " twice: name it once");
    }
  }
  return parameters;
}

}  // namespace

struct SceneMonitor::Impl {
  Impl(const ros::NodeHandle& node, const Parameters& given);
  void stop();

  void receive(const Backlog::Message& message, DecodedMessage&& decoded);
  bool isBack(const ros::Time& time) const;
  void noticeTime();
  void followClocks();

  void makeNewest();
  void awaitNewest();

  void work();
  void tick();

  const ros::NodeHandle nh;
  const Parameters parameters;
  Bell bell;                           ///< for the worker
  std::atomic<bool> tf_wanted{false};  ///< transforms ring the bell
  Transforms transforms;

  std::timed_mutex mutex;  ///< guards the next three; of the history, what is noted
  BoxTracker tracker;
  ros::Time now;  ///< when last looked at
  History history;

  std::atomic<std::int64_t> noticed;  ///< `now` for who does not lock [ns]
  SceneBuilder builder;

  std::mutex changed_mutex;  ///< held while `changed` runs
  std::function<void()> changed;
  std::uint64_t announced_boxes = 0;  ///< of the worker

  std::atomic<bool> stopping{false};
  PublisherWatch publishers;
  BoxTopics topics;
  std::thread worker;
  Registration registration;
};

SceneMonitor::Impl::Impl(const ros::NodeHandle& node, const Parameters& given)
    : nh(node),
      parameters(resolved(node, given)),
      transforms(node, ros::Duration(parameters.transform_history),
                 [this] {
                   if (tf_wanted) {
                     bell.ring();
                   }
                 }),
      tracker(parameters, transforms.buffer()),
      now(ros::Time::now()),
      history(parameters),
      noticed(nanoseconds(now)),
      builder(parameters, tracker, mutex),
      publishers(parameters, tracker, mutex, [this] { bell.ring(); }),
      topics(node, parameters, [this](const Backlog::Message& message, DecodedMessage&& decoded) {
        receive(message, std::move(decoded));
      }) {
  topics.start();
  worker = std::thread([this] { work(); });
  publishers.start(topics);
}

/// Ends the threads: only then may anything that they use be destroyed.
void SceneMonitor::Impl::stop() {
  stopping = true;
  bell.ring();
  worker.join();
  publishers.stop();
  topics.stop();
}

void SceneMonitor::Impl::receive(const Backlog::Message& message, DecodedMessage&& decoded) {
  const std::size_t topic = message.topic;
  const BoxSource* const source = message.raw->source;
  const std::string problem = decoded.problem;
  const BoxSource* former = nullptr;
  std::optional<Succession::Addresses> met = publishers.meet(topic, message.raw->connection);
  {
    const std::lock_guard<std::timed_mutex> lock(mutex);
    builder.noteChange();
    noticeTime();
    former = tracker.lastSource(topic);
    if (met) {
      publishers.hear(topic, message.raw->connection, std::move(*met));
    }
    tracker.lose(topic, message.dropped, now);
    tracker.receive(topic, source, std::move(decoded), now);
    history.follow(tracker, now);
    tf_wanted = tracker.isWaiting();
  }
  if (met) {
    publishers.look(topic);
  }
  history.remember();
  bell.ring();
  const std::string& name = parameters.box_topics[topic].topic;
  if (message.dropped > 0) {
    ROS_WARN_STREAM_THROTTLE(
        5.0, "box_query: " << message.dropped << " messages on topic " << name
                           << " were dropped: they came faster than they could be taken "
                              "in");
  }
  if (!problem.empty()) {
    ROS_WARN_STREAM_THROTTLE(
        5.0, "box_query: a message on topic " << name << " was refused: " << problem);
  } else if (former && source != former) {
    ROS_WARN_STREAM("box_query: topic " << name << " has changed its type from " << former->type
                                        << " to " << source->type);
  }
}

/// The ROS clock was set back (a bag that starts again).
bool SceneMonitor::Impl::isBack(const ros::Time& time) const {
  return noticed - nanoseconds(time) > (ros::Time::isSimTime() ? 0 : kClockStep);
}

/// Reads the ROS clock. One that was set back makes everything known so far a thing of the future;
/// tf2 itself would go on answering from it until its next message.
void SceneMonitor::Impl::noticeTime() {
  const ros::Time time = ros::Time::now();
  if (isBack(time)) {
    ROS_WARN_STREAM("box_query: time went back from " << now << " to " << time
                                                      << "; boxes and transforms are forgotten");
    transforms.clear();
    tracker.turnClockBack(now, time, Clock::now());
    history.clear();
  }
  if (now.isZero() && !time.isZero()) {
    tracker.startClock(time);
  }
  if (now != time) {
    tracker.setClockGone(false);
  }
  now = time;
  noticed = nanoseconds(time);
  history.follow(tracker, now);
}

/// Looks at what changes by itself.
void SceneMonitor::Impl::followClocks() {
  noticeTime();
  tracker.expire(now);
  tracker.followLockedFrames();
  history.follow(tracker, now);
}

/// Makes the latest snapshot one of all that is known now, unless it is, or somebody else does.
void SceneMonitor::Impl::makeNewest() {
  {
    const std::lock_guard<std::timed_mutex> lock(mutex);
    followClocks();
    if (!builder.isBehind()) {
      return;
    }
  }
  builder.build();
}

/// The same, but where the worker builds ahead it is left to it: neither for a message that is
/// being taken in nor for a scene that is being built does this wait longer than their grace.
void SceneMonitor::Impl::awaitNewest() {
  if (!builder.isAhead()) {
    makeNewest();
    return;
  }
  // By the system's clock, since ThreadSanitizer misses locks by the steady one.
  std::unique_lock<std::timed_mutex> lock(
      mutex, std::chrono::system_clock::now() + (builder.graceEnd() - Clock::now()));
  if (!lock) {
    return;
  }
  followClocks();
  if (!builder.isBehind()) {
    return;
  }
  builder.noteChange();
  const std::uint64_t changes = tracker.changes();
  lock.unlock();
  bell.ring();
  builder.await(changes);
}

void SceneMonitor::Impl::work() {
  while (!stopping) {
    const std::uint64_t rings = bell.rings();
    tick();
    bell.waitPast(rings, Clock::now() + kTick);
  }
}

void SceneMonitor::Impl::tick() {
  std::uint64_t boxes = 0;
  {
    const std::lock_guard<std::timed_mutex> lock(mutex);
    followClocks();
    tracker.settle(Clock::now());
    history.follow(tracker, now);
    tf_wanted = tracker.isWaiting();
    boxes = tracker.boxesVersion();
  }
  builder.buildAhead();
  history.remember();  // who asks for the past does it, and who asks for now need not wait for it
  if (boxes != announced_boxes) {
    announced_boxes = boxes;
    const std::lock_guard<std::mutex> lock(changed_mutex);
    if (changed) {
      changed();
    }
  }
}

SceneMonitor::SceneMonitor(const ros::NodeHandle& nh, const Parameters& parameters)
    : impl_(std::make_unique<Impl>(nh, parameters)) {}

SceneMonitor::~SceneMonitor() {
  impl_->stop();
}

SnapshotPtr SceneMonitor::scene() const {
  return impl_->builder.handOut();
}

SnapshotPtr SceneMonitor::currentScene() {
  impl_->makeNewest();
  return impl_->builder.handOut();
}

SnapshotPtr SceneMonitor::promptScene() {
  impl_->awaitNewest();
  return impl_->builder.handOut();
}

SnapshotPtr SceneMonitor::watchedScene() {
  impl_->makeNewest();
  return impl_->builder.latest();
}

std::string SceneMonitor::sceneAt(const ros::Time& time, SnapshotPtr& scene) {
  ros::Time now;
  {
    const std::lock_guard<std::timed_mutex> lock(impl_->mutex);
    impl_->noticeTime();
    now = impl_->now;
  }
  std::shared_ptr<const PastScene> past;
  std::string missing = impl_->history.find(time, now, past);
  if (missing.empty()) {
    scene = impl_->builder.restore(*past);
  }
  return missing;
}

SnapshotPtr SceneMonitor::sceneById(std::uint64_t id) const {
  return impl_->builder.find(id);
}

std::string SceneMonitor::resolveTopic(const std::string& topic) const {
  std::string error;
  return ros::names::validate(topic, error) ? impl_->nh.resolveName(topic) : topic;
}

std::string SceneMonitor::lookUpTransform(const std::string& target, const std::string& source,
                                          const ros::Time& stamp, double timeout,
                                          geometry_msgs::TransformStamped& transform) const {
  if (impl_->isBack(ros::Time::now())) {  // else a message that is being taken in need not end
    const std::lock_guard<std::timed_mutex> lock(impl_->mutex);
    impl_->noticeTime();
  }
  return impl_->transforms.lookUp(target, source, stamp, timeout, transform);
}

void SceneMonitor::setChangedCallback(std::function<void()> changed) {
  const std::lock_guard<std::mutex> lock(impl_->changed_mutex);
  impl_->changed = std::move(changed);
}

MonitorStatistics SceneMonitor::statistics() const {
  const std::lock_guard<std::timed_mutex> lock(impl_->mutex);
  MonitorStatistics counts = impl_->tracker.counts();
  impl_->builder.addCounts(counts);
  return counts;
}

const Parameters& SceneMonitor::parameters() const {
  return impl_->parameters;
}

}  // namespace box_query
