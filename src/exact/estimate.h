// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Parameters and ranges in double-double, with the error that decides whether they can be rounded.
#pragma once

#include "exact/bounds.h"
#include "exact/certified.h"

#include <cmath>
#include <limits>

namespace box_query::exact {

/// A real number within `error` of `value`.
struct Estimate {
  DoubleDouble value;
  double error = 0.0;

  static Estimate unknown() { return {{}, std::numeric_limits<double>::infinity()}; }
};

inline bool isPowerOfTwo(double x) {
  int exponent = 0;
  return std::fabs(std::frexp(x, &exponent)) == 0.5;
}

/// num / den.
inline Estimate quotient(const Certified& num, const Certified& den) {
  if (num.isExactZero()) {
    return Estimate();
  }
  const DoubleDouble value = num.value() / den.value();
  if (num.error() == 0.0 && den.error() == 0.0 && den.value().lo == 0.0 &&
      isPowerOfTwo(den.value().hi)) {
    return {value, 0.0};  // exact, as ties must be
  }
  const double size = std::fabs(den.value().hi);
  if (!(den.error() < 0x1p-30 * size)) {
    return Estimate::unknown();
  }
  // (num + a) / (den + b) is off by (a - b num / den) / (den + b).
  const double error = (num.error() + std::fabs(value.hi) * den.error()) / size;
  return {value, (error + std::fabs(value.hi) * bounds::kOperation) * bounds::kRelative};
}

/// a * b for an exact factor or one that is off by kOperation relative.
inline Estimate product(const Estimate& a, const DoubleDouble& b) {
  const DoubleDouble value = a.value * b;
  return {value, (a.error * std::fabs(b.hi) + std::fabs(value.hi) * (2.0 * bounds::kOperation)) *
                     bounds::kRelative};
}

/// Ziv's test: rounds to the nearest double if every number within the error rounds to the same.
/// @pre the error is 0 or at least kOperation relative: the sums below then lose none of it
inline bool round(const Estimate& x, double& rounded) {
  const double above = x.value.hi + (x.value.lo + x.error);
  const double below = x.value.hi + (x.value.lo - x.error);
  rounded = above + 0.0;  // no negative zero
  const double magnitude = std::fabs(above);
  return above == below && ((magnitude > 0x1p-900 && magnitude < 0x1p900) || x.error == 0.0);
}

}  // namespace box_query::exact
