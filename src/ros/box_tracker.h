// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/box_source.h"
#include "ros/box_store.h"
#include "ros/placement.h"

#include <box_query/ros/scene_monitor.h>

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <ros/time.h>

namespace box_query {

/// What a snapshot is made of, before its scene is built.
struct Draft {
  Snapshot snapshot;       ///< without its scene
  std::vector<Box> boxes;  ///< of the scene
};

/// From decoded messages to placed boxes: the store, the boxes that wait for tf, the state of the
/// topics. Not thread safe; knows no ROS but its time, and asks tf without waiting.
class BoxTracker {
 public:
  using Clock = WaitingList::Clock;

  /// The topics' names are resolved ones.
  BoxTracker(const Parameters& parameters, const tf2::BufferCore& tf);

  /// Applies a message that came at ROS time `now`, or refuses it whole. `source` is null where its
  /// type is not understood.
  void receive(std::size_t topic, const BoxSource* source, DecodedMessage&& message,
               const ros::Time& now);
  /// So many messages of the topic were dropped before the one that is received next: until the
  /// topic is cleared, nobody knows what they said.
  void lose(std::size_t topic, std::size_t messages, const ros::Time& now);
  /// So many publishers of the topic cannot be heard beside the others; `type` is that of the
  /// publisher that came last, heard or not: the master knows no more.
  /// @return a sentence that warns of it, if it is news.
  std::string setUnheard(std::size_t topic, std::size_t publishers, const std::string& type);
  /// The source of the topic's last message; null if there was none, or it was not understood.
  const BoxSource* lastSource(std::size_t topic) const { return topics_.at(topic).source; }

  /// Forgets what the topic has not said again since that word.
  void forgetBefore(std::size_t topic, std::uint64_t word);
  /// Words that are received from now on have higher numbers.
  std::uint64_t lastWord() const { return store_.lastWord(); }

  /// Places the boxes whose transform has come; gives up those that waited too long.
  void settle(Clock::time_point now);
  /// Drops boxes whose lifetime has ended, and those of stale topics that are to be dropped.
  void expire(const ros::Time& now);
  /// Looks up the latest poses of frames that boxes are locked to.
  void followLockedFrames();
  /// The ROS clock has gone back, from `before` to `now`: forgets all boxes, and that topics were
  /// heard. What came just before that was noticed stays if its stamp is of the new time: messages
  /// overtake those of /clock.
  void turnClockBack(const ros::Time& before, const ros::Time& now, Clock::time_point noticed);
  /// The ROS clock has started, at `now`: what came before, at time 0, counts as received now.
  /// Whether a topic's or the clock's first message comes first is chance.
  void startClock(const ros::Time& now);

  /// Whether nobody publishes a simulated clock that has started.
  void setClockGone(bool gone);

  Draft draft();

  bool isWaiting() const { return !waiting_.empty(); }
  /// expire() drops nothing before this. [ns] of ROS time
  std::int64_t nextExpiry() const;
  /// Grows with whatever a snapshot shows.
  std::uint64_t changes() const { return changes_; }
  /// Whether a snapshot would show something else than the one with this id.
  bool isAfter(std::uint64_t id) const { return id != changes_ + 1; }
  /// Grows with the boxes of a snapshot and their names.
  std::uint64_t boxesVersion() const { return store_.boxesRevision() + moves_; }
  const MonitorStatistics& counts() const { return counts_; }

 private:
  struct Topic {
    TopicState state;
    std::string refusal;                ///< of its last message; empty if that was accepted
    const BoxSource* source = nullptr;  ///< of that message
    std::string lost;  ///< what it said and is not kept; empty until that, and when it is cleared
    std::uint64_t lost_word = 0;
    std::size_t unheard = 0;  ///< publishers that cannot be heard
    std::string latest_type;  ///< of the publisher that came last, if some cannot be heard
  };

  struct Arrival {
    Clock::time_point time;
    std::uint64_t last_word;  ///< before it
  };

  void noteArrival(Clock::time_point now);
  /// When its boxes are dropped, unless another message comes. [ns] of ROS time
  std::int64_t dropTime(std::size_t topic) const;
  void dropIfStale(std::size_t topic, const ros::Time& now);
  void apply(std::size_t topic, BoxChange&& change, bool whole, const ros::Time& now);
  void hear(std::size_t topic, BoxChange&& change, bool whole, const ros::Time& now);
  void move(std::size_t topic, BoxChange&& change, const ros::Time& now);
  void place(Word&& word);
  void placeAt(const FramePose& pose, Word&& word);
  /// Rejects the boxes of a word whose transform overflowed.
  void rejectLostBoxes(Word& word);
  void wait(Word&& word);
  std::string tooMuch(const BoxChanges& changes) const;
  std::string mostOfTopic() const;
  void overflow(std::size_t topic, const BoxChange& change);
  void noteStamp(const ros::Time& stamp, const ros::Time& now);
  const std::optional<FramePose>& pose(const WaitingList::Place& place);
  void draftTopic(std::size_t index, Draft& draft);
  static std::string unheardSentence(const Topic& topic);
  std::string missingSentence(std::size_t topic) const;

  const Parameters parameters_;
  const tf2::BufferCore& tf_;
  std::vector<Topic> topics_;
  std::vector<std::size_t> by_name_;  ///< indices of the topics in the order of snapshots
  BoxStore store_;
  WaitingList waiting_;
  std::uint64_t purged_ = 0;  ///< of the store's unwanted words, those that are not in the list
  std::map<std::string, std::optional<FramePose>> locked_;  ///< latest poses of locked frames
  std::set<std::string> used_frames_;                       ///< of them, those in the draft
  std::size_t drafted_boxes_ = 0;                           ///< in the last draft
  std::deque<Arrival> arrivals_;                            ///< of the latest messages
  ros::Time newest_stamp_;
  bool unstamped_ = false;  ///< something without a stamp came before the clock started
  bool clock_gone_ = false;
  std::uint64_t changes_ = 0;
  std::uint64_t moves_ = 0;  ///< of locked frames
  MonitorStatistics counts_;

  // The pose that was asked for last: most messages need only one.
  std::optional<WaitingList::Place> cached_place_;
  std::optional<FramePose> cached_pose_;
};

}  // namespace box_query
