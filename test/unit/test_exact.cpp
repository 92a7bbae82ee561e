// SPDX-License-Identifier: BSD-3-Clause
#include "exact/dyadic.h"
#include "exact/rounding.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>
#include <random>

#include <gtest/gtest.h>

namespace {
std::size_t allocations = 0;
}  // namespace

// Counts what the exact numbers take from the heap.
// (Inlined, gcc would take them for a mismatched pair.)
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  void* memory = std::malloc(size);  // NOLINT(cppcoreguidelines-no-malloc)
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace box_query::exact {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kMax = std::numeric_limits<double>::max();
constexpr double kMin = std::numeric_limits<double>::min();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();

/// Any finite double, every exponent as likely as any other.
double anyDouble(std::mt19937_64& random) {
  for (;;) {
    const std::uint64_t bits = random();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    if (std::isfinite(value)) {
      return value;
    }
  }
}

TEST(Dyadic, HoldsEveryDoubleExactly) {
  std::mt19937_64 random(1);
  for (const double x :
       {0.0, -0.0, 1.0, -1.0, kTiny, -kTiny, kMin, kMax, -kMax, 0.1, 3.0 * kTiny}) {
    EXPECT_EQ(roundedQuotient(x, 1.0), x);
  }
  for (int i = 0; i < 100000; ++i) {
    const double x = anyDouble(random);
    ASSERT_EQ(roundedQuotient(x, 1.0), x);
  }
}

TEST(Dyadic, SumsOverTheWholeRangeAreExact) {
  const Dyadic sum = Dyadic(1e300) + Dyadic(1e-300);
  EXPECT_GT(sum, Dyadic(1e300));
  EXPECT_EQ(sum - Dyadic(1e300), Dyadic(1e-300));
  EXPECT_EQ(Dyadic(kMax) + Dyadic(kTiny) - Dyadic(kMax), Dyadic(kTiny));
  EXPECT_EQ((Dyadic(0.1) + Dyadic(0.2) - Dyadic(0.1) - Dyadic(0.2)).sign(), 0);
  EXPECT_NE(Dyadic(0.1) + Dyadic(0.2), Dyadic(0.1 + 0.2));
}

TEST(Dyadic, ProductsOfManyFactorsAreExact) {
  Dyadic product = 1.0;
  for (int i = 0; i < 40; ++i) {
    product *= kTiny;
    product *= Dyadic(kMax);
  }
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(product.sign(), 1);
    product *= Dyadic(-1.0);
    EXPECT_EQ(product.sign(), -1);
    product = -product;
  }
  // kTiny * kMax = 2^-50 - 2^-103
  Dyadic factor = Dyadic(0x1p-50) - Dyadic(0x1p-103);
  Dyadic expected = 1.0;
  for (int i = 0; i < 40; ++i) {
    expected *= factor;
  }
  EXPECT_EQ(product, expected);
}

TEST(Dyadic, ComparesAsTheNumbersDo) {
  const double ordered[] = {-kMax, -1.0 - 0x1p-52, -1.0, -kMin, -kTiny, 0.0,
                            kTiny, 2 * kTiny,      kMin, 1.0,   1.5,    kMax};
  for (const double a : ordered) {
    for (const double b : ordered) {
      EXPECT_EQ(compare(Dyadic(a), Dyadic(b)), (a > b) - (a < b)) << a << " " << b;
      EXPECT_EQ(compare(Dyadic(a) * 3.0, Dyadic(b) * 3.0), (a > b) - (a < b)) << a << " " << b;
    }
  }
}

TEST(Dyadic, UsualWidthsStayOffTheHeap) {
  const double x[] = {0.1, -123.456, 7.89e-3, 1e6 / 3.0};
  const std::size_t before = allocations;
  Dyadic product = 1.0;
  for (int i = 0; i < 5; ++i) {
    for (const double factor : x) {
      product *= factor;
    }
  }
  EXPECT_NE(roundedQuotient(product, Dyadic(x[0]) * x[1]), 0.0);
  EXPECT_NE(roundedSqrt(-product, Dyadic(x[0])), 0.0);
  EXPECT_EQ(allocations, before);
}

TEST(RoundedQuotient, AgreesWithTheDivisionOfTheHardware) {
  std::mt19937_64 random(2);
  int denormal = 0;
  int infinite = 0;
  for (int i = 0; i < 300000; ++i) {
    const double a = anyDouble(random);
    // Every other quotient lands near the edges of the range.
    const double b =
        i % 2 == 0 ? anyDouble(random) : a / anyDouble(random) * (i % 4 == 1 ? 1.0 : 1.0 + 0x1p-52);
    if (b == 0.0 || !std::isfinite(b)) {
      continue;
    }
    const double quotient = a / b;
    ASSERT_EQ(roundedQuotient(a, b), quotient) << a << " / " << b;
    denormal += quotient != 0.0 && std::abs(quotient) < kMin ? 1 : 0;
    infinite += std::isinf(quotient) ? 1 : 0;
  }
  EXPECT_GT(denormal, 1000);
  EXPECT_GT(infinite, 1000);
}

TEST(RoundedQuotient, TiesGoToEvenAndAnythingMoreDoesNot) {
  const Dyadic one = 1.0;
  const Dyadic half_ulp = 0x1p-53;
  const Dyadic little = Dyadic(kTiny) * kTiny;
  EXPECT_EQ(roundedQuotient(one + half_ulp, 1.0), 1.0);
  EXPECT_EQ(roundedQuotient(one + half_ulp + little, 1.0), 1.0 + 0x1p-52);
  EXPECT_EQ(roundedQuotient(one + half_ulp - little, 1.0), 1.0);
  EXPECT_EQ(roundedQuotient(Dyadic(1.0 + 0x1p-52) + half_ulp, 1.0), 1.0 + 0x1p-51);
  EXPECT_EQ(roundedQuotient(-(one + half_ulp + little), 1.0), -1.0 - 0x1p-52);
}

TEST(RoundedQuotient, EdgesOfTheRange) {
  const Dyadic little = Dyadic(kTiny) * kTiny;
  const Dyadic tiny = kTiny;
  EXPECT_EQ(roundedQuotient(tiny, 2.0), 0.0);
  EXPECT_EQ(roundedQuotient(tiny + little, 2.0), kTiny);
  EXPECT_EQ(roundedQuotient(tiny - little, 2.0), 0.0);
  EXPECT_EQ(roundedQuotient(tiny * 3.0, 2.0), 2 * kTiny);
  EXPECT_EQ(roundedQuotient(tiny * 3.0 - little, 2.0), kTiny);
  EXPECT_EQ(roundedQuotient(tiny * 5.0, 2.0), 2 * kTiny);
  EXPECT_EQ(roundedQuotient(Dyadic(kMin) - tiny * 0.5, 1.0), kMin);
  EXPECT_EQ(roundedQuotient(Dyadic(kMin) - tiny * 0.5 - little, 1.0), kMin - kTiny);
  EXPECT_EQ(roundedQuotient(little, 1.0), 0.0);
  EXPECT_FALSE(std::signbit(roundedQuotient(-little, 1.0)));
  const Dyadic half_ulp = 0x1p970;
  EXPECT_EQ(roundedQuotient(Dyadic(kMax) + half_ulp, 1.0), kInf);
  EXPECT_EQ(roundedQuotient(Dyadic(kMax) + half_ulp - little, 1.0), kMax);
  EXPECT_EQ(roundedQuotient(-Dyadic(kMax), 0.5), -kInf);
  EXPECT_EQ(roundedQuotient(Dyadic(kMax) * kMax, little), kInf);
}

TEST(RoundedSqrt, AgreesWithTheRootOfTheHardware) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 200000; ++i) {
    const double x = std::abs(anyDouble(random));
    ASSERT_EQ(roundedSqrt(x, 1.0), std::sqrt(x)) << x;
    ASSERT_EQ(roundedSqrt(Dyadic(x) * 3.0, 3.0), std::sqrt(x)) << x;
  }
}

/// |root - sqrt(num / den)| is at most half a unit in the last place, by the squares of the
/// midpoints to the neighbours.
void expectNearestRoot(const Dyadic& num, const Dyadic& den, double root) {
  const double up = std::nextafter(root, kInf);
  const Dyadic above = (Dyadic(root) + Dyadic(up)).scaled(-1);
  EXPECT_LE(num, above * above * den);
  if (root > 0.0) {
    const double down = std::nextafter(root, 0.0);
    const Dyadic below = (Dyadic(root) + Dyadic(down)).scaled(-1);
    EXPECT_GE(num, below * below * den);
  }
}

TEST(RoundedSqrt, IsTheNearestDouble) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 50000; ++i) {
    const Dyadic a = std::abs(anyDouble(random));
    const Dyadic b = std::abs(anyDouble(random));
    const double root = roundedSqrt(a * a + b, b * b);
    if (std::isfinite(root)) {
      expectNearestRoot(a * a + b, b * b, root);
    }
  }
}

TEST(RoundedSqrt, TiesGoToEven) {
  const Dyadic little = Dyadic(kTiny) * kTiny * kTiny;
  for (const double x : {1.0, 1.0 + 0x1p-52, 0x1p-1000, kTiny, 2 * kTiny, kMin, 0.0}) {
    const double up = std::nextafter(x, kInf);
    const Dyadic middle = (Dyadic(x) + Dyadic(up)).scaled(-1);
    const double even = std::fmod(x / (up - x), 2.0) == 0.0 ? x : up;
    EXPECT_EQ(roundedSqrt(middle * middle, 1.0), even) << x;
    EXPECT_EQ(roundedSqrt(middle * middle + little, 1.0), up) << x;
    EXPECT_EQ(roundedSqrt(middle * middle - little, 1.0), x) << x;
  }
  EXPECT_EQ(roundedSqrt(Dyadic(kMax) * kMax, 1.0), kMax);
  EXPECT_EQ(roundedSqrt(Dyadic(kMax) * kMax, 0x1p-2), kInf);
}

}  // namespace
}  // namespace box_query::exact
