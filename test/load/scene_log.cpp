// SPDX-License-Identifier: BSD-3-Clause
#include "load/scene_log.h"

#include <optional>

namespace box_query::load {
namespace {

/// From the one box of every topic; nothing if these are not boxes that were published.
std::optional<SceneFacts> factsOf(const GetSceneResponse& scene) {
  SceneFacts facts;
  facts.stamp = scene.header.stamp;
  facts.complete = scene.complete;
  facts.reason = scene.reason;
  if (!scene.success || scene.box_topics.size() != kTopics) {
    return std::nullopt;
  }
  for (std::size_t topic = 0; topic < kTopics; ++topic) {
    const ros::Time& stamp = scene.stamps[topic];
    if (scene.box_topics[topic] != topics()[topic].name || timeOf(tickAt(stamp)) != stamp) {
      return std::nullopt;
    }
    facts.ticks[topic] = tickAt(stamp);
  }
  return facts;
}

}  // namespace

void SceneLog::learn(std::uint64_t scene_id, Caller& caller) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!asked_.insert(scene_id).second) {
      return;
    }
  }
  GetSceneRequest request;
  request.scene_id = scene_id;
  request.namespaces = witnessNamespaces();
  Bytes response;
  constexpr std::size_t kGetScene = kServices - 1;
  if (!caller.call(kGetScene, bytesOf(request), response)) {
    return;
  }
  if (const auto facts = factsOf(messageFrom<GetSceneResponse>(response))) {
    const std::lock_guard<std::mutex> lock(mutex_);
    facts_[scene_id] = *facts;
  }
}

std::map<std::uint64_t, SceneFacts> SceneLog::facts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return facts_;
}

}  // namespace box_query::load
