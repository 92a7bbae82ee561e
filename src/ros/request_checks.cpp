// SPDX-License-Identifier: BSD-3-Clause
#include "ros/request_checks.h"

#include "ros/conversions.h"
#include "ros/magnitudes.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include <ros/init.h>

namespace box_query {
namespace {

template <class Value>
std::string print(const Value& value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string print(const Vector3& v) {
  return "(" + print(v.x()) + ", " + print(v.y()) + ", " + print(v.z()) + ")";
}

void checkFinite(const Field& field, const Vector3& vector) {
  if (!vector.allFinite()) {
    refuse(field, "is " + print(vector) + ": give finite numbers");
  }
}

/// Of all numbers of an array of points or vectors.
template <class Message>
Magnitudes magnitudesOf(const std::vector<Message>& array) {
  static_assert(sizeof(Message) == 3 * sizeof(double), "the numbers of an array lie in a row");
  Magnitudes magnitudes;
  if (!array.empty()) {
    magnitudes.see(&array.front().x, 3 * array.size());
  }
  return magnitudes;
}

/// Whether one of them is 0.
bool haveZero(const std::vector<geometry_msgs::Vector3>& vectors) {
  bool have = false;
  for (const geometry_msgs::Vector3& v : vectors) {
    have = have || (v.x == 0.0 && v.y == 0.0 && v.z == 0.0);
  }
  return have;
}

}  // namespace

std::string Field::text() const {
  return index == kWhole ? name : name + ("[" + std::to_string(index) + "]");
}

void refuse(const Field& field, const std::string& why) {
  throw std::invalid_argument(field.text() + " " + why);
}

void refusePoint(const Field& field, const Vector3& point, const Limits& limits) {
  checkFinite(field, point);
  refuse(field, "is " + print(point) + ": " + allowedCoordinates(limits.coordinate));
}

void refuseDirection(const Field& field, const Vector3& direction) {
  checkFinite(field, direction);
  if (direction.isZero(0)) {
    refuse(field, "is zero: give a direction of any other length");
  }
  refuse(field, "is " + print(direction) + ": give 0 for what is less than " +
                    print(kSmallestSlope) + " times its longest component");
}

void refuseMaxRange(const Field& field, double max_range) {
  refuse(field, "is " + print(max_range) + ": give metres >= 0; 0 or +Inf is unlimited");
}

void refuseRadius(const Field& field, double radius, const Limits& limits) {
  refuse(field, "is " + print(radius) + ": " +
                    (radius >= 0 && std::isfinite(radius) ? allowedCoordinates(limits.coordinate)
                                                          : "give finite metres >= 0"));
}

// All numbers are looked at together: most requests have none that is bad.
void checkPoints(const char* name, const std::vector<geometry_msgs::Point>& points,
                 const Limits& limits) {
  const Magnitudes all = magnitudesOf(points);
  if (all.largest() <= limits.coordinate && all.smallest() >= kSmallestCoordinate) {
    return;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    checkPoint({name, i}, fromMessage(points[i]), limits);
  }
}

void checkDirections(const char* name, const std::vector<geometry_msgs::Vector3>& directions) {
  const Magnitudes all = magnitudesOf(directions);
  const double largest = all.largest();
  if (largest <= std::numeric_limits<double>::max() && all.smallest() >= kSmallestSlope * largest &&
      !haveZero(directions)) {
    return;
  }
  for (std::size_t i = 0; i < directions.size(); ++i) {
    checkDirection({name, i}, fromMessage(directions[i]));
  }
}

void checkTime(const Field& field, const ros::Time& time) {
  if (time.nsec >= 1000000000U) {
    refuse(field, "has " + std::to_string(time.nsec) + " nanoseconds: give less than a second");
  }
}

void checkLength(const char* name, std::size_t length, std::size_t queries, bool may_be_empty) {
  if (length == 1 || length == queries || (length == 0 && may_be_empty)) {
    return;
  }
  refuse({name},
         "has " + std::to_string(length) + " elements: give " + std::to_string(queries) +
             (may_be_empty ? ", a single one for all, or none" : ", or a single one for all"));
}

void checkCount(const char* what, std::size_t count, const Limits& limits) {
  if (count > limits.queries) {
    throw std::invalid_argument("the request has " + std::to_string(count) + " " + what +
                                ", at most " + std::to_string(limits.queries) +
                                " are taken: split it, or raise ~max_queries_per_call");
  }
}

void checkRunning(const std::atomic<bool>* stopping) {
  if (ros::isShuttingDown() || (stopping && stopping->load(std::memory_order_relaxed))) {
    throw std::runtime_error("the node shuts down: ask again when it is back");
  }
}

void checkFrame(const std::string& frame, const Vector3& origin, const Limits& limits) {
  if (!isNear(limits.coordinate, origin)) {
    throw std::runtime_error("frame '" + frame + "' is at " + print(origin) +
                             ", too far away: correct its transform, or raise ~max_coordinate");
  }
}

void checkHeader(const std_msgs::Header& header, const Limits& limits) {
  if (header.frame_id.empty()) {
    throw std::invalid_argument(
        "header.frame_id is empty: name the frame in which the geometry is given");
  }
  checkTime({"header.stamp"}, header.stamp);
  if (header.frame_id.size() > limits.name_length) {
    throw std::invalid_argument("header.frame_id has " + std::to_string(header.frame_id.size()) +
                                " bytes: no name has more than ~max_name_length, " +
                                std::to_string(limits.name_length));
  }
}

}  // namespace box_query
