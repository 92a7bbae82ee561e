// SPDX-License-Identifier: BSD-3-Clause
#include "stress/tally.h"

#include <algorithm>
#include <cstdio>

namespace box_query::stress {
namespace {

constexpr std::size_t kFailuresKept = 5;

}  // namespace

void Tally::merge(const Tally& other) {
  queries += other.queries;
  hits += other.hits;
  wrong += other.wrong;
  certified_decisions += other.certified_decisions;
  exact_decisions += other.exact_decisions;
  exact_roundings += other.exact_roundings;
  worst_t = std::max(worst_t, other.worst_t);
  worst_range = std::max(worst_range, other.worst_range);
  worst_distance = std::max(worst_distance, other.worst_distance);
  worst_point = std::max(worst_point, other.worst_point);
  worst_blocked = std::max(worst_blocked, other.worst_blocked);
  for (const std::string& failure : other.failures) {
    if (failures.size() < kFailuresKept) {
      failures.push_back(failure);
    }
  }
}

void Tally::fail(const std::string& input, const std::string& what) {
  ++wrong;
  if (failures.size() < kFailuresKept) {
    failures.push_back(what + "\n    " + input);
  }
}

std::string hex(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%a", value);
  return text;
}

std::string hex(const Vector3& v) {
  return "{" + hex(v[0]) + ", " + hex(v[1]) + ", " + hex(v[2]) + "}";
}

std::string hex(const Box& box) {
  if (const auto* aligned = std::get_if<AlignedBox>(&box)) {
    return "AlignedBox{" + hex(aligned->min) + ", " + hex(aligned->max) + "}";
  }
  const auto& oriented = std::get<OrientedBox>(box);
  const Quaternion& q = oriented.orientation;
  return "OrientedBox{" + hex(oriented.center) + ", Quaternion(" + hex(q.w()) + ", " + hex(q.x()) +
         ", " + hex(q.y()) + ", " + hex(q.z()) + "), " + hex(oriented.half_extents) + "}";
}

}  // namespace box_query::stress
