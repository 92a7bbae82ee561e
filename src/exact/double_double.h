// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Error-free transformations, and sums of two doubles built on them.
///
/// Dekker, "A floating-point technique for extending the available precision", 1971; Joldes, Muller
/// and Popescu, "Tight and rigorous error bounds for basic building blocks of double-word
/// arithmetic", ACM TOMS 2017. Valid without overflow and underflow: the callers see to that.
#pragma once

#include "exact/float_model.h"

#include <cmath>

namespace box_query::exact {

/// The unevaluated sum hi + lo.
struct DoubleDouble {
  double hi = 0.0;
  double lo = 0.0;
};

/// a + b = hi + lo exactly.
inline DoubleDouble twoSum(double a, double b) {
  const double sum = a + b;
  const double rest = sum - a;
  return {sum, (a - (sum - rest)) + (b - rest)};
}

/// a - b = hi + lo exactly.
inline DoubleDouble twoDiff(double a, double b) {
  return twoSum(a, -b);
}

/// a + b = hi + lo exactly, if |a| >= |b| or a = 0.
inline DoubleDouble fastTwoSum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a * b = hi + lo exactly: the same two doubles with and without FMA.
inline DoubleDouble twoProd(double a, double b) {
  const double product = a * b;
#ifdef __FMA__
  return {product, std::fma(a, b, -product)};
#else
  constexpr double kSplitter = 0x1p27 + 1.0;
  const double scaled_a = kSplitter * a;
  const double a_hi = scaled_a - (scaled_a - a);
  const double a_lo = a - a_hi;
  const double scaled_b = kSplitter * b;
  const double b_hi = scaled_b - (scaled_b - b);
  const double b_lo = b - b_hi;
  return {product, ((a_hi * b_hi - product) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo};
#endif
}

inline DoubleDouble operator-(const DoubleDouble& a) {
  return {-a.hi, -a.lo};
}

/// Within 3u^2 (|a| + |b|).
inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble sum = twoSum(a.hi, b.hi);
  return fastTwoSum(sum.hi, sum.lo + (a.lo + b.lo));
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
  return a + -b;
}

/// Relative error at most 7u^2.
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = twoProd(a.hi, b.hi);
  return fastTwoSum(product.hi, product.lo + (a.hi * b.lo + a.lo * b.hi));
}

/// Relative error at most 32u^2.
inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double quotient = a.hi / b.hi;
  const DoubleDouble product = twoProd(quotient, b.hi);
  const double rest = ((a.hi - product.hi) - product.lo) + (a.lo - quotient * b.lo);
  return fastTwoSum(quotient, rest / b.hi);
}

/// Relative error at most 32u^2.
/// @pre a.hi > 0
inline DoubleDouble sqrt(const DoubleDouble& a) {
  const double root = std::sqrt(a.hi);
  const DoubleDouble square = twoProd(root, root);
  const double rest = ((a.hi - square.hi) - square.lo) + a.lo;
  return fastTwoSum(root, rest / (2.0 * root));
}

}  // namespace box_query::exact
