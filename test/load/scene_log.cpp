// SPDX-License-Identifier: BSD-3-Clause
#include "load/scene_log.h"

#include "load/clients.h"

#include <algorithm>
#include <stdexcept>

namespace box_query::load {
namespace {

/// From the one box of every topic.
SceneFacts factsOf(const GetSceneResponse& scene) {
  SceneFacts facts;
  facts.stamp = scene.header.stamp;
  facts.complete = scene.complete;
  facts.reason = scene.reason;
  if (scene.box_topics.size() != kTopics) {
    throw std::runtime_error("scene " + std::to_string(scene.scene_id) + " has " +
                             std::to_string(scene.box_topics.size()) + " witnesses");
  }
  for (std::size_t topic = 0; topic < kTopics; ++topic) {
    const ros::Time& stamp = scene.stamps[topic];
    if (scene.box_topics[topic] != topics()[topic].name || timeOf(tickAt(stamp)) != stamp) {
      throw std::runtime_error("scene " + std::to_string(scene.scene_id) +
                               " has a box that nobody has sent");
    }
    facts.ticks[topic] = tickAt(stamp);
  }
  return facts;
}

SceneFacts askAbout(std::uint64_t id, Caller& caller) {
  GetSceneRequest request;
  request.scene_id = id;
  request.namespaces = witnessNamespaces();
  Bytes response;
  constexpr std::size_t kGetScene = kServices - 1;
  if (!caller.call(kGetScene, bytesOf(request), response)) {
    throw std::runtime_error("no answer from get_scene");
  }
  const auto scene = messageFrom<GetSceneResponse>(response);
  if (!scene.success) {
    throw std::runtime_error(scene.message);
  }
  return factsOf(scene);
}

}  // namespace

SceneLog::SceneLog() : thread_([this] { work(); }) {}

SceneLog::~SceneLog() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void SceneLog::notice(std::uint64_t scene_id) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!noticed_.insert(scene_id).second) {
      return;
    }
    to_ask_.push_back(scene_id);
  }
  changed_.notify_all();
}

std::map<std::uint64_t, SceneFacts> SceneLog::facts() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return to_ask_.empty() && !busy_; });
  return facts_;
}

void SceneLog::work() {
  Caller caller(true);
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return !to_ask_.empty() || stopping_; });
    if (stopping_) {
      return;
    }
    const std::uint64_t id = to_ask_.front();
    to_ask_.erase(to_ask_.begin());
    busy_ = true;
    lock.unlock();
    SceneFacts facts;
    std::string problem;
    try {
      facts = askAbout(id, caller);
    } catch (const std::exception& error) {
      problem = error.what();
    }
    lock.lock();
    busy_ = false;
    if (problem.empty()) {
      facts_[id] = facts;
    } else {
      problems_.push_back(problem);
    }
    changed_.notify_all();
  }
}

}  // namespace box_query::load
