// SPDX-License-Identifier: BSD-3-Clause
#include "load/rebuilt_scene.h"

#include "load/messages.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

namespace box_query::load {
namespace {

OrientedBox placed(const std::string& frame, const Pose& pose, const OrientedBox& box) {
  return frame == kFixedFrame
             ? box
             : OrientedBox{pose.rotation * box.center + pose.translation,
                           Quaternion(pose.quaternion * box.orientation), box.half_extents};
}

TopicState heard(const std::string& name) {
  TopicState state;
  state.parameters.topic = name;
  state.heard = true;
  return state;
}

/// Gives each topic the sentences of a reason that name it, and those that follow them.
void setProblems(const std::string& reason, std::vector<TopicState>& topics) {
  for (TopicState& topic : topics) {
    topic.problem.clear();
  }
  TopicState* named = &topics.front();
  for (std::size_t begin = 0; begin < reason.size();) {
    const std::size_t next = std::min(reason.find(". ", begin), reason.size() - 1) + 1;
    const std::string sentence = reason.substr(begin, next - begin);
    const auto topic = std::find_if(topics.begin(), topics.end(), [&](const TopicState& each) {
      return sentence.find(each.parameters.topic) != std::string::npos;
    });
    named = topic != topics.end() ? &*topic : named;
    named->problem += (named->problem.empty() ? "" : " ") + sentence;
    begin = next + 1;
  }
}

}  // namespace

SceneRebuilder::SceneRebuilder() {
  snapshot_.frame = kFixedFrame;
  for (std::size_t topic = 0; topic < kTopics; ++topic) {
    const std::vector<KnownBox> known = boxesAt(topic, 0);
    std::vector<std::size_t>& order = topics_[topic].order;
    order.resize(known.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&known](std::size_t a, std::size_t b) {
      return std::tie(known[a].ns, known[a].id) < std::tie(known[b].ns, known[b].id);
    });
    for (const std::size_t place : order) {
      snapshot_.names.push_back(
          {topics()[topic].name, known[place].ns, known[place].id, known[place].label});
    }
    snapshot_.topics.push_back(heard(topics()[topic].name));
  }
  snapshot_.topics.push_back(heard(kPileTopic));
  snapshot_.stamps.resize(snapshot_.names.size());
}

const Snapshot& SceneRebuilder::rebuild(std::uint64_t id, const SceneFacts& facts) {
  if (snapshot_.id == id) {
    return snapshot_;
  }
  snapshot_.id = id;
  snapshot_.stamp = facts.stamp;
  setProblems(facts.reason, snapshot_.topics);
  std::vector<Box> boxes;
  for (std::size_t index = 0; index < kTopics; ++index) {
    Topic& topic = topics_[index];
    const Tick tick = facts.ticks[index];
    if (topic.tick != tick) {
      topic.tick = tick;
      const std::string& frame = topics()[index].frame;
      const Pose pose = poseAt(frame, tick);
      const std::vector<KnownBox> known = boxesAt(index, tick);
      topic.boxes.clear();
      for (const std::size_t place : topic.order) {
        topic.boxes.push_back(placed(frame, pose, known[place].box));
      }
    }
    std::fill_n(snapshot_.stamps.begin() + static_cast<std::ptrdiff_t>(boxes.size()),
                topic.boxes.size(), timeOf(tick));
    boxes.insert(boxes.end(), topic.boxes.begin(), topic.boxes.end());
  }
  snapshot_.scene = Scene(std::move(boxes));
  return snapshot_;
}

}  // namespace box_query::load
