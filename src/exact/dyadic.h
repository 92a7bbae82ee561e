// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Exact numbers mantissa * 2^exponent: the last stage of every decision.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include <boost/multiprecision/cpp_int.hpp>

namespace box_query::exact {

/// Bits that an integer holds without touching the heap. Nothing bounds it: it grows beyond.
///
/// A comparison of two parameters of an oriented box needs about 500 bits where the coordinates are
/// within a few orders of magnitude of each other, that of two squared distances about 2000.
constexpr unsigned kInlineBits = 2048;

using Integer = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<kInlineBits, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked,
                                           std::allocator<boost::multiprecision::limb_type>>,
    boost::multiprecision::et_off>;

/// A dyadic rational: every finite double is one, and sums, differences and products of them are.
///
/// Exponents are aligned only where a sum or a comparison needs it, and a zero operand never makes
/// a number longer, so that 1e300 * 1e-300 is as short as 1 * 1.
class Dyadic {
 public:
  Dyadic() = default;

  /// The exact value of a finite double; implicit, since nothing is lost.
  Dyadic(double value) {  // NOLINT(google-explicit-constructor)
    if (value != 0.0) {
      const double fraction = std::frexp(value, &exponent_);
      auto integer = static_cast<std::int64_t>(std::ldexp(fraction, 53));
      exponent_ -= 53;
      while ((integer & 0xff) == 0) {
        integer /= 256;
        exponent_ += 8;
      }
      mantissa_ = integer;
    }
  }

  const Integer& mantissa() const { return mantissa_; }
  int exponent() const { return exponent_; }

  /// -1, 0 or 1.
  int sign() const { return mantissa_.sign(); }

  /// This number times 2^k.
  Dyadic scaled(int k) const { return Dyadic(mantissa_, exponent_ + k); }

  Dyadic operator-() const { return Dyadic(-mantissa_, exponent_); }

  friend Dyadic operator*(const Dyadic& a, const Dyadic& b) {
    return Dyadic(a.mantissa_ * b.mantissa_, a.exponent_ + b.exponent_);
  }

  friend Dyadic operator+(const Dyadic& a, const Dyadic& b) {
    if (a.sign() == 0) {
      return b;
    }
    if (b.sign() == 0) {
      return a;
    }
    if (a.exponent_ < b.exponent_) {
      return b + a;
    }
    const auto shift = static_cast<unsigned>(a.exponent_ - b.exponent_);
    return Dyadic(Integer(a.mantissa_ << shift) + b.mantissa_, b.exponent_);
  }

  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return a + -b; }

  Dyadic& operator+=(const Dyadic& b) { return *this = *this + b; }
  Dyadic& operator-=(const Dyadic& b) { return *this = *this - b; }
  Dyadic& operator*=(const Dyadic& b) { return *this = *this * b; }

  /// -1, 0 or 1 as a < b, a = b or a > b.
  friend int compare(const Dyadic& a, const Dyadic& b) {
    if (a.sign() != b.sign()) {
      return a.sign() < b.sign() ? -1 : 1;
    }
    if (a.sign() == 0) {
      return 0;
    }
    // Unequal magnitudes are told apart by their highest bits, without aligning.
    const int top_a = a.topBit();
    const int top_b = b.topBit();
    if (top_a != top_b) {
      return (top_a < top_b) == (a.sign() > 0) ? -1 : 1;
    }
    return (a - b).sign();
  }

  friend bool operator==(const Dyadic& a, const Dyadic& b) { return compare(a, b) == 0; }
  friend bool operator!=(const Dyadic& a, const Dyadic& b) { return compare(a, b) != 0; }
  friend bool operator<(const Dyadic& a, const Dyadic& b) { return compare(a, b) < 0; }
  friend bool operator>(const Dyadic& a, const Dyadic& b) { return compare(a, b) > 0; }
  friend bool operator<=(const Dyadic& a, const Dyadic& b) { return compare(a, b) <= 0; }
  friend bool operator>=(const Dyadic& a, const Dyadic& b) { return compare(a, b) >= 0; }

  friend Dyadic abs(const Dyadic& a) { return a.sign() < 0 ? -a : a; }

 private:
  Dyadic(Integer mantissa, int exponent) : mantissa_(std::move(mantissa)), exponent_(exponent) {}

  /// floor(log2 |x|) of a non-zero number.
  int topBit() const {
    return static_cast<int>(
               boost::multiprecision::msb(mantissa_.sign() < 0 ? Integer(-mantissa_) : mantissa_)) +
           exponent_;
  }

  Integer mantissa_ = 0;
  int exponent_ = 0;
};

}  // namespace box_query::exact
