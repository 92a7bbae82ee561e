// SPDX-License-Identifier: BSD-3-Clause
#include "ros/request_checks.h"

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

}  // namespace

std::string Field::text() const {
  return index == kWhole ? name : name + ("[" + std::to_string(index) + "]");
}

void refuse(const Field& field, const std::string& why) {
  throw std::invalid_argument(field.text() + " " + why);
}

void refuseVector(const Field& field, const Vector3& vector) {
  if (vector.allFinite()) {
    refuse(field, "is zero: give a direction of any other length");
  }
  refuse(field, "is " + print(vector) + ": give finite numbers");
}

void refuseMaxRange(const Field& field, double max_range) {
  refuse(field, "is " + print(max_range) + ": give metres >= 0; 0 or +Inf is unlimited");
}

void refuseRadius(const Field& field, double radius) {
  refuse(field, "is " + print(radius) + ": give finite metres >= 0");
}

void checkLength(const char* name, std::size_t length, std::size_t queries, bool may_be_empty) {
  if (length == 1 || length == queries || (length == 0 && may_be_empty)) {
    return;
  }
  refuse({name},
         "has " + std::to_string(length) + " elements: give " + std::to_string(queries) +
             (may_be_empty ? ", a single one for all, or none" : ", or a single one for all"));
}

void checkCount(const char* what, std::size_t count, std::size_t max_queries) {
  if (count > max_queries) {
    throw std::invalid_argument("the request has " + std::to_string(count) + " " + what +
                                ", at most " + std::to_string(max_queries) +
                                " are taken: split it, or raise ~max_queries_per_call");
  }
}

void checkRunning(const std::atomic<bool>* stopping) {
  if (ros::isShuttingDown() || (stopping && stopping->load(std::memory_order_relaxed))) {
    throw std::runtime_error("the node shuts down: ask again when it is back");
  }
}

void checkHeader(const std_msgs::Header& header) {
  if (header.frame_id.empty()) {
    throw std::invalid_argument(
        "header.frame_id is empty: name the frame in which the geometry is given");
  }
}

}  // namespace box_query
