// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Changes of a sample that are exact in doubles.
#pragma once

#include "stress/target.h"

#include <cmath>
#include <utility>

namespace box_query::stress {

inline OrientedBox* orientedBox(Sample& sample) {
  return std::get_if<OrientedBox>(&sample.box);
}
inline AlignedBox* alignedBox(Sample& sample) {
  return std::get_if<AlignedBox>(&sample.box);
}

/// v * 2^power if that is exact.
inline bool scale(Vector3& v, int power) {
  for (double& x : numbersOf(v)) {
    const double scaled = std::ldexp(x, power);
    if (std::ldexp(scaled, -power) != x || !std::isfinite(scaled)) {
      return false;
    }
    x = scaled;
  }
  return true;
}

/// q times the imaginary unit of an axis, and that unit times q.
inline Quaternion timesUnit(const Quaternion& q, int axis) {
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  return axis == 0   ? Quaternion(-x, w, z, -y)
         : axis == 1 ? Quaternion(-y, -z, w, x)
                     : Quaternion(-z, y, -x, w);
}
inline Quaternion unitTimes(const Quaternion& q, int axis) {
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  return axis == 0   ? Quaternion(-x, w, -z, y)
         : axis == 1 ? Quaternion(-y, z, w, -x)
                     : Quaternion(-z, -y, x, w);
}

/// Negates a coordinate of everything.
inline void flip(Sample& s, int axis) {
  for (Vector3* v : {&s.origin, &s.direction, &s.end}) {
    (*v)[axis] = -(*v)[axis];
  }
  if (OrientedBox* const box = orientedBox(s)) {
    box->center[axis] = -box->center[axis];
  } else {
    AlignedBox& aligned = *alignedBox(s);
    aligned.min[axis] = -std::exchange(aligned.max[axis], -aligned.min[axis]);
  }
}

/// v + by if that is exact.
inline bool translate(Vector3& v, const Vector3& by) {
  for (int i = 0; i < 3; ++i) {
    const double sum = v[i] + by[i];
    const double part = sum - v[i];  // Knuth's exact error of a sum
    if ((v[i] - (sum - part)) + (by[i] - part) != 0.0 || !std::isfinite(sum)) {
      return false;
    }
    v[i] = sum;
  }
  return true;
}

/// A sample on a grid of 2^-20, so that there are exact translations.
inline bool snapToGrid(Sample& s) {
  const auto snap = [](Vector3& v) {
    for (double& x : numbersOf(v)) {
      if (!(std::fabs(x) < 0x1p20)) {
        return false;
      }
      x = std::ldexp(std::nearbyint(std::ldexp(x, 20)), -20);
    }
    return true;
  };
  bool snapped = snap(s.origin) && snap(s.end);
  if (OrientedBox* const box = orientedBox(s)) {
    snapped = snapped && snap(box->center);
  } else {
    snapped = snapped && snap(alignedBox(s)->min) && snap(alignedBox(s)->max);
  }
  return snapped;
}

}  // namespace box_query::stress
