// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_tracker.h"

#include <algorithm>
#include <numeric>
#include <sstream>
#include <tuple>

namespace box_query {
namespace {

std::string boxesOf(std::size_t boxes, const std::string& topic) {
  return std::to_string(boxes) + (boxes == 1 ? " box" : " boxes") + " of topic " + topic;
}

std::string waitingOf(std::size_t boxes, const std::string& topic) {
  return boxesOf(boxes, topic) + (boxes == 1 ? " waits" : " wait");
}

std::string nameOf(const BoxChange& change, std::int64_t box_id) {
  return "box " + std::to_string(box_id) + " of namespace '" + change.ns + "'";
}

/// The name of its first box.
std::string nameOf(const BoxChange& change) {
  return nameOf(change, change.boxes.empty() ? change.id : change.boxes.front().id);
}

std::string describe(const WaitingList::Place& place, const std::string& fixed_frame) {
  std::ostringstream text;
  text << "the transform from frame '" << place.first << "' to '" << fixed_frame << "'";
  if (!place.second.isZero()) {
    text << " at time " << place.second;
  }
  return text.str();
}

/// Gives what is appended its identity, and its boxes theirs.
void number(BoxChange& change, std::int64_t id) {
  change.id = id;
  for (IdentifiedBox& box : change.boxes) {
    box.id += id * (std::int64_t{1} << 32);
  }
}

WaitingList::Place placeOf(const BoxChange& change) {
  return {change.frame, change.frame_locked ? ros::Time() : change.stamp};
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
  topic.heard_type = source ? source->type : "";
  counts_.ignored_markers += message.ignored;
  if (!message.problem.empty()) {
    ++(source ? counts_.malformed_messages : counts_.unknown_type_messages);
    topic.refusal = "The last message on topic " + topic.state.parameters.topic +
                    " was refused: " + message.problem + ".";
    return;
  }
  topic.refusal.clear();
  topic.state.heard = true;
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

void BoxTracker::setUnheard(std::size_t topic_index, std::size_t publishers,
                            const std::string& type) {
  Topic& topic = topics_.at(topic_index);
  const std::string latest_type = publishers > 0 ? type : "";
  if (publishers != topic.unheard || latest_type != topic.latest_type) {
    topic.unheard = publishers;
    topic.latest_type = latest_type;
    ++changes_;
  }
}

void BoxTracker::apply(std::size_t topic, BoxChange&& change, bool whole, const ros::Time& now) {
  if (change.kind == BoxChange::Kind::kClear) {
    store_.clear(topic);
    noteStamp(change.stamp, now);
  } else if (change.kind == BoxChange::Kind::kRemove) {
    if (change.whole_namespace) {
      store_.forgetBefore(topic, change.ns, store_.lastWord());
    } else {
      store_.remove(topic, change.ns, change.id);
    }
    noteStamp(change.stamp, now);
  } else {
    if (change.kind == BoxChange::Kind::kAppend) {
      number(change, store_.nextId(topic, change.ns));
    }
    const std::size_t rejected = change.rejected();
    counts_.boxes += change.boxes.size() + rejected;
    counts_.rejected_boxes += rejected;
    for (std::size_t why = 0; rejected > 0 && why < kRejections; ++why) {
      if (change.rejections[why] > 0) {
        counts_.rejections[rejectionNames()[why]] += change.rejections[why];
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
    const std::string frame = word.change.frame;
    locked_[frame] = pose;
    store_.place(std::move(word), frame);
    return;
  }
  bool finite = true;
  for (IdentifiedBox& box : word.change.boxes) {
    finite = moveBox(pose, box.box) && finite;
  }
  if (!finite) {
    rejectLostBoxes(word);
  }
  if (!word.change.boxes.empty()) {
    store_.place(std::move(word), "");
  }
}

void BoxTracker::rejectLostBoxes(Word& word) {
  IdentifiedBoxes& boxes = word.change.boxes;
  const auto is_lost = [](const IdentifiedBox& box) { return !box.box.center.allFinite(); };
  const auto count = static_cast<std::size_t>(std::count_if(boxes.begin(), boxes.end(), is_lost));
  const std::int64_t first = std::find_if(boxes.begin(), boxes.end(), is_lost)->id;
  counts_.rejected_boxes += count;
  counts_.rejections[rejectionNames()[static_cast<std::size_t>(Rejection::kNotFinite)]] += count;
  store_.reject(word, count,
                nameOf(word.change, first) + " is too far away for double numbers in frame '" +
                    parameters_.fixed_frame + "'");
  boxes.erase(std::remove_if(boxes.begin(), boxes.end(), is_lost), boxes.end());
}

void BoxTracker::wait(Word&& word) {
  const std::size_t boxes = word.change.boxes.size();
  if (!waiting_.fits(boxes)) {
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
  if (static_cast<std::int64_t>(now.toNSec()) >= store_.nextExpiry()) {
    ++changes_;
    counts_.expired_boxes += store_.expire(now);
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

void BoxTracker::restart() {
  for (std::size_t topic = 0; topic < topics_.size(); ++topic) {
    store_.clear(topic);
    topics_[topic].state.heard = false;
    topics_[topic].state.last_message = ros::Time();
    topics_[topic].refusal.clear();
  }
  waiting_.clear();
  locked_.clear();
  newest_stamp_ = ros::Time();
  unstamped_ = false;
  ++changes_;
}

void BoxTracker::startClock(const ros::Time& now) {
  for (Topic& topic : topics_) {
    if (topic.state.heard) {
      topic.state.last_message = now;
    }
  }
  store_.startClock(now);
  waiting_.startClock(now);
  if (unstamped_) {
    unstamped_ = false;
    noteStamp(ros::Time(), now);
  }
  ++changes_;
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

Draft BoxTracker::draft() {
  Draft draft;
  draft.snapshot.frame = parameters_.fixed_frame;
  draft.snapshot.stamp = newest_stamp_;
  draft.snapshot.topics.resize(topics_.size());
  used_frames_.clear();
  draft.boxes.reserve(drafted_boxes_);
  draft.snapshot.names.reserve(drafted_boxes_);
  draft.snapshot.stamps.reserve(drafted_boxes_);
  for (const std::size_t topic : by_name_) {
    draftTopic(topic, draft);
  }
  drafted_boxes_ = draft.boxes.size();
  for (auto frame = locked_.begin(); frame != locked_.end();) {
    frame = used_frames_.count(frame->first) > 0 ? std::next(frame) : locked_.erase(frame);
  }
  return draft;
}

void BoxTracker::draftTopic(std::size_t index, Draft& draft) {
  const Topic& topic = topics_[index];
  TopicState& state = draft.snapshot.topics[index];
  state = topic.state;
  state.waiting = store_.waiting(index);
  state.rejected = store_.rejected(index);
  std::string bad;         // first problem of a rejected box
  std::string lost_frame;  // of locked boxes, which tf has lost

  struct Row {
    std::int64_t id;
    const Item* item;
    const OrientedBox* box;
  };
  std::vector<Row> rows;  // of one namespace
  for (const auto& [ns, items] : store_.items(index)) {
    rows.clear();
    for (const auto& entry : items) {
      const Item& item = entry.second;
      if (item.rejected > 0 && bad.empty()) {
        bad = item.problem;
      }
      for (const IdentifiedBox& box : item.boxes) {
        rows.push_back({box.id, &item, &box.box});
      }
    }
    const auto before = [](const Row& a, const Row& b) { return a.id < b.id; };
    if (!std::is_sorted(rows.begin(), rows.end(), before)) {  // boxes of lists interleave
      std::stable_sort(rows.begin(), rows.end(), before);
    }
    for (const Row& row : rows) {
      OrientedBox box = *row.box;
      if (!row.item->locked_frame.empty()) {
        used_frames_.insert(row.item->locked_frame);
        const std::optional<FramePose>& known = locked_[row.item->locked_frame];
        if (!known || !moveBox(*known, box)) {
          lost_frame = row.item->locked_frame;
          ++state.waiting;
          continue;
        }
      }
      draft.boxes.emplace_back(box);
      draft.snapshot.names.push_back({state.parameters.topic, ns, row.id, row.item->label});
      draft.snapshot.stamps.push_back(row.item->stamp);
    }
  }

  if (!topic.refusal.empty()) {
    state.problem = topic.refusal;
  } else if (topic.unheard > 0) {
    state.problem = unheardSentence(topic);
  } else if (state.rejected > 0) {
    state.problem = boxesOf(state.rejected, state.parameters.topic) + " cannot be used: " + bad +
                    ". Publish the box again, correctly, or delete it.";
  } else if (!lost_frame.empty()) {
    state.problem = waitingOf(state.waiting, state.parameters.topic) + " for " +
                    describe({lost_frame, ros::Time()}, parameters_.fixed_frame) + ": publish it.";
  } else if (state.waiting > 0) {
    state.problem = missingSentence(index);
  }
}

std::string BoxTracker::unheardSentence(const Topic& topic) {
  const std::string& name = topic.state.parameters.topic;
  if (!topic.heard_type.empty() && topic.latest_type != topic.heard_type) {
    return "Topic " + name + " has publishers of two types, " + topic.heard_type + " and " +
           topic.latest_type + ": the latter cannot be heard; give each type a topic of its own.";
  }
  return std::to_string(topic.unheard) + " of the publishers of topic " + name +
         " cannot be heard: give those of another type a topic of their own, correct the ROS_IP of "
         "those that cannot be reached, and forget those that are dead by rosnode cleanup.";
}

std::string BoxTracker::missingSentence(std::size_t topic) const {
  std::string text = waitingOf(store_.waiting(topic), parameters_.box_topics[topic].topic);
  const WaitingList::Place* place =
      waiting_.firstPlace(topic, [this](const Word& word) { return store_.wants(word); });
  if (place) {
    const std::string error =
        missingPose(tf_, parameters_.fixed_frame, place->first, place->second);
    text += " for " + describe(*place, parameters_.fixed_frame) +
            (error.empty() ? "" : " (" + error + ")") + ": publish it.";
  }
  return text;
}

}  // namespace box_query
