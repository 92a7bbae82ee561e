// SPDX-License-Identifier: BSD-3-Clause
// The walk: box message -> source -> store -> placement (BoxTracker) -> new Scene -> one pointer
// swapped. Here are the threads: one hears boxes, one hears tf, and a worker places what waited and
// builds ahead. Whoever asks builds too, if the worker has not yet.
#include "ros/bell.h"
#include "ros/box_topics.h"
#include "ros/box_tracker.h"
#include "ros/built.h"
#include "ros/history.h"
#include "ros/kept_scenes.h"
#include "ros/latest.h"
#include "ros/name_order.h"
#include "ros/publishers.h"
#include "ros/succession.h"
#include "ros/transforms.h"

#include <box_query/ros/scene_monitor.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include <ros/console.h>
#include <ros/init.h>
#include <ros/names.h>
#include <ros/this_node.h>

namespace box_query {
namespace {

using Clock = Bell::Clock;

/// At the latest after this the worker looks at the clocks and at locked frames by itself.
constexpr std::chrono::milliseconds kTick(50);
/// Between looks at who publishes.
constexpr std::chrono::seconds kPublisherCheck(1);
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

  void checkPublishers();
  void forgetFormerPublishers();
  void receive(std::size_t topic, AnyBoxMessage& message);
  void noticeTime();

  void makeNewest();
  void build();
  SnapshotPtr handOut() const;

  void work();
  void tick();
  bool queriedLately();

  const ros::NodeHandle nh;
  const Parameters parameters;
  Bell bell;                           ///< for the worker
  std::atomic<bool> tf_wanted{false};  ///< transforms ring the bell
  Transforms transforms;

  std::mutex mutex;  ///< guards the next seven
  BoxTracker tracker;
  std::vector<Succession> successions;  ///< of the publishers of each topic
  ros::Time now;                        ///< when last looked at
  std::uint64_t builds = 0;
  std::uint64_t refits = 0;
  std::uint64_t unbuilt_changes = 0;
  History history;

  std::mutex build_mutex;           ///< one at a time; locked before `mutex`
  Latest<BuiltPtr> latest;          ///< never null; written with build_mutex locked
  std::uint64_t shown_changes = 0;  ///< of the tracker, that the snapshot shows; with both locked
  std::uint64_t shown_boxes = 0;
  mutable std::atomic<bool> queried{false};  ///< since the worker looked
  Clock::time_point last_query;              ///< as the worker saw it; its epoch: none yet
  KeptScenes kept;

  std::mutex changed_mutex;  ///< held while `changed` runs
  std::function<void()> changed;
  std::uint64_t announced_boxes = 0;  ///< of the worker

  std::atomic<bool> stopping{false};
  BoxTopics topics;
  std::thread worker;
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
      successions(parameters.box_topics.size(), Succession(ros::this_node::getName())),
      now(ros::Time::now()),
      history(parameters),
      latest(firstOf(tracker)),
      kept(parameters),
      topics(node, parameters,
             [this](std::size_t topic, AnyBoxMessage& message) { receive(topic, message); }) {
  topics.start();
  worker = std::thread([this] { work(); });
}

/// Ends the threads: only then may anything that they use be destroyed.
void SceneMonitor::Impl::stop() {
  stopping = true;
  bell.ring();
  worker.join();
  topics.stop();
}

void SceneMonitor::Impl::checkPublishers() {
  topics.checkPublishers(
      [this](std::size_t topic, std::size_t publishers, const std::string& type) {
        std::unique_lock<std::mutex> lock(mutex);
        const std::string warning = tracker.setUnheard(topic, publishers, type);
        lock.unlock();
        ROS_WARN_STREAM_COND(!warning.empty(), "box_query: " << warning);
      });
}

/// What the publishers of a topic said before they made way for new ones is forgotten.
void SceneMonitor::Impl::forgetFormerPublishers() {
  std::unique_lock<std::mutex> lock(mutex);
  for (std::size_t topic = 0; topic < successions.size(); ++topic) {
    if (successions[topic].asks(Clock::now())) {
      lock.unlock();
      auto known = addressesOfPublishers(parameters.box_topics[topic].topic);
      const std::size_t connected = topics.publishers(topic);
      lock.lock();
      if (!known || known->size() < connected) {
        continue;  // the master was restarted: who it does not know may be there all the same
      }
      if (const auto last_word = successions[topic].look(std::move(*known))) {
        tracker.forgetBefore(topic, *last_word);
      }
    }
  }
}

void SceneMonitor::Impl::receive(std::size_t topic, AnyBoxMessage& message) {
  const std::string problem = message.decoded.problem;
  const BoxSource* former = nullptr;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    noticeTime();
    former = tracker.lastSource(topic);
    successions[topic].hear(message.connection, tracker.lastWord(), Clock::now());
    tracker.receive(topic, message.source, std::move(message.decoded), now);
    history.follow(tracker, now);
    tf_wanted = tracker.isWaiting();
  }
  bell.ring();
  const std::string& name = parameters.box_topics[topic].topic;
  if (!problem.empty()) {
    ROS_WARN_STREAM_THROTTLE(
        5.0, "box_query: a message on topic " << name << " was refused: " << problem);
  } else if (former && message.source != former) {
    ROS_WARN_STREAM("box_query: topic " << name << " has changed its type from " << former->type
                                        << " to " << message.source->type);
  }
}

/// Reads the ROS clock. A clock that was set back (a bag that starts again) makes everything known
/// so far a thing of the future; tf2 itself would go on answering from it until its next message.
void SceneMonitor::Impl::noticeTime() {
  const ros::Time time = ros::Time::now();
  const std::int64_t back = static_cast<std::int64_t>(now.toNSec() - time.toNSec());
  if (back > (ros::Time::isSimTime() ? 0 : kClockStep)) {
    ROS_WARN_STREAM("box_query: time went back from " << now << " to " << time
                                                      << "; boxes and transforms are forgotten");
    transforms.clear();
    tracker.turnClockBack(now, time, Clock::now());
    history.clear();
  }
  if (now.isZero() && !time.isZero()) {
    tracker.startClock(time);
  }
  now = time;
  history.follow(tracker, now);
}

/// Makes the latest snapshot one of all that is known now, unless it is, or somebody else does.
void SceneMonitor::Impl::makeNewest() {
  {
    const std::lock_guard<std::mutex> lock(mutex);
    noticeTime();
    tracker.expire(now);
    tracker.followLockedFrames();
    history.follow(tracker, now);
    if (tracker.changes() == shown_changes) {
      return;
    }
  }
  build();
}

void SceneMonitor::Impl::build() {
  const std::lock_guard<std::mutex> building(build_mutex);
  std::unique_lock<std::mutex> lock(mutex);
  const std::uint64_t changes = tracker.changes();
  const std::uint64_t boxes = tracker.boxesVersion();
  if (changes == shown_changes) {
    return;  // somebody else was faster
  }
  Draft draft = tracker.draft();
  unbuilt_changes += changes - shown_changes;
  lock.unlock();

  const BuiltPtr before = latest.read([](const BuiltPtr& built) { return built; });
  const bool same = boxes == shown_boxes;
  const Snapshot& old = before->snapshot;
  draft.snapshot.scene =
      same ? old.scene
           : old.scene.updated(std::move(draft.boxes), placesOf(draft.snapshot.names, old.names));
  const auto after = std::make_shared<Built>(std::move(draft.snapshot));
  latest.write(after);
  if (before->handed_out) {  // nobody can get it any more
    kept.add(snapshotOf(before), after->snapshot.names.size());
  }

  lock.lock();
  if (!same) {
    ++builds;
    refits += after->snapshot.scene.update().rebuilt ? 0 : 1;
    --unbuilt_changes;
  }
  shown_changes = changes;
  shown_boxes = boxes;
}

SnapshotPtr SceneMonitor::Impl::handOut() const {
  if (!queried.load(std::memory_order_relaxed)) {
    queried = true;
  }
  return latest.read([](const BuiltPtr& built) {
    if (!built->handed_out.load(std::memory_order_relaxed)) {
      built->handed_out = true;
    }
    return snapshotOf(built);
  });
}

void SceneMonitor::Impl::work() {
  Clock::time_point publisher_check = Clock::now();
  while (!stopping) {
    const std::uint64_t rings = bell.rings();
    forgetFormerPublishers();
    tick();
    if (Clock::now() >= publisher_check) {
      checkPublishers();
      publisher_check = Clock::now() + kPublisherCheck;
    }
    bell.waitPast(rings, Clock::now() + kTick);
  }
}

void SceneMonitor::Impl::tick() {
  std::uint64_t boxes = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    noticeTime();
    tracker.expire(now);
    tracker.settle(Clock::now());
    tracker.followLockedFrames();
    history.follow(tracker, now);
    tf_wanted = tracker.isWaiting();
    boxes = tracker.boxesVersion();
  }
  if (queriedLately()) {
    build();
  }
  if (boxes != announced_boxes) {
    announced_boxes = boxes;
    const std::lock_guard<std::mutex> lock(changed_mutex);
    if (changed) {
      changed();
    }
  }
}

bool SceneMonitor::Impl::queriedLately() {
  if (queried.exchange(false)) {
    last_query = Clock::now();
  }
  return last_query != Clock::time_point() &&
         std::chrono::duration<double>(Clock::now() - last_query).count() < parameters.build_ahead;
}

SceneMonitor::SceneMonitor(const ros::NodeHandle& nh, const Parameters& parameters)
    : impl_(std::make_unique<Impl>(nh, parameters)) {}

SceneMonitor::~SceneMonitor() {
  impl_->stop();
}

SnapshotPtr SceneMonitor::scene() const {
  return impl_->handOut();
}

SnapshotPtr SceneMonitor::currentScene() {
  impl_->makeNewest();
  return impl_->handOut();
}

SnapshotPtr SceneMonitor::watchedScene() {
  impl_->makeNewest();
  return impl_->latest.read(snapshotOf);
}

std::string SceneMonitor::sceneAt(const ros::Time& time, SnapshotPtr& scene) {
  std::unique_lock<std::mutex> lock(impl_->mutex);
  impl_->noticeTime();
  const std::string missing = impl_->history.missingAt(time, impl_->now);
  if (!missing.empty()) {
    return missing;
  }
  const auto past = impl_->history.at(time);
  lock.unlock();
  scene = impl_->latest.read([&past](const BuiltPtr& built) {
    if (built->snapshot.id == past->id()) {
      built->handed_out = true;
    }
    return snapshotOf(built);
  });
  if (scene->id != past->id()) {
    scene = impl_->kept.restore(*past, scene->names.size());
  }
  return "";
}

SnapshotPtr SceneMonitor::sceneById(std::uint64_t id) const {
  const SnapshotPtr latest = impl_->latest.read(snapshotOf);
  return latest->id == id ? latest : impl_->kept.find(id);
}

std::string SceneMonitor::resolveTopic(const std::string& topic) const {
  std::string error;
  return ros::names::validate(topic, error) ? impl_->nh.resolveName(topic) : topic;
}

std::string SceneMonitor::lookUpTransform(const std::string& target, const std::string& source,
                                          const ros::Time& stamp, double timeout,
                                          geometry_msgs::TransformStamped& transform) const {
  {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    impl_->noticeTime();
  }
  return impl_->transforms.lookUp(target, source, stamp, timeout, transform);
}

void SceneMonitor::setChangedCallback(std::function<void()> changed) {
  const std::lock_guard<std::mutex> lock(impl_->changed_mutex);
  impl_->changed = std::move(changed);
}

MonitorStatistics SceneMonitor::statistics() const {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  MonitorStatistics counts = impl_->tracker.counts();
  counts.builds = impl_->builds;
  counts.refits = impl_->refits;
  counts.avoided_builds = impl_->unbuilt_changes;
  return counts;
}

const Parameters& SceneMonitor::parameters() const {
  return impl_->parameters;
}

}  // namespace box_query
