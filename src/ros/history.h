// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The scenes of the last seconds, for questions about the past.
#pragma once

#include "ros/box_tracker.h"

#include <box_query/ros/scene_monitor.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <ros/time.h>

namespace box_query {

/// A snapshot without its scene, which is built when somebody asks. Boxes that are as in the one
/// before are shared with it: to the last bit, but for their stamps. Immutable.
class PastScene {
 public:
  /// What the draft says is so from `begin` on. `before` may be null.
  PastScene(const ros::Time& begin, const Draft& draft, const PastScene* before);

  /// [bytes] that it takes, about, by itself and beside the one before.
  std::size_t size() const { return size_; }
  std::size_t sizeBesideBefore() const { return size_beside_before_; }

  const ros::Time& begin() const { return begin_; }
  std::uint64_t id() const { return id_; }
  /// The snapshot that the draft would have become.
  SnapshotPtr restored() const;

 private:
  struct NamedBox {
    std::int64_t id;
    std::string label;
    Box box;
  };
  /// The boxes of one namespace of a topic, in the order of the snapshot.
  struct Namespace {
    std::string topic;
    std::string ns;
    std::vector<std::shared_ptr<const NamedBox>> boxes;
  };
  using NamespacePtr = std::shared_ptr<const Namespace>;
  struct StampRun {
    ros::Time stamp;
    std::size_t end;  ///< of the boxes that came with it
  };

  NamespacePtr find(const std::string& topic, const std::string& ns) const;
  NamespacePtr share(const Draft& draft, std::size_t begin, std::size_t end,
                     const NamespacePtr& before);
  static std::size_t sizeOf(const NamedBox& box);
  static bool isSame(const NamedBox& before, const BoxName& name, const Box& box);

  ros::Time begin_;
  std::uint64_t id_;
  ros::Time stamp_;
  std::string frame_;
  bool clock_gone_;
  std::vector<TopicState> topics_;
  std::vector<NamespacePtr> namespaces_;
  std::vector<StampRun> stamps_;  ///< whole sets have one
  std::size_t size_ = 0;
  std::size_t size_beside_before_ = 0;
};

/// Keeps what was so in the last Parameters::history seconds, in at most max_past_scenes scenes and
/// max_history_memory.
/// follow(), add() and clear() are called with a lock that others wait for: one at a time. They
/// only note what is to be remembered. The other functions may be called from any thread, and
/// remember that first.
class History {
 public:
  explicit History(const Parameters& parameters);

  /// Whether anything is kept at all.
  bool keeps() const { return duration_ > 0; }
  /// Adds what the tracker knows at `now`, if that is something new, and lets lifetimes end on the
  /// way, each when it ended and not when somebody looked. Does nothing where nothing is kept.
  void follow(BoxTracker& tracker, const ros::Time& now);
  /// What the draft says is so from `begin` on, or, if that is earlier, from when the last one was.
  void add(const ros::Time& begin, Draft draft);
  void clear();

  /// Does what was noted, so that it need not wait for a question.
  void remember();
  /// What was so at `time`; null before the first scene that is kept.
  std::shared_ptr<const PastScene> at(const ros::Time& time);
  /// From when on something is kept.
  ros::Time begin();
  /// Finds what was so at `time`.
  /// @return an empty string, or a sentence that says which times there are.
  std::string find(const ros::Time& time, const ros::Time& now,
                   std::shared_ptr<const PastScene>& scene);

 private:
  struct Note {
    ros::Time begin;
    std::optional<Draft> draft;  ///< none: all is forgotten
  };

  void dropFirst();
  void addIfNew(BoxTracker& tracker, const ros::Time& begin);
  void note(Note&& note);
  std::unique_lock<std::mutex> remembered();
  void remember(const Note& note);
  std::shared_ptr<const PastScene> latestAt(const ros::Time& time) const;

  const std::int64_t duration_;  ///< [ns]
  const std::size_t max_scenes_;
  const std::size_t max_size_;  ///< [bytes]
  std::uint64_t last_id_ = 0;   ///< of what was noted; 0: nothing

  std::mutex scenes_mutex_;  ///< locked before notes_mutex_
  std::deque<std::shared_ptr<const PastScene>> scenes_;
  std::size_t size_ = 0;  ///< [bytes] of all: the first by itself, each beside the one before
  std::mutex notes_mutex_;
  std::vector<Note> notes_;
};

}  // namespace box_query
