// SPDX-License-Identifier: BSD-3-Clause
#include "ros/placement.h"

#include <algorithm>
#include <sstream>

#include <tf2/buffer_core.h>
#include <tf2/exceptions.h>

namespace box_query {

std::optional<FramePose> findPose(const tf2::BufferCore& tf, const std::string& fixed_frame,
                                  const std::string& frame, const ros::Time& stamp) {
  // Asking first is some fifty times cheaper than an exception, and most of the waiting is asking.
  if (!tf.canTransform(fixed_frame, frame, stamp)) {
    return std::nullopt;
  }
  try {
    const geometry_msgs::Transform t = tf.lookupTransform(fixed_frame, frame, stamp).transform;
    const Quaternion q(t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z);
    const Quaternion unit(q.normalized());
    return FramePose{
        unit, unit.toRotationMatrix(), {t.translation.x, t.translation.y, t.translation.z}};
  } catch (const tf2::TransformException&) {
    return std::nullopt;  // it went out of the buffer in between
  }
}

std::string missingPose(const tf2::BufferCore& tf, const std::string& fixed_frame,
                        const std::string& frame, const ros::Time& stamp) {
  std::string error;
  tf.canTransform(fixed_frame, frame, stamp, &error);
  return error;
}

bool moveBox(const FramePose& pose, double max_coordinate, OrientedBox& box) {
  box.center = (pose.rotation * box.center + pose.translation).eval();
  box.orientation = pose.quaternion * box.orientation;
  return isNear(max_coordinate, box.center);
}

std::string describe(const WaitingList::Place& place, const std::string& fixed_frame) {
  std::ostringstream text;
  text << "the transform from frame '" << place.first << "' to '" << fixed_frame << "'";
  if (!place.second.isZero()) {
    text << " at time " << place.second;
  }
  return text.str();
}

void WaitingList::add(const Place& place, Word&& word, Clock::time_point deadline) {
  boxes_ += word.change.boxes.size();
  words_[place].push_back({std::move(word), deadline});
}

void WaitingList::release(const std::function<bool(const Place&)>& accept,
                          const std::function<void(Word&&)>& take) {
  for (auto place = words_.begin(); place != words_.end();) {
    if (!accept(place->first)) {
      ++place;
      continue;
    }
    for (Waiting& waiting : place->second) {
      boxes_ -= waiting.word.change.boxes.size();
      take(std::move(waiting.word));
    }
    place = words_.erase(place);
  }
}

void WaitingList::giveUp(Clock::time_point now, const std::function<void(Word&&)>& take) {
  for (auto place = words_.begin(); place != words_.end();) {
    std::deque<Waiting>& words = place->second;
    while (!words.empty() && words.front().deadline <= now) {
      boxes_ -= words.front().word.change.boxes.size();
      take(std::move(words.front().word));
      words.pop_front();
    }
    place = words.empty() ? words_.erase(place) : std::next(place);
  }
}

void WaitingList::purge(const std::function<bool(const Word&)>& wanted) {
  for (auto place = words_.begin(); place != words_.end();) {
    std::deque<Waiting>& words = place->second;
    const auto unwanted = [&](const Waiting& waiting) {
      const bool drop = !wanted(waiting.word);
      boxes_ -= drop ? waiting.word.change.boxes.size() : 0;
      return drop;
    };
    words.erase(std::remove_if(words.begin(), words.end(), unwanted), words.end());
    place = words.empty() ? words_.erase(place) : std::next(place);
  }
}

void WaitingList::moveClock(const ros::Time& now, std::int64_t later) {
  for (auto& [place, words] : words_) {
    for (Waiting& waiting : words) {
      waiting.word.received = now;
      waiting.word.expiry = movedBy(later, waiting.word.expiry);
    }
  }
}

const WaitingList::Place* WaitingList::firstPlace(
    std::size_t topic, const std::function<bool(const Word&)>& wanted) const {
  for (const auto& [place, words] : words_) {
    for (const Waiting& waiting : words) {
      if (waiting.word.topic == topic && wanted(waiting.word)) {
        return &place;
      }
    }
  }
  return nullptr;
}

}  // namespace box_query
