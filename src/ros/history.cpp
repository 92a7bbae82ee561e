// SPDX-License-Identifier: BSD-3-Clause
#include "ros/history.h"

#include "ros/nanoseconds.h"

#include <algorithm>
#include <cstring>
#include <sstream>
#include <tuple>
#include <utility>

namespace box_query {
namespace {

/// Numbers that are equal may still be told apart: 0 and -0.
bool sameBits(const Box& a, const Box& b) {
  static_assert(sizeof(AlignedBox) == 6 * sizeof(double), "no padding");
  static_assert(sizeof(OrientedBox) == 10 * sizeof(double), "no padding");
  const auto same = [&b](const auto& box) {
    const auto* other = std::get_if<std::decay_t<decltype(box)>>(&b);
    return other != nullptr && std::memcmp(static_cast<const void*>(&box),
                                           static_cast<const void*>(other), sizeof(box)) == 0;
  };
  return std::visit(same, a);
}

/// What malloc adds to a block, and a shared pointer to what it points to.
constexpr std::size_t kBlock = 32;

std::size_t bytesOf(const std::string& text) {
  return text.capacity() > 15 ? text.capacity() + kBlock : 0;
}

}  // namespace

PastScene::PastScene(const ros::Time& begin, const Draft& draft, const PastScene* before)
    : begin_(begin),
      id_(draft.snapshot.id),
      stamp_(draft.snapshot.stamp),
      frame_(draft.snapshot.frame),
      clock_gone_(draft.snapshot.clock_gone),
      topics_(draft.snapshot.topics) {
  const std::vector<BoxName>& names = draft.snapshot.names;
  for (std::size_t first = 0; first < names.size();) {
    const BoxName& name = names[first];
    std::size_t end = first + 1;
    while (end < names.size() && names[end].ns == name.ns && names[end].topic == name.topic) {
      ++end;
    }
    namespaces_.push_back(
        share(draft, first, end, before ? before->find(name.topic, name.ns) : nullptr));
    first = end;
  }
  const std::vector<ros::Time>& stamps = draft.snapshot.stamps;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (stamps_.empty() || stamps_.back().stamp != stamps[i]) {
      stamps_.push_back({stamps[i], i});
    }
    stamps_.back().end = i + 1;
  }
  namespaces_.shrink_to_fit();
  stamps_.shrink_to_fit();
  std::size_t frame = sizeof(PastScene) + kBlock + namespaces_.size() * sizeof(NamespacePtr) +
                      stamps_.size() * sizeof(StampRun);
  for (const TopicState& topic : topics_) {
    frame += sizeof(topic) + bytesOf(topic.parameters.topic) + bytesOf(topic.problem);
  }
  size_ += frame;
  size_beside_before_ += frame;
}

PastScene::NamespacePtr PastScene::find(const std::string& topic, const std::string& ns) const {
  const auto found = std::lower_bound(namespaces_.begin(), namespaces_.end(), std::tie(topic, ns),
                                      [](const NamespacePtr& one, const auto& name) {
                                        return std::tie(one->topic, one->ns) < name;
                                      });
  const bool is_there =
      found != namespaces_.end() && (*found)->topic == topic && (*found)->ns == ns;
  return is_there ? *found : nullptr;
}

bool PastScene::isSame(const NamedBox& before, const BoxName& name, const Box& box) {
  return before.id == name.id && before.label == name.label && sameBits(before.box, box);
}

std::size_t PastScene::sizeOf(const NamedBox& box) {
  return sizeof(NamedBox) + kBlock + bytesOf(box.label);
}

PastScene::NamespacePtr PastScene::share(const Draft& draft, std::size_t begin, std::size_t end,
                                         const NamespacePtr& before) {
  static const std::vector<std::shared_ptr<const NamedBox>> none;
  const auto& old = before ? before->boxes : none;
  const BoxName& first = draft.snapshot.names[begin];
  auto made = std::make_shared<Namespace>(Namespace{first.topic, first.ns, {}});
  made->boxes.reserve(end - begin);
  bool all_same = old.size() == end - begin;
  std::size_t at = 0;  // both are in the order of ids
  std::size_t size = sizeof(Namespace) + kBlock + bytesOf(made->topic) + bytesOf(made->ns) +
                     (end - begin) * sizeof(made->boxes[0]);
  std::size_t shared = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const BoxName& name = draft.snapshot.names[i];
    while (at < old.size() && old[at]->id < name.id) {
      ++at;
    }
    if (at < old.size() && isSame(*old[at], name, draft.boxes[i])) {
      made->boxes.push_back(old[at++]);
      shared += sizeOf(*made->boxes.back());
    } else {
      made->boxes.push_back(
          std::make_shared<const NamedBox>(NamedBox{name.id, name.label, draft.boxes[i]}));
      all_same = false;
    }
    size += sizeOf(*made->boxes.back());
  }
  size_ += size;
  size_beside_before_ += all_same ? 0 : size - shared;
  return all_same ? before : made;
}

SnapshotPtr PastScene::restored() const {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->id = id_;
  snapshot->stamp = stamp_;
  snapshot->frame = frame_;
  snapshot->clock_gone = clock_gone_;
  snapshot->topics = topics_;
  std::vector<Box> boxes;
  for (const NamespacePtr& one : namespaces_) {
    for (const auto& box : one->boxes) {
      boxes.push_back(box->box);
      snapshot->names.push_back({one->topic, one->ns, box->id, box->label});
    }
  }
  for (const StampRun& run : stamps_) {
    snapshot->stamps.resize(run.end, run.stamp);
  }
  snapshot->scene = Scene(std::move(boxes));
  return snapshot;
}

History::History(const Parameters& parameters)
    : duration_(static_cast<std::int64_t>(parameters.history * 1e9)),
      max_scenes_(static_cast<std::size_t>(parameters.max_past_scenes)),
      max_size_(static_cast<std::size_t>(parameters.max_history_memory) * 1000000) {}

void History::follow(BoxTracker& tracker, const ros::Time& now) {
  if (!keeps() || now.isZero()) {
    return;
  }
  while (tracker.nextExpiry() <= nanoseconds(now)) {
    ros::Time end;
    end.fromNSec(static_cast<std::uint64_t>(tracker.nextExpiry()));
    tracker.expire(end);
    addIfNew(tracker, end);
  }
  addIfNew(tracker, now);
}

void History::addIfNew(BoxTracker& tracker, const ros::Time& begin) {
  if (last_id_ == 0 || tracker.isAfter(last_id_)) {
    add(begin, tracker.draft());
  }
}

void History::add(const ros::Time& begin, Draft draft) {
  last_id_ = draft.snapshot.id;
  note({begin, std::move(draft)});
}

void History::clear() {
  last_id_ = 0;
  note({ros::Time(), std::nullopt});
}

void History::note(Note&& note) {
  const std::lock_guard<std::mutex> lock(notes_mutex_);
  notes_.push_back(std::move(note));
}

void History::remember() {
  remembered();
}

/// Locks the scenes, after all that was noted is among them.
std::unique_lock<std::mutex> History::remembered() {
  std::unique_lock<std::mutex> lock(scenes_mutex_);
  std::vector<Note> notes;
  {
    const std::lock_guard<std::mutex> notes_lock(notes_mutex_);
    notes.swap(notes_);
  }
  for (const Note& note : notes) {
    remember(note);
  }
  return lock;
}

void History::remember(const Note& note) {
  if (!note.draft) {
    scenes_.clear();
    size_ = 0;
    return;
  }
  const PastScene* const last = scenes_.empty() ? nullptr : scenes_.back().get();
  const ros::Time begin = last ? std::max(note.begin, last->begin()) : note.begin;
  scenes_.push_back(std::make_shared<const PastScene>(begin, *note.draft, last));
  size_ += last ? scenes_.back()->sizeBesideBefore() : scenes_.back()->size();
  // The first one stays until the next has been so for the whole duration.
  const std::int64_t oldest = nanoseconds(note.begin) - duration_;
  while (
      scenes_.size() > max_scenes_ ||
      (scenes_.size() > 1 && (size_ > max_size_ || nanoseconds(scenes_[1]->begin()) <= oldest))) {
    dropFirst();
  }
}

/// What the next one shares with it stays.
/// @pre there is a next one
void History::dropFirst() {
  size_ -= scenes_[0]->size() + scenes_[1]->sizeBesideBefore();
  size_ += scenes_[1]->size();
  scenes_.pop_front();
}

std::shared_ptr<const PastScene> History::at(const ros::Time& time) {
  const auto lock = remembered();
  return latestAt(time);
}

ros::Time History::begin() {
  const auto lock = remembered();
  return scenes_.empty() ? ros::Time() : scenes_.front()->begin();
}

std::shared_ptr<const PastScene> History::latestAt(const ros::Time& time) const {
  const auto next = std::upper_bound(scenes_.begin(), scenes_.end(), time,
                                     [](const ros::Time& asked, const auto& scene) {
                                       return asked.toNSec() < scene->begin().toNSec();
                                     });
  return next == scenes_.begin() ? nullptr : *std::prev(next);
}

std::string History::find(const ros::Time& time, const ros::Time& now,
                          std::shared_ptr<const PastScene>& scene) {
  const auto lock = remembered();
  scene = time.toNSec() > now.toNSec() ? nullptr : latestAt(time);
  std::ostringstream text;
  text << "scene_time is " << time << ", but ";
  if (!keeps()) {
    text << "past scenes are not remembered: set ~history, or give 0 for now";
  } else if (now.isZero()) {
    text << "the ROS clock has not started: publish /clock";
  } else if (!scene) {
    text << "scenes are known from " << (scenes_.empty() ? ros::Time() : scenes_.front()->begin())
         << " to " << now
         << ", now: ask for one of these, for 0 (now), or raise ~history, ~max_past_scenes or "
            "~max_history_memory";
  } else {
    return "";
  }
  return text.str();
}

}  // namespace box_query
