// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_tracker.h"

#include "ros/nanoseconds.h"
#include "ros/rigid_object.h"

#include <algorithm>
#include <numeric>

namespace box_query {
namespace {

std::string nameOf(const BoxChange& change, std::int64_t box_id) {
  return "box " + std::to_string(box_id) + " of namespace '" + change.ns + "'";
}

/// The name of its first box.
std::string nameOf(const BoxChange& change) {
  return nameOf(change, change.boxes.empty() ? change.id : change.boxes.id(0));
}

/// Gives what is appended its identity, and its boxes theirs.
void number(BoxChange& change, std::int64_t id) {
  change.id = id;
  for (IdentifiedBox& box : change.boxes.each()) {
    box.id += id * (std::int64_t{1} << 32);
  }
}

/// Rejects a move of what consists of so many changes and shapes, if it does not fit.
void checkMove(BoxChange& move, std::size_t changes, std::size_t shapes) {
  if (move.rejected() > 0) {
    return;
  }
  const std::size_t moved = move.boxes.size() - 1;
  if (changes == 0) {
    move.reject(Rejection::kAction, 1, "MOVE, but nothing is known of it: add it first", move.id);
  } else if (moved > 0 && moved != shapes) {
    move.reject(
        Rejection::kAction, 1,
        "MOVE of " + std::to_string(moved) + " shapes, but it has " + std::to_string(shapes),
        move.id);
  }
}

WaitingList::Place placeOf(const BoxChange& change) {
  return {change.frame.str(), change.frame_locked ? ros::Time() : change.stamp};
}

}  // namespace

BoxTracker::BoxTracker(const Parameters& parameters, const tf2::BufferCore& tf)
    : parameters_(parameters),
      tf_(tf),
      topics_(parameters.box_topics.size()),
      by_name_(parameters.box_topics.size()),
      store_(parameters.box_topics.size()),
      waiting_(static_cast<std::size_t>(parameters.max_waiting_boxes)) {
  for (std::size_t topic = 0; topic < topics_.size(); ++topic) {
    topics_[topic].state.parameters = parameters_.box_topics[topic];
  }
  std::iota(by_name_.begin(), by_name_.end(), std::size_t{0});
  std::sort(by_name_.begin(), by_name_.end(), [this](std::size_t a, std::size_t b) {
    return parameters_.box_topics[a].topic < parameters_.box_topics[b].topic;
  });
}

void BoxTracker::receive(std::size_t topic_index, const BoxSource* source, DecodedMessage&& message,
                         const ros::Time& now) {
  Topic& topic = topics_.at(topic_index);
  ++changes_;
  ++counts_.messages;
  noteArrival(Clock::now());
  dropIfStale(topic_index, now);  // nobody may have looked since it was
  topic.source = source;
  counts_.ignored_markers += message.ignored;
  if (message.whole && message.problem.empty()) {
    message.problem = tooMuch(message.changes);
  }
  if (!message.problem.empty()) {
    ++(source ? counts_.malformed_messages : counts_.unknown_type_messages);
    topic.refusal = "The last message on topic " + topic.state.parameters.topic +
                    " was refused: " + message.problem + ".";
    return;
  }
  topic.refusal.clear();
  if (message.whole) {
    topic.lost.clear();
  }
  topic.state.heard = true;
  ++topic.state.messages;
  topic.state.last_message = now;
  if (message.changes.empty()) {
    noteStamp(message.stamp, now);
  }
  cached_place_.reset();
  const std::uint64_t last_word = store_.lastWord();
  for (BoxChange& change : message.changes) {
    apply(topic_index, std::move(change), message.whole, now);
  }
  if (message.whole) {
    store_.forgetBefore(topic_index, last_word);
  }
}

std::string BoxTracker::setUnheard(std::size_t topic_index, std::size_t publishers,
                                   const std::string& type) {
  Topic& topic = topics_.at(topic_index);
  const std::string latest_type = publishers > 0 ? type : "";
  if (publishers == topic.unheard && latest_type == topic.latest_type) {
    return "";
  }
  topic.unheard = publishers;
  topic.latest_type = latest_type;
  ++changes_;
  return publishers > 0 ? unheardSentence(topic) : "";
}

void BoxTracker::forgetBefore(std::size_t topic, std::uint64_t word) {
  Topic& former = topics_.at(topic);
  const bool lost = !former.lost.empty() && former.lost_word <= word;
  if (lost) {
    former.lost.clear();
  }
  const std::size_t rejected = store_.rejected(topic);
  const std::size_t boxes = store_.forgetBefore(topic, word);
  counts_.dropped_boxes += boxes;
  changes_ += boxes > 0 || lost || store_.rejected(topic) != rejected ? 1 : 0;
}

void BoxTracker::apply(std::size_t topic, BoxChange&& change, bool whole, const ros::Time& now) {
  if (change.kind == BoxChange::Kind::kClear) {
    store_.clear(topic);
    topics_[topic].lost.clear();
    noteStamp(change.stamp, now);
  } else if (change.kind == BoxChange::Kind::kRemove) {
    if (change.whole_namespace) {
      store_.forgetBefore(topic, change.ns, store_.lastWord());
    } else {
      store_.remove(topic, change.ns, change.id);
    }
    noteStamp(change.stamp, now);
  } else if (change.kind == BoxChange::Kind::kMove) {
    move(topic, std::move(change), now);
  } else {
    if (change.kind == BoxChange::Kind::kAppend) {
      number(change, store_.nextId(topic, change.ns));
    }
    hear(topic, std::move(change), whole, now);
  }
}

/// All that was added and appended to an object moves, or nothing.
void BoxTracker::move(std::size_t topic, BoxChange&& change, const ros::Time& now) {
  std::vector<std::pair<std::int64_t, std::shared_ptr<const RigidObject>>> objects;
  std::size_t shapes = 0;
  const auto items = store_.items(topic).find(change.ns);
  if (items != store_.items(topic).end()) {
    for (const auto& [id, item] : items->second) {
      if (item.object) {
        objects.emplace_back(id, item.object);
        shapes += item.object->shapes;
      }
    }
  }
  checkMove(change, objects.size(), shapes);
  if (change.rejected() > 0) {
    change.kind = BoxChange::Kind::kSet;
    change.boxes.clear();
    hear(topic, std::move(change), false, now);
    return;
  }
  std::size_t first_shape = 0;
  for (const auto& [id, object] : objects) {
    BoxChange one = moved(object, change, first_shape);
    number(one, id);
    first_shape += object->shapes;
    hear(topic, std::move(one), false, now);
  }
}

void BoxTracker::hear(std::size_t topic, BoxChange&& change, bool whole, const ros::Time& now) {
  if (!whole &&
      !store_.fits(topic, change, static_cast<std::size_t>(parameters_.max_boxes_per_topic),
                   static_cast<std::size_t>(parameters_.max_namespaces))) {
    overflow(topic, change);
    return;
  }
  const std::size_t rejected = change.rejected();
  counts_.boxes += change.boxes.size() + rejected;
  counts_.rejected_boxes += rejected;
  for (std::size_t why = 0; rejected > 0 && why < kRejections; ++why) {
    if (change.rejections->counts[why] > 0) {
      counts_.rejections[rejectionNames()[why]] += change.rejections->counts[why];
    }
  }
  Word word = store_.hear(topic, std::move(change), now);
  // A marker that is bad leaves what it said before in place; a whole set does not.
  if (!word.change.boxes.empty() || rejected == 0 || whole) {
    if (word.change.kind == BoxChange::Kind::kSet && word.change.whole_namespace) {
      store_.forgetBefore(topic, word.change.ns, word.number - 1);
    }
    place(std::move(word));
  }
}

/// Nothing is kept of the change but that there was one.
void BoxTracker::overflow(std::size_t topic, const BoxChange& change) {
  const std::size_t boxes = std::max<std::size_t>(1, change.boxes.size() + change.rejected());
  counts_.boxes += boxes;
  counts_.rejected_boxes += boxes;
  counts_.rejections[rejectionNames()[static_cast<std::size_t>(Rejection::kTooMany)]] += boxes;
  topics_[topic].lost_word = store_.countWord();
  topics_[topic].lost = nameOf(change) + " was rejected: topic " +
                        parameters_.box_topics[topic].topic + " would have more than " +
                        mostOfTopic() + ", and delete all of the topic.";
}

void BoxTracker::place(Word&& word) {
  if (word.change.frame == parameters_.fixed_frame || word.change.boxes.empty()) {
    counts_.avoided_transforms += word.change.boxes.size();
    noteStamp(word.change.stamp, word.received);
    store_.place(std::move(word), "");
  } else if (const auto& known = pose(placeOf(word.change))) {
    placeAt(*known, std::move(word));
  } else {
    wait(std::move(word));
  }
}

void BoxTracker::placeAt(const FramePose& pose, Word&& word) {
  noteStamp(word.change.stamp, word.received);
  if (word.change.frame_locked) {
    const std::string frame = word.change.frame.str();
    locked_[frame] = pose;
    store_.place(std::move(word), frame);
    return;
  }
  bool near = true;
  for (IdentifiedBox& box : word.change.boxes.each()) {
    near = moveBox(pose, parameters_.max_coordinate, box.box) && near;
  }
  if (!near) {
    rejectLostBoxes(word);
  }
  if (!word.change.boxes.empty()) {
    store_.place(std::move(word), "");
  }
}

void BoxTracker::rejectLostBoxes(Word& word) {
  BoxList::Each& boxes = word.change.boxes.each();
  const auto is_lost = [this](const IdentifiedBox& box) {
    return !isNear(parameters_.max_coordinate, box.box.center);
  };
  const auto count = static_cast<std::size_t>(std::count_if(boxes.begin(), boxes.end(), is_lost));
  const std::int64_t first = std::find_if(boxes.begin(), boxes.end(), is_lost)->id;
  counts_.rejected_boxes += count;
  counts_.rejections[rejectionNames()[static_cast<std::size_t>(Rejection::kOutOfBounds)]] += count;
  store_.reject(word, count,
                nameOf(word.change, first) + " is too far away in frame '" +
                    parameters_.fixed_frame + "': correct its transform, or raise ~max_coordinate");
  boxes.erase(std::remove_if(boxes.begin(), boxes.end(), is_lost), boxes.end());
}

void BoxTracker::wait(Word&& word) {
  const std::size_t boxes = word.change.boxes.size();
  if (!waiting_.fits(boxes) && purged_ != store_.unwanted()) {
    purged_ = store_.unwanted();
    waiting_.purge([this](const Word& other) { return store_.wants(other); });
  }
  if (!waiting_.fits(boxes)) {
    counts_.overflowed_boxes += boxes;
    store_.giveUp(word, nameOf(word.change) + " cannot wait for " +
                            describe(placeOf(word.change), parameters_.fixed_frame) +
                            ": too many boxes wait already; publish the transform, or raise "
                            "max_waiting_boxes");
    return;
  }
  using std::chrono::duration;
  const auto timeout =
      std::chrono::duration_cast<Clock::duration>(duration<double>(parameters_.waiting_timeout));
  waiting_.add(placeOf(word.change), std::move(word), Clock::now() + timeout);
}

void BoxTracker::settle(Clock::time_point now) {
  if (waiting_.empty()) {
    return;
  }
  cached_place_.reset();
  waiting_.release([this](const WaitingList::Place& place) { return pose(place).has_value(); },
                   [this](Word&& word) {
                     if (store_.wants(word)) {
                       ++changes_;
                       placeAt(*cached_pose_, std::move(word));
                     }
                   });
  waiting_.giveUp(now, [this](Word&& word) {
    if (store_.wants(word)) {
      ++changes_;
      counts_.given_up_boxes += word.change.boxes.size();
      store_.giveUp(word, nameOf(word.change) + " was given up: " +
                              describe(placeOf(word.change), parameters_.fixed_frame) +
                              " has not come in time; publish that first");
    }
  });
}

void BoxTracker::expire(const ros::Time& now) {
  if (nanoseconds(now) >= store_.nextExpiry()) {
    ++changes_;
    counts_.expired_boxes += store_.expire(now);
  }
  for (std::size_t topic = 0; topic < topics_.size(); ++topic) {
    dropIfStale(topic, now);
  }
}

std::int64_t BoxTracker::nextExpiry() const {
  std::int64_t next = store_.nextExpiry();
  for (std::size_t topic = 0; topic < topics_.size(); ++topic) {
    next = std::min(next, dropTime(topic));
  }
  return next;
}

std::int64_t BoxTracker::dropTime(std::size_t topic) const {
  const TopicState& state = topics_[topic].state;
  return state.parameters.drop_stale && !store_.items(topic).empty() ? state.staleAt() : kForever;
}

void BoxTracker::dropIfStale(std::size_t topic, const ros::Time& now) {
  if (nanoseconds(now) >= dropTime(topic)) {
    ++changes_;
    counts_.dropped_boxes += store_.clear(topic);
    topics_[topic].lost.clear();
  }
}

void BoxTracker::followLockedFrames() {
  for (auto& [frame, known] : locked_) {
    const std::optional<FramePose> latest =
        findPose(tf_, parameters_.fixed_frame, frame, ros::Time());
    if (!(latest == known)) {
      known = latest;
      ++changes_;
      ++moves_;
    }
  }
}

void BoxTracker::noteStamp(const ros::Time& stamp, const ros::Time& now) {
  const ros::Time& time = stamp.isZero() ? now : stamp;
  unstamped_ = unstamped_ || time.isZero();
  newest_stamp_ = std::max(newest_stamp_, time);
}

const std::optional<FramePose>& BoxTracker::pose(const WaitingList::Place& place) {
  if (cached_place_ != place) {
    cached_pose_ = findPose(tf_, parameters_.fixed_frame, place.first, place.second);
    cached_place_ = place;
  }
  return cached_pose_;
}

}  // namespace box_query
