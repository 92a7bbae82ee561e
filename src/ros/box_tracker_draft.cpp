// SPDX-License-Identifier: BSD-3-Clause
// The draft of a snapshot: every box in the fixed frame, and a sentence on what a topic lacks.
#include "ros/box_tracker.h"

#include <algorithm>
#include <deque>

namespace box_query {
namespace {

std::string boxesOf(std::size_t boxes, const std::string& topic) {
  return std::to_string(boxes) + (boxes == 1 ? " box" : " boxes") + " of topic " + topic;
}

std::string waitingOf(std::size_t boxes, const std::string& topic) {
  return boxesOf(boxes, topic) + (boxes == 1 ? " waits" : " wait");
}

}  // namespace

Draft BoxTracker::draft() {
  Draft draft;
  draft.snapshot.id = changes_ + 1;
  draft.snapshot.frame = parameters_.fixed_frame;
  draft.snapshot.stamp = newest_stamp_;
  draft.snapshot.clock_gone = clock_gone_;
  draft.snapshot.topics.resize(topics_.size());
  used_frames_.clear();
  std::size_t boxes = 0;
  for (const std::size_t topic : by_name_) {
    boxes += store_.placed(topic);
  }
  boxes = std::max(boxes, drafted_boxes_);
  draft.boxes.reserve(boxes);
  draft.snapshot.names.reserve(boxes);
  draft.snapshot.stamps.reserve(boxes);
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
    std::size_t box;                ///< of the item
    const BoxList::Reader* points;  ///< of the item; null if its boxes are there in full
  };
  std::vector<Row> rows;  // of one namespace
  std::deque<BoxList::Reader> points;
  rows.reserve(store_.placed(index));
  for (const auto& [ns, items] : store_.items(index)) {
    rows.clear();
    points.clear();
    for (const auto& entry : items) {
      const Item& item = entry.second;
      if (item.rejected > 0 && bad.empty()) {
        bad = item.problem;
      }
      const BoxList::Reader* const reader =
          item.boxes.arePoints() ? &points.emplace_back(item.boxes) : nullptr;
      for (std::size_t n = 0; n < item.boxes.size(); ++n) {
        rows.push_back({item.boxes.id(n), &item, n, reader});
      }
    }
    const auto before = [](const Row& a, const Row& b) { return a.id < b.id; };
    if (!std::is_sorted(rows.begin(), rows.end(), before)) {  // boxes of lists interleave
      std::stable_sort(rows.begin(), rows.end(), before);
    }
    for (const Row& row : rows) {
      OrientedBox box = (row.points ? (*row.points)[row.box] : row.item->boxes[row.box]).box;
      if (!row.item->locked_frame.empty()) {
        used_frames_.insert(row.item->locked_frame);
        const std::optional<FramePose>& known = locked_[row.item->locked_frame];
        if (!known || !moveBox(*known, parameters_.max_coordinate, box)) {
          lost_frame = row.item->locked_frame;
          ++state.waiting;
          continue;
        }
      }
      if (row.item->placed_word != row.item->latest_word) {
        draft.snapshot.outdated.push_back(draft.boxes.size());
      }
      draft.boxes.emplace_back(box);
      draft.snapshot.names.push_back({state.parameters.topic, ns, row.id, row.item->label});
      draft.snapshot.stamps.push_back(row.item->stamp);
    }
  }

  if (!topic.refusal.empty()) {
    state.problem = topic.refusal;
  } else if (!topic.lost.empty()) {
    state.problem = topic.lost;
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
  if (topic.source && topic.latest_type != topic.source->type) {
    return "Topic " + name + " has publishers of two types, " + topic.source->type + " and " +
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
