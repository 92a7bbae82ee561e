// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_checks.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace box_query {
namespace {

constexpr double kLimit = 1e7;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Numbers {
  double center[3] = {1.0, -2.0, 0.0};
  double orientation[4] = {0.0, 0.0, 0.6, 0.8};
  double size[3] = {0.0, 2.0, 3.0};
};

/// Whether some boxes are surely good, one of which is this.
bool isSure(const Numbers& box, int others = 0) {
  BoxChecks checks;
  const Numbers good;
  for (int n = 0; n < others; ++n) {
    checks.see(good.center, good.orientation, good.size);
  }
  checks.see(box.center, box.orientation, box.size);
  for (int n = 0; n < others; ++n) {
    checks.see(good.center, good.orientation, good.size);
  }
  return checks.areSurelyGood(kLimit);
}

/// What counts: what is said of each box on its own.
bool isAccepted(const Numbers& box) {
  BoxChange change(kLimit);
  change.add(0, Vector3(box.center), Quaternion(box.orientation), Vector3(box.size));
  return change.boxes.size() == 1;
}

TEST(BoxChecks, AreSureOfUsualBoxes) {
  EXPECT_TRUE(BoxChecks().areSurelyGood(kLimit)) << "of none";
  Numbers box;
  EXPECT_TRUE(isSure(box, 1));
  for (const double norm : {0.991, 1.0 - 1e-6, 1.0 + 1e-6, 1.009}) {
    box.orientation[2] = 0.6 * norm;
    box.orientation[3] = 0.8 * norm;
    EXPECT_TRUE(isSure(box)) << norm;
  }
  box.center[2] = -9e6;
  EXPECT_TRUE(isSure(box));
}

TEST(BoxChecks, SeeWhatIsBadAtEveryPlaceBehindAndBeforeOthers) {
  const auto expectBad = [](std::size_t place, double number) {
    Numbers box;
    double* const numbers[] = {&box.center[0],      &box.center[1],      &box.center[2],
                               &box.orientation[0], &box.orientation[1], &box.orientation[2],
                               &box.orientation[3], &box.size[0],        &box.size[1],
                               &box.size[2]};
    *numbers[place] = number;
    ASSERT_FALSE(isAccepted(box)) << place << " " << number;
    EXPECT_FALSE(isSure(box, 0)) << place << " " << number;
    EXPECT_FALSE(isSure(box, 2)) << place << " " << number;
  };
  for (std::size_t place = 0; place < 10; ++place) {
    for (const double number : {kNan, -kNan, kInfinity, -kInfinity, 1.1e7, -1.1e7, 1e300}) {
      expectBad(place, number);
    }
    if (place < 3 || place > 6) {
      expectBad(place, 9e-201);
      expectBad(place, 5e-324);
    }
    if (place > 6) {
      expectBad(place, -1.0);
      expectBad(place, -5e-324);
    }
  }
}

TEST(BoxChecks, AreSureOfNothingThatIsRejectedAlone) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> factor(0.5, 1.5);
  const auto some = [&](double number) {
    constexpr double kOdd[] = {0.0,    -0.0, 1e7,       1e-200,   -1e-200, 5e-324,
                               -1e-17, kNan, kInfinity, -1.2e300, 0.9e7,   1e-160};
    return random() % 12 == 0 ? kOdd[random() % 12] : number;
  };
  std::size_t sure = 0;
  std::size_t accepted = 0;
  for (int n = 0; n < 200000; ++n) {
    Numbers box;
    for (double& number : box.center) {
      number = some(factor(random) * 1e3);
    }
    const double norm = std::uniform_real_distribution<double>(0.98, 1.02)(random);
    for (double& number : box.orientation) {
      number = some(0.5 * norm);
    }
    for (double& number : box.size) {
      number = some(factor(random));
    }
    const bool is_sure = isSure(box);
    const bool is_accepted = isAccepted(box);
    ASSERT_TRUE(is_accepted || !is_sure) << n;
    sure += is_sure ? 1 : 0;
    accepted += is_accepted ? 1 : 0;
  }
  EXPECT_GT(sure, 10000U);
  EXPECT_GT(accepted, sure);
}

}  // namespace
}  // namespace box_query
