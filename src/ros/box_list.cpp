// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_list.h"

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

bool isTurned(const Quaternion& orientation) {
  return orientation.vec() != Vector3::Zero();
}

}  // namespace

BoxList::Reader::Reader(const BoxList& list) : list_(&list) {
  if (list.arePoints() && isTurned(list.each_.front().box.orientation)) {
    turned_ = true;
    rotation_ = list.each_.front().box.orientation.normalized().toRotationMatrix();
  }
}

void BoxList::setPoints(std::int64_t first_id, const OrientedBox& shape, const WireArray& points) {
  each_.clear();
  points_.clear();
  if (points.count > 0) {
    each_.emplace_back(first_id, shape.center, shape.orientation, shape.half_extents);
    points_.resize(points.count);
    std::memcpy(static_cast<void*>(points_.data()), points.elements.bytes(),
                points.count * sizeof(Vector3));
  }
}

bool BoxList::isSame(const BoxList& other) const {
  return sameBits(points_, other.points_) && sameBits(each_, other.each_);
}

void BoxList::spreadPoints() {
  const BoxList list = std::move(*this);
  clear();
  each_.reserve(list.size());
  for (const IdentifiedBox& box : list) {
    each_.push_back(box);
  }
}

bool areSurelyWithin(double max_coordinate, const Vector3& center, const Quaternion& orientation,
                     const Magnitudes& points) {
  Magnitudes of_orientation;
  of_orientation.see(orientation.coeffs().data(), 4);
  Magnitudes of_center;
  of_center.seeThree(center.data());
  // A rotation lengthens no coordinate to twice the longest.
  const double reach = (isTurned(orientation) ? 2.0 : 1.0) * points.largest();
  return of_center.largest() + reach <= max_coordinate &&
         of_center.smallest() >= kPlainCoordinate && points.smallest() >= kPlainCoordinate &&
         of_orientation.smallest() >= kPlainQuaternion;
}

}  // namespace box_query
