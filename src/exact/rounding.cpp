// SPDX-License-Identifier: BSD-3-Clause
#include "exact/rounding.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace box_query::exact {
namespace {

constexpr int kDigits = std::numeric_limits<double>::digits;
/// The exponent of the smallest positive double, 2^-1074.
constexpr int kLowestExponent = std::numeric_limits<double>::min_exponent - kDigits;
/// Bits of a truncated result that decide its rounding: those of a double, the half, and one more,
/// so that `inexact` never has to tell a tie from its neighbours alone.
constexpr int kResultBits = kDigits + 2;

int bitLength(const Integer& positive) {
  return static_cast<int>(boost::multiprecision::msb(positive)) + 1;
}

/// Rounds a value v with bits * 2^exponent <= v < (bits + 1) * 2^exponent; `inexact` says that the
/// first is not an equality.
/// @pre 2^(kResultBits - 1) <= bits < 2^63
double round(std::uint64_t bits, bool inexact, int exponent) {
  int length = kResultBits;
  while ((bits >> length) != 0) {
    ++length;
  }
  // How many low bits a double cannot hold: more of them where the result is denormal.
  const int drop = std::max(length - kDigits, kLowestExponent - exponent);
  if (drop > 63) {
    return 0.0;
  }
  const std::uint64_t half = std::uint64_t{1} << (drop - 1);
  const std::uint64_t tail = bits & (2 * half - 1);
  std::uint64_t kept = bits >> (drop - 1) >> 1;
  if (tail > half || (tail == half && (inexact || (kept & 1U) != 0))) {
    ++kept;
  }
  return std::ldexp(static_cast<double>(kept), exponent + drop);
}

/// floor(num / den * 2^shift), with whether that lost anything.
struct Quotient {
  Integer floor;
  bool inexact;
};

Quotient shiftedQuotient(Integer num, Integer den, int shift) {
  if (shift >= 0) {
    num <<= static_cast<unsigned>(shift);
  } else {
    den <<= static_cast<unsigned>(-shift);
  }
  Integer quotient;
  Integer remainder;
  boost::multiprecision::divide_qr(num, den, quotient, remainder);
  return {quotient, !remainder.is_zero()};
}

Integer magnitude(const Integer& x) {
  return x.sign() < 0 ? Integer(-x) : x;
}

}  // namespace

double roundedQuotient(const Dyadic& num, const Dyadic& den) {
  if (num.sign() == 0) {
    return 0.0;
  }
  const Integer n = magnitude(num.mantissa());
  const Integer d = magnitude(den.mantissa());
  const int shift = kResultBits - (bitLength(n) - bitLength(d));
  const Quotient q = shiftedQuotient(n, d, shift);
  const double rounded = round(static_cast<std::uint64_t>(q.floor), q.inexact,
                               num.exponent() - den.exponent() - shift);
  return num.sign() == den.sign() || rounded == 0.0 ? rounded : -rounded;
}

double roundedSqrt(const Dyadic& num, const Dyadic& den) {
  if (num.sign() == 0) {
    return 0.0;
  }
  const int exponent = num.exponent() - den.exponent();
  int shift = 2 * kResultBits - (bitLength(num.mantissa()) - bitLength(den.mantissa()));
  shift += (exponent - shift) & 1;  // an even exponent has an exact root
  const Quotient q = shiftedQuotient(num.mantissa(), den.mantissa(), shift);

  // One Newton step from a double lands within one of floor(sqrt(floor)), which is floor(sqrt).
  Integer root(static_cast<std::uint64_t>(std::sqrt(static_cast<double>(q.floor))));
  root = (root + q.floor / root) / 2;
  while (root * root > q.floor) {
    --root;
  }
  while (Integer(root + 1) * (root + 1) <= q.floor) {
    ++root;
  }
  return round(static_cast<std::uint64_t>(root), q.inexact || root * root != q.floor,
               (exponent - shift) / 2);
}

double finiteCoordinate(double x) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  return x > kLargest ? kLargest : x < -kLargest ? -kLargest : x;
}

}  // namespace box_query::exact
