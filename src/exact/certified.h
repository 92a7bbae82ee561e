// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Double-doubles that carry a bound of their own error. A bound of 0 means exact, so that touches
/// which doubles hold exactly are decided here.
#pragma once

#include "exact/bounds.h"
#include "exact/double_double.h"

#include <cmath>

namespace box_query::exact {

/// What sign() answers where the error may hide the sign.
constexpr int kUnknownSign = 2;

/// A real number within `error` of hi + lo. Only what an operation really drops adds to the error.
class Certified {
 public:
  Certified() = default;
  Certified(double value) : value_{value, 0.0} {}  // NOLINT(google-explicit-constructor)
  Certified(const DoubleDouble& value, double error) : value_(value), error_(error) {}

  const DoubleDouble& value() const { return value_; }
  double error() const { return error_; }

  /// -1, 0 or 1, or kUnknownSign.
  int sign() const {
    if (std::fabs(value_.hi) - std::fabs(value_.lo) > error_ * bounds::kInflate) {
      return value_.hi > 0.0 ? 1 : -1;
    }
    return isExactZero() ? 0 : kUnknownSign;
  }

  bool isExactZero() const { return error_ == 0.0 && value_.hi == 0.0; }

  Certified operator-() const { return {-value_, error_}; }

  friend Certified operator+(const Certified& a, const Certified& b) {
    const DoubleDouble hi = twoSum(a.value_.hi, b.value_.hi);
    const DoubleDouble lo = twoSum(a.value_.lo, b.value_.lo);
    const DoubleDouble middle = twoSum(hi.lo, lo.hi);
    const DoubleDouble sum = twoSum(hi.hi, middle.hi);
    const DoubleDouble rest = twoSum(middle.lo, lo.lo);
    const DoubleDouble tail = twoSum(sum.lo, rest.hi);
    const double dropped = std::fabs(tail.lo) + std::fabs(rest.lo);
    return {twoSum(sum.hi, tail.hi), inflate(a.error_ + b.error_ + dropped)};
  }

  friend Certified operator-(const Certified& a, const Certified& b) { return a + -b; }

  friend Certified operator*(const Certified& a, const Certified& b) {
    const DoubleDouble product = twoProd(a.value_.hi, b.value_.hi);
    const DoubleDouble left = twoProd(a.value_.hi, b.value_.lo);
    const DoubleDouble right = twoProd(a.value_.lo, b.value_.hi);
    const DoubleDouble cross = twoSum(left.hi, right.hi);
    const DoubleDouble tail = twoSum(product.lo, cross.hi);
    const double dropped = std::fabs(left.lo) + std::fabs(right.lo) + std::fabs(cross.lo) +
                           std::fabs(tail.lo) + std::fabs(a.value_.lo * b.value_.lo);
    const double carried =
        a.magnitude() * b.error_ + b.magnitude() * a.error_ + a.error_ * b.error_;
    return {twoSum(product.hi, tail.hi), inflate(dropped + carried)};
  }

 private:
  double magnitude() const { return std::fabs(value_.hi) + std::fabs(value_.lo); }
  static double inflate(double error) { return error * bounds::kInflate; }

  DoubleDouble value_;
  double error_ = 0.0;
};

}  // namespace box_query::exact
