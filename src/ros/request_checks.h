// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The sentences with which requests are refused.
#pragma once

#include "ros/box_filter.h"
#include "ros/limits.h"

#include <box_query/geometry.h>

#include <atomic>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Vector3.h>
#include <ros/time.h>
#include <std_msgs/Header.h>

namespace box_query {

/// A field of a request, or one element of an array; made into text only where it is at fault.
struct Field {
  static constexpr std::size_t kWhole = std::numeric_limits<std::size_t>::max();

  const char* name;
  std::size_t index = kWhole;

  std::string text() const;
};

[[noreturn]] void refuse(const Field& field, const std::string& why);

[[noreturn]] void refusePoint(const Field& field, const Vector3& point, const Limits& limits);
[[noreturn]] void refuseDirection(const Field& field, const Vector3& direction);
[[noreturn]] void refuseMaxRange(const Field& field, double max_range);
[[noreturn]] void refuseRadius(const Field& field, double radius, const Limits& limits);

// Inline, since a batch has thousands of each.
inline void checkPoint(const Field& field, const Vector3& point, const Limits& limits) {
  if (!isWithin(limits.coordinate, point)) {
    refusePoint(field, point, limits);
  }
}
inline void checkDirection(const Field& field, const Vector3& direction) {
  if (!isDirection(direction)) {
    refuseDirection(field, direction);
  }
}
/// 0 and +inf are unlimited.
inline void checkMaxRange(const Field& field, double max_range) {
  if (!(max_range >= 0)) {
    refuseMaxRange(field, max_range);
  }
}
inline void checkRadius(const Field& field, double radius, const Limits& limits) {
  if (!(radius >= 0) || !isWithin(limits.coordinate, radius)) {
    refuseRadius(field, radius, limits);
  }
}
/// The same of each element of an array.
void checkPoints(const char* name, const std::vector<geometry_msgs::Point>& points,
                 const Limits& limits);
void checkDirections(const char* name, const std::vector<geometry_msgs::Vector3>& directions);
/// Of ROS: fewer nanoseconds than a second has.
void checkTime(const Field& field, const ros::Time& time);
/// An array of one element a query, or a single one for all, or, if `may_be_empty`, none.
void checkLength(const char* name, std::size_t length, std::size_t queries, bool may_be_empty);
void checkCount(const char* what, std::size_t count, const Limits& limits);

/// @throws std::runtime_error if the node shuts down, or the server that sets `stopping` does:
/// nobody would read the rest of a batch.
void checkRunning(const std::atomic<bool>* stopping);

/// The origin of the request's frame, in the fixed frame.
/// @throws std::runtime_error if it is out of bounds
void checkFrame(const std::string& frame, const Vector3& origin, const Limits& limits);

/// What all requests share.
void checkHeader(const std_msgs::Header& header, const Limits& limits);
template <class Request>
void checkCommon(const Request& request, const Limits& limits) {
  checkHeader(request.header, limits);
  checkTime({"scene_time"}, request.scene_time);
  check(BoxFilter(request), limits);
}

/// Element `i` of an array of one element a query, or a single one for all.
template <class Array>
const auto& elementAt(const Array& array, std::size_t i) {
  return array.size() == 1 ? array[0] : array[i];
}

}  // namespace box_query
