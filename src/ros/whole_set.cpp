// SPDX-License-Identifier: BSD-3-Clause
#include "ros/whole_set.h"

#include <algorithm>

namespace box_query {
namespace {

/// How many changes back one is looked for: bounds the time that a message of many classes takes.
constexpr std::ptrdiff_t kRecentChanges = 8;

BoxChanges::reverse_iterator oldestOf(BoxChanges& changes) {
  return changes.rend() -
         std::max(std::ptrdiff_t{0}, changes.rend() - changes.rbegin() - kRecentChanges);
}

/// An id that no change of the class has. They are numbered within it, so that one replaces the
/// like one of the message before even while it waits for its transform. No id is above the place
/// of its change: where others of the class came long ago, the place is a new one.
std::int64_t newId(BoxChanges& changes, std::string_view class_name) {
  const auto oldest = oldestOf(changes);
  const auto last = std::find_if(changes.rbegin(), oldest,
                                 [&](const BoxChange& change) { return change.ns == class_name; });
  if (last != oldest) {
    return last->id + 1;
  }
  return oldest == changes.rend() ? 0 : static_cast<std::int64_t>(changes.size());
}

}  // namespace

WholeSet::WholeSet(std::uint32_t boxes, const Limits& limits, const ros::Time& stamp,
                   DecodedMessage& message)
    : message_(message), boxes_(boxes), max_coordinate_(limits.coordinate) {
  message.whole = true;
  message.stamp = stamp;
  if (boxes > limits.boxes) {
    message.problem = tooManyBoxes(limits.boxes);
  }
}

void WholeSet::add(const WireHeader& header, std::string_view class_name, std::int64_t id,
                   const Vector3& center, const Quaternion& orientation, const Vector3& size) {
  BoxChange& change = changeOf(header, class_name);
  if (isBadFrame(change.frame)) {
    change.reject(Rejection::kFrame, 1, "'" + std::string(header.frame) + "'", id);
  } else {
    change.add(id, center, orientation, size);
  }
}

void WholeSet::reject(const WireHeader& header, std::string_view class_name, std::int64_t id,
                      Rejection why, const std::string& detail) {
  changeOf(header, class_name).reject(why, 1, detail, id);
}

BoxChange& WholeSet::changeOf(const WireHeader& header, std::string_view class_name) {
  BoxChanges& changes = message_.changes;
  const std::string_view frame = stripSlash(header.frame);
  const auto oldest = oldestOf(changes);
  const auto found = std::find_if(changes.rbegin(), oldest, [&](const BoxChange& change) {
    return change.ns == class_name && change.stamp == header.stamp && change.frame == frame;
  });
  if (found != oldest) {
    return *found;
  }
  const std::int64_t id = newId(changes, class_name);
  if (changes.size() == 1) {
    changes.reserve(kRecentChanges);  // where there are two there are often more
  }
  BoxChange& change = changes.emplace_back(max_coordinate_, class_name, frame);
  change.id = id;
  change.label = class_name;
  change.stamp = header.stamp;
  if (changes.size() == 1) {
    change.boxes.each().reserve(boxes_);
  }
  return change;
}

}  // namespace box_query
