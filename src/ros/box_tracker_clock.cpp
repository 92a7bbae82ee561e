// SPDX-License-Identifier: BSD-3-Clause
// What becomes of boxes when the ROS clock starts or goes back.
#include "ros/box_tracker.h"
#include "ros/nanoseconds.h"

#include <algorithm>
#include <cstdlib>

namespace box_query {
namespace {

/// Messages may overtake those of /clock by so much, until somebody looks.
constexpr std::chrono::milliseconds kClockLag(200);

/// Whether a stamp is clearly closer to the new time than to the old one.
bool isOf(const ros::Time& now, const ros::Time& before, const ros::Time& stamp) {
  const std::int64_t jump = nanoseconds(before) - nanoseconds(now);
  return !stamp.isZero() && std::abs(nanoseconds(stamp) - nanoseconds(now)) < jump / 2;
}

}  // namespace

void BoxTracker::noteArrival(Clock::time_point now) {
  while (!arrivals_.empty() && arrivals_.front().time < now - kClockLag) {
    arrivals_.pop_front();
  }
  arrivals_.push_back({now, store_.lastWord()});
}

void BoxTracker::turnClockBack(const ros::Time& before, const ros::Time& now,
                               Clock::time_point noticed) {
  const auto first = std::find_if(arrivals_.begin(), arrivals_.end(), [&](const Arrival& arrival) {
    return arrival.time >= noticed - kClockLag;
  });
  const std::uint64_t last_word = first == arrivals_.end() ? store_.lastWord() : first->last_word;
  arrivals_.clear();
  newest_stamp_ = ros::Time();
  unstamped_ = false;
  for (std::size_t index = 0; index < topics_.size(); ++index) {
    Topic& topic = topics_[index];
    topic.state.heard = false;
    topic.state.last_message = ros::Time();
    topic.refusal.clear();
    store_.keepLatest(index, [&](const Item& item) {
      if (item.latest_word <= last_word || !isOf(now, before, item.latest_stamp)) {
        return false;
      }
      topic.state.heard = true;
      topic.state.last_message = now;
      newest_stamp_ = std::max(newest_stamp_, item.latest_stamp);
      return true;
    });
  }
  const std::int64_t later = nanoseconds(now) - nanoseconds(before);
  store_.moveClock(later);
  waiting_.purge([this](const Word& word) { return store_.wants(word); });
  waiting_.moveClock(now, later);
  locked_.clear();
  ++changes_;
}

void BoxTracker::startClock(const ros::Time& now) {
  for (Topic& topic : topics_) {
    if (topic.state.heard) {
      topic.state.last_message = now;
    }
  }
  store_.moveClock(nanoseconds(now));
  waiting_.moveClock(now, nanoseconds(now));
  if (unstamped_) {
    unstamped_ = false;
    noteStamp(ros::Time(), now);
  }
  ++changes_;
}

void BoxTracker::setClockGone(bool gone) {
  changes_ += gone != clock_gone_ ? 1 : 0;
  clock_gone_ = gone;
}

}  // namespace box_query
