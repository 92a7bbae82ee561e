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

/// The parameter, num / den with den > 0, at which a component passes the face of a box on the
/// negative or the positive side of an axis.
using CertifiedParameter = exact::BasicParameter<exact::Certified>;

template <typename T>
const Vector3& startOf(const T& linear) {
  if constexpr (kHasEnd<T>) {
    return linear.start;
  } else {
    return linear.origin;
  }
}

template <typename T>
CertifiedParameter parameterAtFace(const T& linear, const AlignedBox& box, int axis,
                                   bool positive) {
  const double plane = positive ? box.max[axis] : box.min[axis];
  const exact::Certified num(exact::twoDiff(plane, startOf(linear)[axis]), 0.0);
  const exact::Certified den(exactDirection(linear, axis), 0.0);
  return den.value().hi > 0.0 ? CertifiedParameter{num, den} : CertifiedParameter{-num, -den};
}

template <typename T>
CertifiedParameter parameterAtFace(const T& linear, const OrientedBox& box, int axis,
                                   bool positive) {
  const Rows rows = doubleDoubleRows(box.orientation);
  exact::DoubleDouble offset[3];
  exact::DoubleDouble direction[3];
  double offset_size = box.half_extents.sum();
  double direction_size = 0.0;
  for (int i = 0; i < 3; ++i) {
    offset[i] = exact::twoDiff(startOf(linear)[i], box.center[i]);
    direction[i] = exactDirection(linear, i);
    offset_size += std::fabs(offset[i].hi);
    direction_size += std::fabs(direction[i].hi);
  }
  const exact::DoubleDouble extent = rows.n * exact::DoubleDouble{box.half_extents[axis], 0.0};
  const exact::DoubleDouble num = (positive ? extent : -extent) - dot(rows.axes[axis], offset);
  const exact::DoubleDouble den = dot(rows.axes[axis], direction);
  const double unit = exact::bounds::kRow * rows.n.hi;
  const bool goes_up = den.hi > 0.0;
  return {{goes_up ? num : -num, unit * offset_size},
          {goes_up ? den : -den, unit * direction_size}};
}

}  // namespace box_query
