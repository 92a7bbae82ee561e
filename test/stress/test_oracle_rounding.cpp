// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the oracle calls correctly rounded, against what the processor rounds correctly.
#include "reference/oracle.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace box_query {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kDenormal = std::numeric_limits<double>::denorm_min();

/// A double of any exponent, denormals included.
double anyMagnitude(std::mt19937_64& engine) {
  const double mantissa = 1.0 + std::ldexp(static_cast<double>(engine() >> 12U), -52);
  return std::ldexp(mantissa, static_cast<int>(engine() % 2098) - 1074);
}

TEST(OracleRounding, AcceptsTheQuotientOfTheProcessorAndNoOther) {
  std::mt19937_64 engine(1);
  int infinite = 0;
  int denormal = 0;
  for (int i = 0; i < 100000; ++i) {
    const double sign = engine() % 2 == 0 ? 1.0 : -1.0;
    const double a = sign * anyMagnitude(engine);
    const double b =
        i % 4 == 0 ? std::ldexp(1.0, static_cast<int>(engine() % 200)) : anyMagnitude(engine);
    const oracle::Fraction exact{a, b};
    const double quotient = a / b;
    ASSERT_TRUE(oracle::isCorrectlyRounded(quotient, exact)) << a << " / " << b;
    ASSERT_LE(oracle::ulpError(quotient, exact), 0.5);
    infinite += std::isinf(quotient) ? 1 : 0;
    denormal += std::abs(quotient) < std::numeric_limits<double>::min() ? 1 : 0;
    for (const double other : {std::nextafter(quotient, kInf), std::nextafter(quotient, -kInf)}) {
      if (other != quotient) {
        ASSERT_FALSE(oracle::isCorrectlyRounded(other, exact)) << a << " / " << b;
      }
    }
  }
  EXPECT_GT(infinite, 1000);
  EXPECT_GT(denormal, 1000);
}

TEST(OracleRounding, AcceptsTheRootOfTheProcessorAndNoOther) {
  std::mt19937_64 engine(2);
  for (int i = 0; i < 100000; ++i) {
    double a = anyMagnitude(engine);
    if (i % 3 == 0) {
      const auto root = static_cast<double>(engine() % 90000000U);
      a = root * root;
    }
    const oracle::Fraction exact{a, 1.0};
    const double root = std::sqrt(a);
    ASSERT_TRUE(oracle::isCorrectlyRoundedSqrt(root, exact)) << a;
    ASSERT_LE(oracle::ulpErrorSqrt(root, exact), 0.5);
    for (const double other : {std::nextafter(root, kInf), std::nextafter(root, 0.0)}) {
      if (other != root) {
        ASSERT_FALSE(oracle::isCorrectlyRoundedSqrt(other, exact)) << a;
      }
    }
  }
}

TEST(OracleRounding, TiesGoToEven) {
  const double ulp = std::numeric_limits<double>::epsilon();
  const oracle::Dyadic half_way = oracle::Dyadic(1.0) + oracle::Dyadic(0.5 * ulp);
  for (const int sign : {1, -1}) {
    const oracle::Fraction value{sign > 0 ? half_way : -half_way, 1.0};
    EXPECT_TRUE(oracle::isCorrectlyRounded(sign * 1.0, value));
    EXPECT_FALSE(oracle::isCorrectlyRounded(sign * (1.0 + ulp), value));
    EXPECT_EQ(oracle::ulpError(sign * 1.0, value), 0.5);
  }
  const oracle::Dyadic next_half_way = oracle::Dyadic(1.0 + ulp) + oracle::Dyadic(0.5 * ulp);
  EXPECT_FALSE(oracle::isCorrectlyRounded(1.0 + ulp, oracle::Fraction{next_half_way, 1.0}));
  EXPECT_TRUE(oracle::isCorrectlyRounded(1.0 + 2.0 * ulp, oracle::Fraction{next_half_way, 1.0}));
  const oracle::Fraction squared{square(half_way), 1.0};
  EXPECT_TRUE(oracle::isCorrectlyRoundedSqrt(1.0, squared));
  EXPECT_FALSE(oracle::isCorrectlyRoundedSqrt(1.0 + ulp, squared));
}

TEST(OracleRounding, TooLargeIsInfiniteAndTooSmallIsZero) {
  const double max = std::numeric_limits<double>::max();
  const oracle::Dyadic top = oracle::Dyadic(1.0).scaled(1024);
  const oracle::Dyadic half_way = top - oracle::Dyadic(1.0).scaled(970);
  EXPECT_TRUE(oracle::isCorrectlyRounded(kInf, oracle::Fraction{half_way, 1.0}));
  EXPECT_FALSE(oracle::isCorrectlyRounded(max, oracle::Fraction{half_way, 1.0}));
  const oracle::Fraction just_below{half_way - oracle::Dyadic(kDenormal), 1.0};
  EXPECT_TRUE(oracle::isCorrectlyRounded(max, just_below));
  EXPECT_FALSE(oracle::isCorrectlyRounded(kInf, just_below));
  EXPECT_TRUE(oracle::isCorrectlyRounded(-kInf, oracle::Fraction{-half_way, 1.0}));
  EXPECT_EQ(oracle::ulpError(kInf, oracle::Fraction{half_way, 1.0}), 0.0);
  EXPECT_EQ(oracle::ulpError(kInf, just_below), kInf);

  const oracle::Dyadic half_denormal = oracle::Dyadic(kDenormal).scaled(-1);
  EXPECT_TRUE(oracle::isCorrectlyRounded(0.0, oracle::Fraction{half_denormal, 1.0}));
  EXPECT_FALSE(oracle::isCorrectlyRounded(kDenormal, oracle::Fraction{half_denormal, 1.0}));
  const oracle::Fraction just_above{half_denormal + half_denormal.scaled(-100), 1.0};
  EXPECT_TRUE(oracle::isCorrectlyRounded(kDenormal, just_above));
  EXPECT_FALSE(oracle::isCorrectlyRounded(0.0, just_above));
  EXPECT_FALSE(oracle::isCorrectlyRounded(std::numeric_limits<double>::quiet_NaN(), just_above));
}

TEST(OraclePoints, ErrorsAreCountedInUlpsOfTheScale) {
  const Segment segment{Vector3(-4.0, 0.0, 3.0), Vector3(4.0, 0.0, 3.0)};
  const OrientedBox box{Vector3(0.0, 0.0, 0.5), Quaternion(1.0, 0.0, 0.0, 1.0),
                        Vector3(2.0, 1.0, 1.0)};
  const oracle::Nearest best = oracle::nearest(segment, box);
  EXPECT_EQ(oracle::approximate(best.squared), 2.25);
  EXPECT_EQ(oracle::approximate(best.t), 0.375);
  const double scale = std::max(oracle::largestCoordinate(segment), oracle::largestCoordinate(box));
  EXPECT_EQ(scale, 4.0);
  const double ulp = 4.0 * std::numeric_limits<double>::epsilon();
  EXPECT_EQ(oracle::pointError(Vector3(-1.0, 0.0, 3.0), oracle::pointAt(segment, best.t), scale),
            0.0);
  EXPECT_EQ(oracle::pointError(Vector3(-1.0, ulp, 1.5 - 2.0 * ulp),
                               oracle::nearestOnBox(segment, box, best.t), scale),
            2.0);
  EXPECT_EQ(oracle::pointError(Vector3::Constant(kInf), oracle::pointAt(segment, best.t), scale),
            kInf);
}

}  // namespace
}  // namespace box_query
