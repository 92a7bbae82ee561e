// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What all topics say now, by (topic, ns, id).
#pragma once

#include "ros/box_source.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <ros/time.h>

namespace box_query {

/// No end of life.
constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();

/// The end of a life that began `later` than was thought. [ns]
inline std::int64_t movedBy(std::int64_t later, std::int64_t expiry) {
  return expiry == kForever ? kForever : expiry + later;
}

/// One kSet change that the store has been told of, and that is still to be placed.
struct Word {
  std::size_t topic = 0;
  std::uint64_t number = 0;  ///< later words have higher numbers
  ros::Time received;
  std::int64_t expiry = kForever;  ///< [ns] of ROS time
  BoxChange change;
};

/// What a topic says under one (ns, id). While its latest word waits for a transform or is bad, the
/// word before it stays placed.
struct Item {
  std::uint64_t first_word = 0;
  std::uint64_t latest_word = 0;
  std::uint64_t placed_word = 0;  ///< 0: none yet
  bool has_earlier = false;       ///< words before the latest were not placed: they may wait
  ros::Time latest_stamp;
  std::int64_t latest_expiry = kForever;
  std::int64_t placed_expiry = kForever;

  std::size_t size = 0;  ///< what counts of it: boxes that are placed or wait, at least one

  // Of the latest word.
  std::size_t waiting = 0;                    ///< boxes that wait for their transform
  std::size_t rejected = 0;                   ///< boxes that were rejected or given up
  std::string problem;                        ///< of the rejected ones
  std::shared_ptr<const RigidObject> object;  ///< of the latest word that had a box; null: none

  // Of the placed word.
  std::string label;
  ros::Time stamp;
  std::string locked_frame;  ///< frame of the boxes if they are locked to it, else empty
  BoxList boxes;             ///< in the fixed frame, unless locked
};

/// Keeps the latest placed word of every item, and counts what is missing. Topics do not touch one
/// another. Not thread safe.
class BoxStore {
 public:
  using Ids = std::map<std::int64_t, Item>;
  using Items = std::map<std::string, Ids>;  // by ns

  explicit BoxStore(std::size_t topics);

  /// Hears a kSet change at ROS time `now`: counts its rejected boxes, and its others as waiting
  /// until the word that is returned is placed or given up.
  Word hear(std::size_t topic, BoxChange&& change, const ros::Time& now);

  /// Whether the topic, had it heard that kSet change, would have at most so many boxes and
  /// namespaces. What has no box, since it was rejected for instance, counts as one.
  bool fits(std::size_t topic, const BoxChange& change, std::size_t max_boxes,
            std::size_t max_namespaces) const;

  /// Whether the word still matters: its item is neither deleted, nor expired, nor overtaken by a
  /// later word that was placed.
  bool wants(const Word& word) const;

  /// The boxes of a wanted word, now in the fixed frame (or in `locked_frame`, if not empty).
  void place(Word&& word, const std::string& locked_frame);

  /// Counts some boxes of a word that is about to be placed as rejected, unless a later word has
  /// come.
  void reject(const Word& word, std::size_t boxes, const std::string& problem);

  /// Counts the boxes of a word that cannot be placed as rejected, unless a later word has come.
  void giveUp(const Word& word, const std::string& problem);

  void remove(std::size_t topic, const std::string& ns, std::int64_t id);
  /// @return the number of boxes that were placed or waiting.
  std::size_t clear(std::size_t topic);
  /// Forgets what the topic has not said again since that word: all of it, or that of one
  /// namespace. @return the number of boxes that were placed or waiting.
  std::size_t forgetBefore(std::size_t topic, std::uint64_t word);
  std::size_t forgetBefore(std::size_t topic, const std::string& ns, std::uint64_t word);
  /// An id above all others of the namespace; 0 if it has none.
  std::int64_t nextId(std::size_t topic, const std::string& ns) const;
  /// Words that are heard from now on have higher numbers.
  std::uint64_t lastWord() const { return last_word_; }
  /// The number of a word of which nothing is kept.
  std::uint64_t countWord() { return ++last_word_; }

  /// Forgets what has ended by `now`. @return the number of boxes that were placed or waiting.
  std::size_t expire(const ros::Time& now);

  /// Forgets what `keep` does not accept of a topic, and all but the latest word of the rest.
  void keepLatest(std::size_t topic, const std::function<bool(const Item&)>& keep);

  /// All lifetimes began so much later. [ns]
  void moveClock(std::int64_t later);

  const Items& items(std::size_t topic) const { return topics_.at(topic).items; }
  std::size_t waiting(std::size_t topic) const { return topics_.at(topic).waiting; }
  /// Boxes that are placed, about: too few where some have a later word that waits.
  std::size_t placed(std::size_t topic) const {
    return topics_.at(topic).size - topics_.at(topic).waiting;
  }
  std::size_t rejected(std::size_t topic) const { return topics_.at(topic).rejected; }

  /// Nothing expires before this. [ns] of ROS time
  std::int64_t nextExpiry() const { return next_expiry_; }
  /// Grows whenever words that may still wait are wanted no more.
  std::uint64_t unwanted() const { return unwanted_; }
  /// Grows with every change of boxes or names.
  std::uint64_t boxesRevision() const { return boxes_revision_; }

 private:
  struct Topic {
    Items items;
    std::size_t size = 0;  ///< of all items
    std::size_t waiting = 0;
    std::size_t rejected = 0;
  };

  /// Made if it is not there.
  Item& itemAt(std::size_t topic, const std::string& ns, std::int64_t id);
  const Item* find(const Word& word) const;
  Item& itemOf(const Word& word);
  static void recount(Topic& topic, Item& item);
  static void setMissing(Topic& topic, Item& item, std::size_t waiting, std::size_t rejected);
  void forget(Topic& topic, Item& item);
  std::size_t forgetBefore(Topic& topic, Items::iterator& items, std::uint64_t word);

  std::vector<Topic> topics_;
  std::uint64_t last_word_ = 0;
  /// Most words are placed as soon as they are heard, and are about the item behind the last.
  struct Place {
    Items* items;
    Items::iterator ns;
    Ids::iterator id;
  };
  std::optional<Place> last_place_;  ///< of that word; nothing if its item may be gone
  std::int64_t next_expiry_ = kForever;
  std::uint64_t unwanted_ = 0;
  std::uint64_t boxes_revision_ = 0;
};

}  // namespace box_query
