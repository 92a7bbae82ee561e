// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// From the frame of a message to the fixed frame.
#pragma once

#include "ros/box_store.h"

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <ros/time.h>

namespace tf2 {
class BufferCore;
}

namespace box_query {

/// Pose of a frame in the fixed frame: X -> rotation X + translation.
struct FramePose {
  Quaternion quaternion;  ///< unit
  Eigen::Matrix3d rotation;
  Vector3 translation;

  bool operator==(const FramePose& other) const {
    return quaternion.coeffs() == other.quaternion.coeffs() && translation == other.translation;
  }
};

/// The pose of `frame` in `fixed_frame` at `stamp` (0: latest), if tf knows it now. Never waits.
std::optional<FramePose> findPose(const tf2::BufferCore& tf, const std::string& fixed_frame,
                                  const std::string& frame, const ros::Time& stamp);

/// What keeps tf from knowing that pose, in its own words.
std::string missingPose(const tf2::BufferCore& tf, const std::string& fixed_frame,
                        const std::string& frame, const ros::Time& stamp);

/// Moves a box. @return false if it is not near then: a translation may even overflow
bool moveBox(const FramePose& pose, double max_coordinate, OrientedBox& box);

/// Words whose transform is not there yet, kept by what they wait for, so that tf is asked once for
/// all boxes of a frame and stamp. Bounded by the number of boxes. Not thread safe.
class WaitingList {
 public:
  using Clock = std::chrono::steady_clock;
  using Place = std::pair<std::string, ros::Time>;  // frame, stamp

  explicit WaitingList(std::size_t max_boxes) : max_boxes_(max_boxes) {}

  bool empty() const { return words_.empty(); }
  bool fits(std::size_t boxes) const { return boxes <= max_boxes_ - boxes_; }
  /// @pre fits(word.change.boxes.size())
  void add(const Place& place, Word&& word, Clock::time_point deadline);

  /// Hands out, in the order in which they came, the words of every place that `take` accepts.
  void release(const std::function<bool(const Place&)>& accept,
               const std::function<void(Word&&)>& take);
  /// Hands out the words whose deadline is over.
  void giveUp(Clock::time_point now, const std::function<void(Word&&)>& take);
  /// Drops the words that nobody wants any more.
  void purge(const std::function<bool(const Word&)>& wanted);
  /// All words count as received at `now`, which is so much later than was thought. [ns]
  void moveClock(const ros::Time& now, std::int64_t later);

  /// The first place that a word of that topic waits for, or null.
  const Place* firstPlace(std::size_t topic, const std::function<bool(const Word&)>& wanted) const;

 private:
  struct Waiting {
    Word word;
    Clock::time_point deadline;
  };

  std::size_t max_boxes_;
  std::size_t boxes_ = 0;
  std::map<Place, std::deque<Waiting>> words_;  // no entry is empty
};

/// "the transform from frame 'a' to 'map' at time 12", as part of a sentence.
std::string describe(const WaitingList::Place& place, const std::string& fixed_frame);

}  // namespace box_query
