// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Parameters at the planes of a box in double-double, for what the filter has decided.
#pragma once

#include "exact/clip.h"
#include "geometry/prepared_box.h"
#include "geometry/slabs.h"

#include <box_query/geometry.h>

namespace box_query {

/// The direction of a component along axis i of the world, exactly.
inline exact::DoubleDouble exactDirection(const Segment& segment, int i) {
  return exact::twoDiff(segment.end[i], segment.start[i]);
}
template <typename T>
exact::DoubleDouble exactDirection(const T& linear, int i) {
  return {linear.direction[i], 0.0};
}

/// Within 22u^2 times the sum of the absolute values of the products: see bounds::kRow.
inline exact::DoubleDouble dot(const exact::DoubleDouble* a, const exact::DoubleDouble* b) {
  const exact::DoubleDouble p0 = exact::twoProd(a[0].hi, b[0].hi);
  const exact::DoubleDouble p1 = exact::twoProd(a[1].hi, b[1].hi);
  const exact::DoubleDouble p2 = exact::twoProd(a[2].hi, b[2].hi);
  const double c0 = p0.lo + (a[0].hi * b[0].lo + a[0].lo * b[0].hi);
  const double c1 = p1.lo + (a[1].hi * b[1].lo + a[1].lo * b[1].hi);
  const double c2 = p2.lo + (a[2].hi * b[2].lo + a[2].lo * b[2].hi);
  const exact::DoubleDouble s = exact::twoSum(p0.hi, p1.hi);
  const exact::DoubleDouble r = exact::twoSum(s.hi, p2.hi);
  return exact::fastTwoSum(r.hi, (s.lo + r.lo) + ((c0 + c1) + c2));
}

/// Parameters at the planes of one kind of box, in double-double.
template <typename T, typename BoxType>
class Planes;

template <typename T>
class Planes<T, AlignedBox> {
 public:
  Planes(const T& linear, const DoubleComponent& component, const AlignedBox& box, const Rows*)
      : linear_(linear), component_(component), box_(box) {}

  bool isPositive(int axis) const { return !component_.negative[axis]; }

  exact::BasicParameter<exact::Certified> at(int axis, bool max_plane) const {
    const double plane = max_plane ? box_.max[axis] : box_.min[axis];
    const exact::Certified num(exact::twoDiff(plane, component_.origin[axis]), 0.0);
    const exact::Certified den(exactDirection(linear_, axis), 0.0);
    return isPositive(axis) ? exact::BasicParameter<exact::Certified>{num, den}
                            : exact::BasicParameter<exact::Certified>{-num, -den};
  }

 private:
  const T& linear_;
  const DoubleComponent& component_;
  const AlignedBox& box_;
};

template <typename T>
class Planes<T, OrientedBox> {
 public:
  Planes(const T& linear, const DoubleComponent& component, const OrientedBox& box,
         const Rows* rows)
      : box_(box), rows_(rows) {
    if (rows_ == nullptr) {
      own_rows_ = doubleDoubleRows(box.orientation);
      rows_ = &own_rows_;
    }
    for (int i = 0; i < 3; ++i) {
      offset_[i] = exact::twoDiff(component.origin[i], box.center[i]);
      direction_[i] = exactDirection(linear, i);
    }
    const double n = rows_->n.hi;
    offset_error_ = exact::bounds::kRow * n *
                    (std::fabs(offset_[0].hi) + std::fabs(offset_[1].hi) +
                     std::fabs(offset_[2].hi) + box.half_extents.sum());
    direction_error_ =
        exact::bounds::kRow * n *
        (std::fabs(direction_[0].hi) + std::fabs(direction_[1].hi) + std::fabs(direction_[2].hi));
  }

  bool isPositive(int axis) { return row(axis).direction.hi > 0.0; }

  exact::BasicParameter<exact::Certified> at(int axis, bool max_plane) {
    const Row& r = row(axis);
    const exact::DoubleDouble num = (max_plane ? r.extent : -r.extent) - r.position;
    const bool positive = r.direction.hi > 0.0;
    return {exact::Certified(positive ? num : -num, offset_error_),
            exact::Certified(positive ? r.direction : -r.direction, direction_error_)};
  }

 private:
  struct Row {
    int axis = -1;
    exact::DoubleDouble position;
    exact::DoubleDouble direction;
    exact::DoubleDouble extent;
  };

  const Row& row(int axis) {
    if (row_.axis != axis) {
      row_.axis = axis;
      row_.position = dot(rows_->axes[axis], offset_);
      row_.direction = dot(rows_->axes[axis], direction_);
      row_.extent = rows_->n * exact::DoubleDouble{box_.half_extents[axis], 0.0};
    }
    return row_;
  }

  const OrientedBox& box_;
  const Rows* rows_;
  Rows own_rows_;
  exact::DoubleDouble offset_[3];
  exact::DoubleDouble direction_[3];
  double offset_error_;
  double direction_error_;
  Row row_;
};

}  // namespace box_query
