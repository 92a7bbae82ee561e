// SPDX-License-Identifier: BSD-3-Clause
#include "ros/magnitudes.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace box_query {
namespace {

double fromBits(std::uint64_t bits) {
  double number = 0.0;
  std::memcpy(&number, &bits, sizeof(number));
  return number;
}

Magnitudes seen(const std::vector<double>& numbers) {
  Magnitudes magnitudes;
  magnitudes.see(numbers.data(), numbers.size());
  return magnitudes;
}

TEST(Magnitudes, BoundsNumbersOfAnySizeByASixteenth) {
  std::mt19937_64 random(5);
  for (int n = 0; n < 100000; ++n) {
    const double number = fromBits(random());
    if (!std::isnormal(number) || std::abs(number) > 1e308) {
      continue;
    }
    const Magnitudes magnitudes = seen({0.0, number, -0.0});
    const double magnitude = std::abs(number);
    ASSERT_GE(magnitudes.largest(), magnitude);
    ASSERT_LE(magnitudes.largest() / 2, magnitude / 2 * (1.0 + 1.0 / 16.0));
    ASSERT_LE(magnitudes.smallest(), magnitude);
    ASSERT_GE(magnitudes.smallest(), magnitude * (1.0 - 1.0 / 16.0));
  }
}

TEST(Magnitudes, FindsTheOneThatIsOutOfBoundsAtEveryPlace) {
  for (std::size_t count = 1; count < 20; ++count) {
    for (std::size_t place = 0; place < count; ++place) {
      std::vector<double> numbers(count, -3.0);
      numbers[place] = -1e9;
      EXPECT_GE(seen(numbers).largest(), 1e9);
      numbers[place] = 1e-200;
      EXPECT_LE(seen(numbers).smallest(), 1e-200);
      EXPECT_LE(seen(numbers).largest(), 3.2);
      numbers[place] = 0.0;
      EXPECT_GE(seen(numbers).smallest(), count > 1 ? 2.8 : 1e300);
    }
  }
  for (std::size_t place = 0; place < 3; ++place) {
    Magnitudes magnitudes;
    std::array<double, 3> numbers = {1.0, 1.0, 1.0};
    magnitudes.seeThree(numbers.data());
    EXPECT_LE(magnitudes.largest(), 1.1);
    numbers[place] = 1e9;
    magnitudes.seeThree(numbers.data());
    EXPECT_GE(magnitudes.largest(), 1e9);
    EXPECT_GE(magnitudes.smallest(), 0.9);
    numbers[place] = 1e-9;
    magnitudes.seeThree(numbers.data());
    EXPECT_LE(magnitudes.smallest(), 1e-9);
  }
}

TEST(Magnitudes, IsWithinNoLimitWithWhatIsNotFinite) {
  constexpr std::uint64_t kSign = std::uint64_t{1} << 63U;
  constexpr std::uint64_t kInfinity = std::uint64_t{0x7ff} << 52U;
  for (const std::uint64_t bits : {kInfinity, kInfinity + 1, kInfinity + (kInfinity >> 12U), ~kSign,
                                   ~std::uint64_t{0}, kSign | kInfinity}) {
    EXPECT_FALSE(seen({1.0, fromBits(bits)}).largest() <= std::numeric_limits<double>::infinity())
        << std::hex << bits;
  }
}

TEST(Magnitudes, TellsTheSmallestNumberFromZero) {
  for (const double number : {5e-324, -5e-324, 1e-310, 2.2250738585072014e-308}) {
    EXPECT_LE(seen({0.0, 1.0, number}).smallest(), std::abs(number));
  }
  EXPECT_EQ(seen({0.0, -0.0}).smallest(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(seen({}).smallest(), std::numeric_limits<double>::infinity());
  EXPECT_LE(seen({}).largest(), 1e-300);
}

}  // namespace
}  // namespace box_query
