// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Test-intersection by the method of separating axes (paper, section 2), without a division and
/// without the parameters that nobody asked for.
///
/// In the frame of the box, up to a positive factor, the component is t d and the box is below_i <=
/// x_i <= above_i: with c = below + above and e = above - below, twice the paper's -Y and E. The
/// cross products of d and two box axes do not separate where
///   |c_j d_k - c_k d_j| <= e_j |d_k| + e_k |d_j|,
/// which is that the intervals of the two slabs overlap; a ray and a segment have the box axes too.
/// By Helly's theorem on intervals no other axis is needed, also for flat, line and point boxes.
#pragma once

#include "exact/clip.h"

namespace box_query::exact {

template <typename Number>
Number withSign(const Number& x, int sign) {
  return sign < 0 ? -x : x;
}

/// 1 if the component meets the closed box, 0 if it does not, kUnknownSign if the arithmetic cannot
/// tell.
template <typename Number>
int meetsBySeparatingAxes(const BasicSlabs<Number>& slabs, bool has_start, bool has_end) {
  int direction[3];
  int below[3];
  int above[3];
  for (std::size_t i = 0; i < 3; ++i) {
    direction[i] = slabs.direction[i].sign();
    below[i] = slabs.below[i].sign();
    above[i] = slabs.above[i].sign();
    if (direction[i] == kUnknownSign || below[i] == kUnknownSign || above[i] == kUnknownSign) {
      return kUnknownSign;
    }
  }
  const bool is_point = direction[0] == 0 && direction[1] == 0 && direction[2] == 0;
  bool is_unknown = false;
  // Box axes: of a line only where it is a point, of a segment with both its ends.
  for (std::size_t i = 0; i < 3 && (has_start || is_point); ++i) {
    const bool beyond = below[i] > 0;
    if (!beyond && !(above[i] < 0)) {
      continue;  // the start is between the planes
    }
    if (direction[i] == 0 || (direction[i] > 0) != beyond) {
      return 0;  // it stays outside, or goes away
    }
    if (has_end) {
      const int reaches = beyond ? (slabs.direction[i] - slabs.below[i]).sign()
                                 : (slabs.above[i] - slabs.direction[i]).sign();
      if (reaches == kUnknownSign) {
        is_unknown = true;
      } else if (reaches < 0) {
        return 0;
      }
    }
  }
  if (is_point) {
    return 1;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    if (direction[j] == 0 && direction[k] == 0) {
      continue;
    }
    const Number& d_j = slabs.direction[j];
    const Number& d_k = slabs.direction[k];
    const Number distance =
        (slabs.below[j] + slabs.above[j]) * d_k - (slabs.below[k] + slabs.above[k]) * d_j;
    const Number radius = (slabs.above[j] - slabs.below[j]) * withSign(d_k, direction[k]) +
                          (slabs.above[k] - slabs.below[k]) * withSign(d_j, direction[j]);
    const int on_one_side = (radius - distance).sign();
    const int on_other_side = (radius + distance).sign();
    if (on_one_side == -1 || on_other_side == -1) {
      return 0;
    }
    is_unknown = is_unknown || on_one_side == kUnknownSign || on_other_side == kUnknownSign;
  }
  return is_unknown ? kUnknownSign : 1;
}

}  // namespace box_query::exact
