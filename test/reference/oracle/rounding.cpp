// SPDX-License-Identifier: BSD-3-Clause
#include "reference/oracle/rounding.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace box_query::oracle {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kMax = std::numeric_limits<double>::max();

bool isEven(double x) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  return (bits & 1U) == 0;
}

/// x, or 2^1024 for infinity: where the doubles would go on if the exponent had one more bit.
Dyadic extended(double x) {
  return x == kInf ? Dyadic(1.0).scaled(1024) : Dyadic(x);
}

Dyadic gapAbove(double x) {
  return extended(std::nextafter(x, kInf)) - Dyadic(x);
}

/// Whether every number that rounds to x >= 0 includes one, v >= 0, about which `compareWith(m)`
/// tells the sign of v - m for any m >= 0.
template <typename CompareWith>
bool roundsTo(double x, const CompareWith& compareWith) {
  const int tie_allowed = isEven(x) ? 0 : 1;
  if (x > 0.0) {
    const double below = std::nextafter(x, 0.0);
    if (compareWith((extended(x) + Dyadic(below)).scaled(-1)) < tie_allowed) {
      return false;
    }
  }
  if (x == kInf) {
    return true;
  }
  return compareWith((Dyadic(x) + extended(std::nextafter(x, kInf))).scaled(-1)) <= -tie_allowed;
}

Fraction negated(const Fraction& value) {
  return {-value.numerator, value.denominator};
}

}  // namespace

bool isCorrectlyRounded(double x, const Fraction& value) {
  if (std::isnan(x)) {
    return false;
  }
  const int sign = value.numerator.sign();
  if (sign < 0) {
    return x <= 0.0 && isCorrectlyRounded(-x, negated(value));
  }
  return x >= 0.0 && roundsTo(std::abs(x), [&value](const Dyadic& m) {
           return compare(value.numerator, m * value.denominator);
         });
}

bool isCorrectlyRounded(double x, const Bound& value) {
  return value.infinity != 0 ? x == value.infinity * kInf : isCorrectlyRounded(x, value.value);
}

bool isCorrectlyRoundedSqrt(double x, const Fraction& square_) {
  return x >= 0.0 && roundsTo(std::abs(x), [&square_](const Dyadic& m) {
           return compare(square_.numerator, square(m) * square_.denominator);
         });
}

double ulpError(double x, const Fraction& value) {
  if (!std::isfinite(x)) {
    return isCorrectlyRounded(x, value) ? 0.0 : kInf;
  }
  const Dyadic error = Dyadic(x) * value.denominator - value.numerator;
  return std::abs(approximateRatio(error, value.denominator * gapAbove(std::abs(x))));
}

double ulpError(double x, const Bound& value) {
  if (value.infinity != 0) {
    return x == value.infinity * kInf ? 0.0 : kInf;
  }
  return ulpError(x, value.value);
}

double ulpErrorSqrt(double x, const Fraction& square_) {
  if (!std::isfinite(x)) {
    return isCorrectlyRoundedSqrt(x, square_) ? 0.0 : kInf;
  }
  if (x < 0.0) {
    return kInf;
  }
  // x - r = (x^2 - r^2) / (x + r), divided by the gap g. The difference is exact; r / g is needed
  // to a few digits only.
  const Dyadic gap = gapAbove(x);
  const Dyadic difference = square(Dyadic(x)) * square_.denominator - square_.numerator;
  const Dyadic gaps_squared = square(gap) * square_.denominator;
  const double sum =
      approximateRatio(x, gap) + std::sqrt(approximateRatio(square_.numerator, gaps_squared));
  return sum == 0.0 ? 0.0 : std::abs(approximateRatio(difference, gaps_squared)) / sum;
}

int stepsBefore(double x, const Root& root, int limit) {
  if (!std::isfinite(x) || compare(Root(x), root) > 0) {
    return -1;
  }
  for (int steps = 0; steps < limit; ++steps) {
    x = std::nextafter(x, kInf);
    if (x > kMax || compare(Root(x), root) > 0) {
      return steps;
    }
  }
  return limit;
}

}  // namespace box_query::oracle
