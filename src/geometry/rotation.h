// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The rotation matrix of an oriented box in double, the same bits everywhere.
#pragma once

#include <box_query/geometry.h>

#include <cmath>

namespace box_query {

/// Row-major columns: axis i of the box is (axes[i][0], axes[i][1], axes[i][2]).
struct Axes {
  double of[3][3];
};

/// The axes of a box, that is the columns of M / |q|^2 in the terms of exact/clip.h, each entry
/// within bounds::kAxis of the exact one.
/// @pre q is finite and not zero
inline Axes boxAxes(const Quaternion& q) noexcept {
  double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  double n = (w * w + x * x) + (y * y + z * z);
  if (!(n > 0x1p-200 && n < 0x1p200)) {  // squares might have been lost: scale, which is exact
    const double largest =
        std::fmax(std::fmax(std::fabs(w), std::fabs(x)), std::fmax(std::fabs(y), std::fabs(z)));
    const int k = -std::ilogb(largest);
    w = std::ldexp(w, k), x = std::ldexp(x, k), y = std::ldexp(y, k), z = std::ldexp(z, k);
    n = (w * w + x * x) + (y * y + z * z);
  }
  const double r = 1.0 / n;
  const double ww = w * w, xx = x * x, yy = y * y, zz = z * z;
  const double xy = x * y, xz = x * z, yz = y * z, wx = w * x, wy = w * y, wz = w * z;
  const double r2 = 2.0 * r;
  return {{{((ww - zz) + (xx - yy)) * r, (xy + wz) * r2, (xz - wy) * r2},
           {(xy - wz) * r2, ((ww - zz) - (xx - yy)) * r, (yz + wx) * r2},
           {(xz + wy) * r2, (yz - wx) * r2, ((ww + zz) - (xx + yy)) * r}}};
}

}  // namespace box_query
