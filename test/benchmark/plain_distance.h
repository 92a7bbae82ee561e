// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The distance of a segment from a box as a program has it that trusts its doubles.
#pragma once

#include "benchmark/methods_slab.h"

#include <algorithm>
#include <cmath>

namespace box_query::benchmark {

/// The squared distance along a segment is convex, and its derivative is linear between the places
/// where the segment crosses planes of faces: look at all of these, and interpolate between the two
/// next to its zero.
inline double plainDistance(const SlabComponent<double>& segment, const SlabBox<double>& box) {
  double p[3];
  double d[3];
  for (int i = 0; i < 3; ++i) {
    p[i] = 0.0;
    d[i] = 0.0;
    for (int k = 0; k < 3; ++k) {
      p[i] += box.axes[i][k] * (segment.origin[k] - box.center[k]);
      d[i] += box.axes[i][k] * segment.direction[k];
    }
  }
  const auto excess = [&](int i, double t) {
    const double x = p[i] + t * d[i];
    return x - std::min(std::max(x, -box.half_extents[i]), box.half_extents[i]);
  };
  const auto slope = [&](double t) {
    return d[0] * excess(0, t) + d[1] * excess(1, t) + d[2] * excess(2, t);
  };
  double t0 = 0.0;
  double t1 = 1.0;
  double slope0 = slope(t0);
  double slope1 = slope(t1);
  const auto look = [&](double t) {
    if (t > t0 && t < t1) {
      const double s = slope(t);
      (s <= 0.0 ? t0 : t1) = t;
      (s <= 0.0 ? slope0 : slope1) = s;
    }
  };
  if (slope0 < 0.0 && slope1 > 0.0) {
    for (int i = 0; i < 3; ++i) {
      look((-box.half_extents[i] - p[i]) / d[i]);
      look((box.half_extents[i] - p[i]) / d[i]);
    }
  }
  const double t = slope0 >= 0.0   ? t0
                   : slope1 <= 0.0 ? t1
                                   : t0 + (t1 - t0) * slope0 / (slope0 - slope1);
  return std::sqrt(excess(0, t) * excess(0, t) + excess(1, t) * excess(1, t) +
                   excess(2, t) * excess(2, t));
}

}  // namespace box_query::benchmark
