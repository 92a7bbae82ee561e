// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_store.h"

#include "ros/nanoseconds.h"

#include <algorithm>
#include <utility>

namespace box_query {
namespace {

/// Boxes that are placed or wait.
std::size_t boxesOf(const Item& item) {
  return std::max(item.boxes.size(), item.waiting);
}

}  // namespace

BoxStore::BoxStore(std::size_t topics) : topics_(topics) {}

Word BoxStore::hear(std::size_t topic_index, BoxChange&& change, const ros::Time& now) {
  const std::int64_t expiry = change.lifetime > 0 ? nanoseconds(now) + change.lifetime : kForever;
  Word word{topic_index, ++last_word_, now, expiry, std::move(change)};
  Topic& topic = topics_.at(topic_index);
  Item& item = itemAt(topic_index, word.change.ns, word.change.id);
  if (item.first_word == 0) {
    item.first_word = word.number;
  }
  item.has_earlier = item.has_earlier || item.latest_word != item.placed_word;
  item.latest_word = word.number;
  item.latest_stamp = word.change.stamp;
  item.latest_expiry = word.expiry;
  item.problem = word.change.problem();
  if (word.change.object) {
    item.object = word.change.object;
  }
  setMissing(topic, item, word.change.boxes.size(), word.change.rejected());
  recount(topic, item);
  next_expiry_ = std::min(next_expiry_, word.expiry);
  return word;
}

bool BoxStore::fits(std::size_t topic_index, const BoxChange& change, std::size_t max_boxes,
                    std::size_t max_namespaces) const {
  const Topic& topic = topics_.at(topic_index);
  std::size_t before = 0;
  const std::size_t after = std::max<std::size_t>(1, change.boxes.size());
  if (topic.size + after <= max_boxes && topic.items.size() < max_namespaces) {
    return true;  // whatever is there already
  }
  const auto items = topic.items.find(change.ns);
  const bool known = items != topic.items.end();
  if (known) {
    const auto item = items->second.find(change.id);
    if (item != items->second.end()) {
      before = item->second.size;
    }
  }
  return topic.size - before + after <= max_boxes && (known || topic.items.size() < max_namespaces);
}

bool BoxStore::wants(const Word& word) const {
  const Item* item = find(word);
  return item && word.number >= item->first_word && word.number > item->placed_word;
}

void BoxStore::place(Word&& word, const std::string& locked_frame) {
  Topic& topic = topics_.at(word.topic);
  BoxChange& change = word.change;
  Item& item = itemOf(word);
  if (word.number == item.latest_word) {
    setMissing(topic, item, 0, item.rejected);
  }
  if (!item.boxes.isSame(change.boxes) || item.label != change.label ||
      item.locked_frame != locked_frame) {
    ++boxes_revision_;
  }
  unwanted_ += item.has_earlier ? 1 : 0;
  item.has_earlier = item.has_earlier && word.number != item.latest_word;
  item.placed_word = word.number;
  item.placed_expiry = word.expiry;
  item.label = std::move(change.label);
  item.stamp = change.stamp;
  item.locked_frame = locked_frame;
  item.boxes = std::move(change.boxes);
  recount(topic, item);
}

void BoxStore::reject(const Word& word, std::size_t boxes, const std::string& problem) {
  Topic& topic = topics_.at(word.topic);
  if (!wants(word)) {
    return;
  }
  Item& item = itemOf(word);
  if (word.number == item.latest_word) {
    item.problem = item.problem.empty() ? problem : item.problem;
    setMissing(topic, item, item.waiting - boxes, item.rejected + boxes);
  }
}

void BoxStore::giveUp(const Word& word, const std::string& problem) {
  reject(word, word.change.boxes.size(), problem);
}

void BoxStore::remove(std::size_t topic_index, const std::string& ns, std::int64_t id) {
  Topic& topic = topics_.at(topic_index);
  const auto items = topic.items.find(ns);
  if (items == topic.items.end()) {
    return;
  }
  const auto item = items->second.find(id);
  if (item == items->second.end()) {
    return;
  }
  forget(topic, item->second);
  last_place_.reset();
  items->second.erase(item);
  if (items->second.empty()) {
    topic.items.erase(items);
  }
}

std::size_t BoxStore::clear(std::size_t topic_index) {
  Topic& topic = topics_.at(topic_index);
  std::size_t boxes = 0;
  for (const auto& items : topic.items) {
    for (const auto& entry : items.second) {
      boxes += boxesOf(entry.second);
    }
  }
  if (!topic.items.empty()) {
    ++boxes_revision_;
    ++unwanted_;
  }
  topic = Topic();
  last_place_.reset();
  return boxes;
}

std::size_t BoxStore::forgetBefore(std::size_t topic_index, std::uint64_t word) {
  Topic& topic = topics_.at(topic_index);
  std::size_t boxes = 0;
  for (auto items = topic.items.begin(); items != topic.items.end();) {
    boxes += forgetBefore(topic, items, word);
  }
  return boxes;
}

std::size_t BoxStore::forgetBefore(std::size_t topic_index, const std::string& ns,
                                   std::uint64_t word) {
  Topic& topic = topics_.at(topic_index);
  auto items = topic.items.find(ns);
  return items == topic.items.end() ? 0 : forgetBefore(topic, items, word);
}

/// Moves on to the next namespace.
std::size_t BoxStore::forgetBefore(Topic& topic, Items::iterator& items, std::uint64_t word) {
  std::size_t boxes = 0;
  last_place_.reset();
  for (auto next = items->second.begin(); next != items->second.end();) {
    if (next->second.latest_word <= word) {
      boxes += boxesOf(next->second);
      forget(topic, next->second);
      next = items->second.erase(next);
    } else {
      ++next;
    }
  }
  items = items->second.empty() ? topic.items.erase(items) : std::next(items);
  return boxes;
}

std::int64_t BoxStore::nextId(std::size_t topic, const std::string& ns) const {
  const Items& items = topics_.at(topic).items;
  const auto found = items.find(ns);
  return found == items.end() ? 0 : found->second.rbegin()->first + 1;
}

std::size_t BoxStore::expire(const ros::Time& now) {
  const std::int64_t time = nanoseconds(now);
  if (time < next_expiry_) {
    return 0;
  }
  std::size_t expired = 0;
  next_expiry_ = kForever;
  last_place_.reset();
  for (Topic& topic : topics_) {
    for (auto items = topic.items.begin(); items != topic.items.end();) {
      for (auto next = items->second.begin(); next != items->second.end();) {
        Item& item = next->second;
        if (item.latest_expiry <= time) {
          expired += boxesOf(item);
          forget(topic, item);
          next = items->second.erase(next);
          continue;
        }
        if (item.placed_expiry <= time) {
          expired += item.boxes.size();
          ++boxes_revision_;
          item.boxes.clear();
          item.placed_expiry = kForever;
        }
        next_expiry_ = std::min({next_expiry_, item.latest_expiry, item.placed_expiry});
        ++next;
      }
      items = items->second.empty() ? topic.items.erase(items) : std::next(items);
    }
  }
  return expired;
}

void BoxStore::keepLatest(std::size_t topic_index, const std::function<bool(const Item&)>& keep) {
  Topic& topic = topics_.at(topic_index);
  last_place_.reset();
  for (auto items = topic.items.begin(); items != topic.items.end();) {
    for (auto next = items->second.begin(); next != items->second.end();) {
      Item& item = next->second;
      if (!keep(item)) {
        forget(topic, item);
        next = items->second.erase(next);
        continue;
      }
      item.first_word = item.latest_word;
      ++unwanted_;
      if (item.placed_word < item.latest_word && !item.boxes.empty()) {
        ++boxes_revision_;
        item.boxes.clear();
      }
      ++next;
    }
    items = items->second.empty() ? topic.items.erase(items) : std::next(items);
  }
}

void BoxStore::moveClock(std::int64_t later) {
  next_expiry_ = movedBy(later, next_expiry_);
  for (Topic& topic : topics_) {
    for (auto& items : topic.items) {
      for (auto& entry : items.second) {
        Item& item = entry.second;
        item.latest_expiry = movedBy(later, item.latest_expiry);
        item.placed_expiry = movedBy(later, item.placed_expiry);
      }
    }
  }
}

Item& BoxStore::itemAt(std::size_t topic, const std::string& ns, std::int64_t id) {
  Items& items = topics_.at(topic).items;
  if (!last_place_ || last_place_->items != &items || last_place_->ns->first != ns) {
    const auto ids = items.try_emplace(ns).first;
    last_place_ = Place{&items, ids, ids->second.end()};
  }
  Ids& ids = last_place_->ns->second;
  const auto behind = last_place_->id == ids.end() ? ids.end() : std::next(last_place_->id);
  last_place_->id = ids.try_emplace(behind, id);
  return last_place_->id->second;
}

const Item* BoxStore::find(const Word& word) const {
  const Items& all = topics_.at(word.topic).items;
  const auto items = all.find(word.change.ns);
  if (items == all.end()) {
    return nullptr;
  }
  const auto item = items->second.find(word.change.id);
  return item == items->second.end() ? nullptr : &item->second;
}

Item& BoxStore::itemOf(const Word& word) {
  return last_place_ && word.number == last_word_
             ? last_place_->id->second
             : topics_.at(word.topic).items[word.change.ns][word.change.id];
}

void BoxStore::recount(Topic& topic, Item& item) {
  const std::size_t size = std::max<std::size_t>(1, boxesOf(item));
  topic.size += size - item.size;
  item.size = size;
}

void BoxStore::setMissing(Topic& topic, Item& item, std::size_t waiting, std::size_t rejected) {
  topic.waiting += waiting - item.waiting;
  topic.rejected += rejected - item.rejected;
  item.waiting = waiting;
  item.rejected = rejected;
}

void BoxStore::forget(Topic& topic, Item& item) {
  setMissing(topic, item, 0, 0);
  topic.size -= item.size;
  unwanted_ += item.has_earlier || item.latest_word != item.placed_word ? 1 : 0;
  if (!item.boxes.empty()) {
    ++boxes_revision_;
  }
}

}  // namespace box_query
