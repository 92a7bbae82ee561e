// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_list.h"

#include "ros/magnitudes.h"

#include <cstring>
#include <utility>

namespace box_query {
namespace {

static_assert(sizeof(OrientedBox) == 10 * sizeof(double), "no padding");
static_assert(sizeof(IdentifiedBox) == sizeof(std::int64_t) + sizeof(OrientedBox), "no padding");

template <class Things>
bool sameBits(const Things& a, const Things& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(static_cast<const void*>(a.data()),
                                                           static_cast<const void*>(b.data()),
                                                           a.size() * sizeof(a.front())) == 0);
}

/// Products of coordinates and of numbers of a rotation that are 0 or not below 1e-75, and what is
/// left where such products cancel each other, are not below kSmallestCoordinate. Those numbers are
/// sums of 0, 1 and products of two numbers of a quaternion: neither they nor what is left of them
/// are below 1e-75.
constexpr double kPlainCoordinate = 1e-100;
constexpr double kPlainQuaternion = 1e-30;

}  // namespace

PointList::PointList(std::int64_t first_id, const OrientedBox& shape, std::vector<Vector3>&& points)
    : first_id_(first_id),
      shape_(shape),
      turned_(shape.orientation.vec() != Vector3::Zero()),
      rotation_(shape.orientation.normalized().toRotationMatrix()),
      points_(std::move(points)) {}

bool PointList::isSurelyWithin(double max_coordinate) const {
  Magnitudes quaternion;  // not of the matrix, which was just written: it would be waited for
  quaternion.see(shape_.orientation.coeffs().data(), 4);
  Magnitudes center;
  center.seeThree(shape_.center.data());
  Magnitudes points;
  if (!points_.empty()) {
    points.see(points_.front().data(), 3 * points_.size());
  }
  // A rotation lengthens no coordinate to twice the longest.
  return center.largest() + (turned_ ? 2.0 : 1.0) * points.largest() <= max_coordinate &&
         center.smallest() >= kPlainCoordinate && points.smallest() >= kPlainCoordinate &&
         quaternion.smallest() >= kPlainQuaternion;
}

bool PointList::isSame(const PointList& other) const {
  return first_id_ == other.first_id_ &&
         std::memcmp(static_cast<const void*>(&shape_), static_cast<const void*>(&other.shape_),
                     sizeof(shape_)) == 0 &&
         sameBits(points_, other.points_);
}

bool BoxList::isSame(const BoxList& other) const {
  if (points_ && other.points_) {
    return points_ == other.points_ || points_->isSame(*other.points_);
  }
  return !points_ && !other.points_ && sameBits(each_, other.each_);
}

void BoxList::spreadPoints() {
  const std::shared_ptr<const PointList> points = std::move(points_);
  points_ = nullptr;
  each_.reserve(points->size());
  for (std::size_t n = 0; n < points->size(); ++n) {
    each_.push_back((*points)[n]);
  }
}

}  // namespace box_query
