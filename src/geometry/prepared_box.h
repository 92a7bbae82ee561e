// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the filter keeps of a box, made once for a Scene and once a call for a lone box.
#pragma once

#include "exact/double_double.h"
#include "geometry/rotation.h"
#include "geometry/slabs.h"

#include <box_query/geometry.h>

namespace box_query {

inline bool isModerate(const AlignedBox& box) {
  return isModerate(box.min) && isModerate(box.max);
}
inline bool isModerate(const OrientedBox& box) {
  return isModerate(box.center) && isModerate(box.half_extents);
}

inline bool isCompact(const AlignedBox& box) {
  return isCompact(box.min) && isCompact(box.max);
}
inline bool isCompact(const OrientedBox& box) {
  const Quaternion& q = box.orientation;
  return isCompact(box.center) && isCompact(box.half_extents) && isCompact(q.w()) &&
         isCompact(q.x()) && isCompact(q.y()) && isCompact(q.z());
}

inline AlignedSlabs doubleSlabs(const AlignedBox& box) {
  return {{{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}}};
}

inline OrientedSlabs doubleSlabs(const OrientedBox& box) {
  const Axes axes = boxAxes(box.orientation);
  OrientedSlabs slabs;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      slabs.axes[i][j] = axes.of[i][j];
    }
    slabs.center[i] = box.center[i];
    slabs.half_extents[i] = box.half_extents[i];
  }
  slabs.padded_extent_sum =
      ((slabs.half_extents[0] + slabs.half_extents[1]) + slabs.half_extents[2]) +
      exact::bounds::kUnderflow / exact::bounds::kSlab;
  return slabs;
}

/// A box as the filter sees it.
template <typename SlabsType>
struct Prepared {
  SlabsType slabs;
  bool moderate;  ///< the filter may take it
};

template <typename BoxType>
auto prepared(const BoxType& box) {
  return Prepared<decltype(doubleSlabs(box))>{doubleSlabs(box), isModerate(box)};
}

/// The unnormalised frame of an oriented box in double-double: n = |q|^2, axes[i] = column i of n
/// R.
struct Rows {
  exact::DoubleDouble axes[3][3];
  exact::DoubleDouble n;
};

/// @pre isCompact(box)
inline Rows doubleDoubleRows(const Quaternion& q) {
  using exact::twoProd;
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const auto ww = twoProd(w, w), xx = twoProd(x, x), yy = twoProd(y, y), zz = twoProd(z, z);
  const auto xy = twoProd(2 * x, y), xz = twoProd(2 * x, z), yz = twoProd(2 * y, z);
  const auto wx = twoProd(2 * w, x), wy = twoProd(2 * w, y), wz = twoProd(2 * w, z);
  const auto ww_zz = ww - zz, xx_yy = xx - yy, ww_plus_zz = ww + zz, xx_plus_yy = xx + yy;
  return {{{ww_zz + xx_yy, xy + wz, xz - wy},
           {xy - wz, ww_zz - xx_yy, yz + wx},
           {xz + wy, yz - wx, ww_plus_zz - xx_plus_yy}},
          ww_plus_zz + xx_plus_yy};
}

}  // namespace box_query
