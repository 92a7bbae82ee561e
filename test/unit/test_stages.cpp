// SPDX-License-Identifier: BSD-3-Clause
// The stages between a plain double and exact integers: what each may claim, and that the slow ones
// stay idle where they should.
#include "exact/certified.h"
#include "exact/dyadic.h"
#include "exact/estimate.h"
#include "exact/rounding.h"
#include "exact/stage_counters.h"
#include "geometry/slabs.h"

#include <box_query/scene.h>

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace box_query {
namespace {

using exact::Certified;
using exact::DoubleDouble;
using exact::Dyadic;

constexpr double kInf = std::numeric_limits<double>::infinity();

class Random {
 public:
  double operator()(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine_);
  }
  /// Numbers over 60 powers of two, with long and with short mantissas.
  double wide() {
    const double x = (*this)(-1.0, 1.0);
    const double y = engine_() % 2 == 0 ? x : std::nearbyint(64.0 * x) / 64.0;
    return std::ldexp(y, static_cast<int>(engine_() % 60) - 30);
  }
  Vector3 vector(double a) { return {(*this)(-a, a), (*this)(-a, a), (*this)(-a, a)}; }

 private:
  std::mt19937_64 engine_{5};
};

Dyadic exactly(const DoubleDouble& x) {
  return Dyadic(x.hi) + Dyadic(x.lo);
}

Dyadic magnitude(const Dyadic& x) {
  return x.sign() < 0 ? -x : x;
}

TEST(DoubleDouble, ErrorFreeTransformationsAre) {
  Random random;
  for (int i = 0; i < 100000; ++i) {
    const double a = random.wide();
    const double b = random.wide();
    ASSERT_EQ(exactly(exact::twoSum(a, b)), Dyadic(a) + Dyadic(b));
    ASSERT_EQ(exactly(exact::twoProd(a, b)), Dyadic(a) * Dyadic(b));
    ASSERT_EQ(exact::twoProd(a, b).hi, a * b);
  }
}

TEST(DoubleDouble, QuotientsAndRootsAreWithinTheirBound) {
  Random random;
  for (int i = 0; i < 50000; ++i) {
    const DoubleDouble a = exact::twoSum(random.wide(), random.wide());
    const DoubleDouble b = exact::twoProd(random.wide(), random(1.0, 2.0));
    if (a.hi == 0.0 || b.hi == 0.0) {
      continue;
    }
    const Dyadic bound = exact::bounds::kOperation;
    ASSERT_LE(magnitude(exactly(a / b) * exactly(b) - exactly(a)), bound * magnitude(exactly(a)));
    ASSERT_LE(magnitude(exactly(a * b) - exactly(a) * exactly(b)),
              bound * magnitude(exactly(a) * exactly(b)));
    const DoubleDouble positive = a.hi > 0.0 ? a : -a;
    const DoubleDouble root = sqrt(positive);
    ASSERT_LE(magnitude(exactly(root) * exactly(root) - exactly(positive)),
              (bound + bound) * exactly(positive));
  }
}

TEST(Certified, TheErrorCoversTheTruthAndIsZeroOnlyWhenExact) {
  Random random;
  int exact_results = 0;
  int inexact_results = 0;
  for (int i = 0; i < 100000; ++i) {
    const double x[6] = {random.wide(), random.wide(), random.wide(),
                         random.wide(), random.wide(), random.wide()};
    const Certified c = (Certified(x[0]) - Certified(x[1])) * (Certified(x[2]) + Certified(x[3])) -
                        Certified(x[4]) * Certified(x[5]);
    const Dyadic truth =
        (Dyadic(x[0]) - Dyadic(x[1])) * (Dyadic(x[2]) + Dyadic(x[3])) - Dyadic(x[4]) * Dyadic(x[5]);
    ASSERT_LE(magnitude(exactly(c.value()) - truth), Dyadic(c.error()));
    if (c.sign() != exact::kUnknownSign) {
      ASSERT_EQ(c.sign(), truth.sign());
    }
    exact_results += c.error() == 0.0;
    inexact_results += c.error() > 0.0;
  }
  EXPECT_GT(exact_results, 1000);
  EXPECT_GT(inexact_results, 1000);
}

TEST(Certified, CancellationToNothingIsZeroOrUnknown) {
  const Certified product = Certified(0.1) * Certified(0.3);
  EXPECT_EQ((product - Certified(0.3) * Certified(0.1)).sign(), 0);
  const Certified vague(DoubleDouble{1.0, 0.0}, 0x1p-100);
  EXPECT_EQ((vague - vague).sign(), exact::kUnknownSign);
  EXPECT_EQ((vague - Certified(0.5)).sign(), 1);
}

TEST(Estimate, RoundsOnlyWhatItCanAndThenCorrectly) {
  Random random;
  int rounded_results = 0;
  for (int i = 0; i < 50000; ++i) {
    const double a = random.wide();
    const double b = random.wide();
    const double d = i % 3 == 0 ? 0.25 : random.wide();
    if (d == 0.0) {
      continue;
    }
    double rounded = 0.0;
    if (exact::round(exact::quotient(Certified(exact::twoDiff(a, b), 0.0), Certified(d)),
                     rounded)) {
      ASSERT_EQ(rounded, exact::roundedQuotient(Dyadic(a) - Dyadic(b), d));
      ++rounded_results;
    }
  }
  EXPECT_GT(rounded_results, 49000);
  // 1 + 2^-53 lies in the middle of two doubles: known exactly it goes to the even one.
  double rounded = 0.0;
  ASSERT_TRUE(
      exact::round(exact::quotient(Certified(DoubleDouble{1.0, 0x1p-53}, 0.0), 2.0), rounded));
  EXPECT_EQ(rounded, 0.5);
  EXPECT_FALSE(exact::round({{1.0, 0x1p-53}, 0x1p-99}, rounded));
}

Scene shelves() {
  std::vector<Box> boxes;
  for (int bay = 0; bay < 10; ++bay) {
    for (int level = 0; level < 5; ++level) {
      const Vector3 corner(bay, 0.0, 0.5 * level);
      if (level % 2 == 0) {
        boxes.emplace_back(AlignedBox{corner, corner + Vector3(1.0, 0.5, 0.5)});
      } else {  // the same, given as an oriented box turned by 90 degrees about z
        boxes.emplace_back(OrientedBox{corner + Vector3(0.5, 0.25, 0.25),
                                       Quaternion(0.7, 0, 0, 0.7), Vector3(0.25, 0.5, 0.25)});
      }
    }
  }
  return Scene(boxes);
}

TEST(Stages, RandomScenesAreDecidedInDouble) {
  Random random;
  std::vector<Box> boxes;
  for (int i = 0; i < 64; ++i) {
    boxes.emplace_back(OrientedBox{
        random.vector(8.0), Quaternion(random(-1, 1), random(-1, 1), random(-1, 1), random(-1, 1)),
        Vector3(random(0.1, 1.5), random(0.1, 1.5), random(0.1, 1.5))});
  }
  const Scene scene(boxes);
  exact::stageCounters() = {};
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Ray ray{random.vector(12.0), random.vector(1.0)};
    hits += scene.cast(ray, random(1.0, 20.0)).hit;
    scene.castAny(ray, random(1.0, 20.0));
  }
  EXPECT_GT(hits, 1000);
  EXPECT_EQ(exact::stageCounters().certified_decisions, 0U);
  EXPECT_EQ(exact::stageCounters().exact_decisions, 0U);
  EXPECT_EQ(exact::stageCounters().exact_roundings, 0U);
}

TEST(Stages, RaysInFacePlanesOfShelvesAreDecidedInDouble) {
  Random random;
  const Scene scene = shelves();
  exact::stageCounters() = {};
  for (int i = 0; i < 2000; ++i) {
    const double y = i % 4 == 0 ? 0.5 : random(0.01, 0.49);
    EXPECT_EQ(scene.cast(Ray{{-1.0, y, 0.5 * (i % 6)}, {1, 0, 0}}).range, 1.0);
    EXPECT_TRUE(scene.castAny(Ray{{-1.0, y, 0.5 * (i % 6)}, {1, 0, 0}}, 1.0));
  }
  EXPECT_EQ(exact::stageCounters().exact_decisions, 0U);
  EXPECT_EQ(exact::stageCounters().exact_roundings, 0U);
}

TEST(Stages, ATouchThatNoDoubleHoldsReachesTheExactStage) {
  // 0.1 (3, 4, 0) against a box that is turned by atan(4 / 3) and not by its half in doubles.
  const OrientedBox box{Vector3(0.3, 0.4, 0), Quaternion(2, 0, 0, 1), Vector3(1, 0.5, 2)};
  exact::stageCounters() = {};
  const Vector3 corner(0.3 + 0.6 * 1 - 0.8 * 0.5, 0.4 + 0.8 * 1 + 0.6 * 0.5, 2);
  testIntersection(Ray{corner, Vector3(0, 0, 1)}, box);
  EXPECT_GT(exact::stageCounters().certified_decisions, 0U);
}

TEST(Stages, EnclosuresHoldTheParameters) {
  Random random;
  for (int i = 0; i < 20000; ++i) {
    const Vector3 lo = random.vector(3.0);
    const AlignedBox box{lo, lo + Vector3(random(0, 1), random(0, 1), random(0, 1))};
    const Ray ray{random.vector(3.0), random.vector(2.0)};
    const Enclosure e = enclose<Ray>(
        doubleComponent(ray),
        AlignedSlabs{{{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}}});
    const Intersection exact = findIntersection(ray, box);
    if (exact.num_points > 0) {
      ASSERT_LE(e.enter_lo, exact.t_enter);
      ASSERT_GE(e.exit_hi, exact.t_exit);
      ASSERT_TRUE(!e.isHit() || (e.enter_hi >= exact.t_enter && e.exit_lo <= exact.t_exit));
    }
    ASSERT_FALSE(e.isMiss() && exact.num_points > 0);
    ASSERT_FALSE(e.isHit() && exact.num_points == 0);
  }
  EXPECT_EQ(widenedUp(kInf), kInf);
  EXPECT_EQ(widenedDown(-kInf), -kInf);
}

}  // namespace
}  // namespace box_query
