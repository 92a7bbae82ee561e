// SPDX-License-Identifier: BSD-3-Clause
#include "ros/whole_set.h"

#include <algorithm>

namespace box_query {
namespace {

/// How many changes back one is looked for: bounds the time that a message of many classes takes.
constexpr std::ptrdiff_t kRecentChanges = 8;

}  // namespace

WholeSet::WholeSet(std::uint32_t boxes, std::size_t max_boxes, const ros::Time& stamp,
                   DecodedMessage& message)
    : message_(message), boxes_(boxes) {
  message.whole = true;
  message.stamp = stamp;
  if (boxes > max_boxes) {
    message.problem = tooManyBoxes(max_boxes);
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
  std::vector<BoxChange>& changes = message_.changes;
  const std::string_view frame = stripSlash(header.frame);
  const auto oldest = changes.rend() - changes.rbegin() > kRecentChanges
                          ? changes.rbegin() + kRecentChanges
                          : changes.rend();
  const auto found = std::find_if(changes.rbegin(), oldest, [&](const BoxChange& change) {
    return change.ns == class_name && change.stamp == header.stamp && change.frame == frame;
  });
  if (found != oldest) {
    return *found;
  }
  BoxChange& change = changes.emplace_back();
  change.ns = class_name;
  change.label = class_name;
  change.frame = frame;
  change.stamp = header.stamp;
  // Numbered within the class, so that it replaces the like one of the message before even while it
  // waits for its transform.
  change.id = changes_of_[change.ns]++;
  if (changes.size() == 1) {
    change.boxes.reserve(boxes_);
  }
  return change;
}

}  // namespace box_query
