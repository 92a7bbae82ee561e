// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The stress suite against a core that is spoilt on purpose: it must find wrong answers.
///
/// A derived bound is larger than the largest error that ever occurs. The factors below are where
/// the suite was first seen to find wrong answers, so they also say how much slack there is.
#include "exact/bounds.h"
#include "exact/distance_bounds.h"
#include "kernels/float_bounds.h"
#include "kernels/kernels.h"
#include "stress/families.h"
#include "stress/mutation.h"
#include "stress/run_families.h"
#include "stress/scene_families.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace box_query::stress {
namespace {

namespace bounds = exact::bounds;
namespace float_bounds = kernels::bounds;

constexpr std::uint64_t kSeed = 5;

using Run = Tally (*)(std::size_t, std::uint64_t, std::uint64_t, int);

std::uint64_t wrongAnswers(Run run, const std::vector<std::string>& names, const char* name,
                           std::uint64_t count) {
  const auto found = std::find(names.begin(), names.end(), name);
  EXPECT_NE(found, names.end()) << name;
  return run(static_cast<std::size_t>(found - names.begin()), kSeed, count, 2).wrong;
}

std::uint64_t wrongPairs(const char* family, std::uint64_t count) {
  return wrongAnswers(runIntersections, familyNames(), family, count);
}

std::uint64_t wrongDistances(const char* family, std::uint64_t count) {
  return wrongAnswers(runDistances, familyNames(), family, count);
}

std::uint64_t wrongScenes(const char* family, std::uint64_t count) {
  return wrongAnswers(runScenes, sceneFamilyNames(), family, count);
}

/// Of what only kernels with vectors do.
class MutationsOfVectors : public testing::Test {
 protected:
  void SetUp() override {
    if (kernels::active().cross == nullptr) {
      GTEST_SKIP() << "the portable kernel works out one axis after the other";
    }
  }
};

/// Gives a number another value as long as it lives.
template <typename T>
class Spoilt {
 public:
  Spoilt(T& variable, T value) : variable_(variable), good_(variable) { variable = value; }
  ~Spoilt() { variable_ = good_; }
  Spoilt(const Spoilt&) = delete;
  Spoilt& operator=(const Spoilt&) = delete;

 private:
  T& variable_;
  T good_;
};

TEST(Mutations, WithoutAnyNothingIsWrong) {
  EXPECT_EQ(wrongPairs("grazing", 5000), 0U);
  EXPECT_EQ(wrongPairs("exact_touch", 5000), 0U);
  EXPECT_EQ(wrongDistances("grazing", 2000), 0U);
}

TEST(Mutations, TouchesThatMissAreNoticed) {
  const Spoilt<bool> spoilt(mutation.touching_misses, true);
  EXPECT_GT(wrongPairs("exact_touch", 1000), 0U);
}

TEST(Mutations, TiesThatNameOneFaceAreNoticed) {
  const Spoilt<bool> spoilt(mutation.ties_name_one_face, true);
  EXPECT_GT(wrongPairs("exact_touch", 1000), 0U);
}

TEST(Mutations, ASkippedExactStageIsNoticed) {
  // A point box on a line: three planes at one parameter, in numbers too long for double-double.
  const Spoilt<bool> spoilt(mutation.skip_exact_stage, true);
  EXPECT_GT(wrongPairs("extents", 1000), 0U);
}

TEST(Mutations, SkippedSlowStagesAreNoticed) {
  const Spoilt<bool> spoilt(mutation.skip_slow_stages, true);
  EXPECT_GT(wrongPairs("grazing", 1000), 0U);
}

TEST(Mutations, ASkippedRoundingTestIsNoticed) {
  const Spoilt<bool> spoilt(mutation.skip_rounding_test, true);
  EXPECT_GT(wrongPairs("axis_parallel", 12000), 0U);
}

TEST(Mutations, ShrunkBoundsOfOrientedSlabsAreNoticed) {
  const Spoilt<double> spoilt(bounds::kSlab, bounds::kSlab / 64);  // first seen at 1/32
  EXPECT_GT(wrongPairs("far_parallel", 3000), 0U);
}

TEST(Mutations, ShrunkBoundsOfAlignedSlabsAreNoticed) {
  const Spoilt<double> spoilt(bounds::kAlignedSlab, bounds::kAlignedSlab / 8);  // first seen at 1/4
  EXPECT_GT(wrongPairs("grazing", 3000), 0U);
}

TEST(Mutations, ShrunkBoundsOfDoubleDoubleRowsAreNoticed) {
  const Spoilt<double> spoilt(bounds::kRow, bounds::kRow / 1024);  // first seen at 1/256
  EXPECT_GT(wrongPairs("origin_on_box", 12000), 0U);
}

TEST(Mutations, ShrunkBoundsOfDoubleDoubleOperationsAreNoticed) {
  const Spoilt<double> spoilt(bounds::kOperation, bounds::kOperation / 256);  // first seen at 1/64
  EXPECT_GT(wrongPairs("axis_parallel", 12000), 0U);
}

TEST(Mutations, ShrunkBoundsOfDistancesAreNoticed) {
  const Spoilt<double> spoilt(bounds::kDistance, bounds::kDistance / 256);  // first seen at 1/128
  EXPECT_GT(wrongDistances("rounded_axis", 2000), 0U);
}

TEST_F(MutationsOfVectors, ShrunkBoundsOfRefinedDistancesAreNoticed) {
  const Spoilt<bool> by_axes(mutation.refine_by_axes, true);
  const Spoilt<double> spoilt(bounds::kRow, bounds::kRow / 1024);
  EXPECT_GT(wrongDistances("origin_on_box", 4000), 0U);
}

TEST_F(MutationsOfVectors, ShrunkBoundsOfDistancesInScenesAreNoticed) {
  EXPECT_EQ(wrongScenes("scene_midpoints", 200), 0U);
  const Spoilt<double> spoilt(bounds::kRests, bounds::kRests / 2048);  // first seen at 1/1024
  EXPECT_GT(wrongScenes("scene_midpoints", 200), 0U);
}

TEST(Mutations, ShrunkBoundsOfDistancesByAxesAreNoticed) {
  const Spoilt<bool> by_axes(mutation.refine_by_axes, true);
  const Spoilt<double> row(bounds::kRow, bounds::kRow / 1024);  // first seen at 1/256
  const Spoilt<double> operation(bounds::kOperation, bounds::kOperation / 1024);
  EXPECT_GT(wrongScenes("scene_midpoints", 400), 0U);
}

TEST(Mutations, ASkippedRoundingTestOfDistancesInScenesIsNoticed) {
  const Spoilt<bool> spoilt(mutation.skip_rounding_test, true);
  EXPECT_GT(wrongScenes("scene_midpoints", 200), 0U);
}

// What follows about slopes is of one axis after the other, as without kernels.
TEST(Mutations, AShrunkBoundOfTheSlopeOfDistancesIsNoticed) {
  const Spoilt<bool> by_axes(mutation.refine_by_axes, true);
  EXPECT_EQ(wrongDistances("rounded_axis", 3000), 0U);
  const Spoilt<double> spoilt(bounds::kSlope, 0.0);
  EXPECT_GT(wrongDistances("rounded_axis", 3000), 0U);
}

TEST(Mutations, DirectionsTooShortForTheFilterAreNoticed) {
  const Spoilt<double> spoilt(bounds::kSmallestDirection, 0.0);
  EXPECT_GT(wrongPairs("stage_limits", 8000), 0U);
}

TEST(Mutations, DirectionsAcrossAnAxisThatAreTakenAsTheyAreAreNoticed) {
  const Spoilt<double> spoilt(bounds::kFlattest, 0.0);
  EXPECT_GT(wrongPairs("stage_limits", 2000), 0U);
}

TEST(Mutations, ScalesTooSmallForDistancesAreNoticed) {
  const Spoilt<double> spoilt(bounds::kSmallestScale, 0.0);
  EXPECT_GT(wrongDistances("stage_limits", 1000), 0U);
}

TEST(Mutations, SegmentsTooShortForTheFrameOfABoxAreNoticed) {
  const Spoilt<bool> by_axes(mutation.refine_by_axes, true);
  const Spoilt<double> spoilt(bounds::kShortestDirection, 0.0);
  EXPECT_GT(wrongDistances("stage_limits", 8000), 0U);
}

TEST(Mutations, ShrunkBoundsOfUnusualRaysAreNoticed) {
  const Spoilt<double> shift(float_bounds::kShiftError, 0.0);
  const Spoilt<double> along(float_bounds::kAlongError, 0.0);
  EXPECT_GT(wrongScenes("scene_unusual", 1600), 0U);
}

TEST(Mutations, ShrunkBoundsOfBoxesInFloatAreNoticed) {
  const Spoilt<double> spoilt(float_bounds::kBlock, float_bounds::kBlock / 256);
  EXPECT_GT(wrongScenes("scene_near_ties", 800), 0U);
}

TEST(Mutations, BoxesThatAreMetForSureWithoutABoundAreNoticed) {
  const Spoilt<double> spoilt(float_bounds::kInBlock, 0.0);
  EXPECT_GT(wrongScenes("scene_near_ties", 800), 0U);
}

TEST(Mutations, ShrunkBoundsOfRaysInFloatAreNoticed) {
  const Spoilt<double> spoilt(float_bounds::kApart, 0.0);
  EXPECT_GT(wrongScenes("scene_near_ties", 800), 0U);
}

TEST(Mutations, PlanesThatAreNotMovedApartForFlatRaysAreNoticed) {
  const Spoilt<double> spoilt(float_bounds::kFlat, 0.0);
  EXPECT_GT(wrongScenes("scene_unusual", 1600), 0U);
}

TEST(Mutations, ShrunkBoundsOfDistancesInFloatAreNoticed) {
  const Spoilt<double> spoilt(float_bounds::kLoss, 0.0);
  EXPECT_GT(wrongScenes("scene_near_ties", 400), 0U);
}

TEST(Mutations, BoundsThatAreMovedOutwardByLessThanTheRadiusAreNoticed) {
  const Spoilt<double> spoilt(float_bounds::kWithin, 1.0 - 0x1p-10);
  EXPECT_GT(wrongScenes("scene_near_ties", 400), 0U);
}

TEST_F(MutationsOfVectors, EstimatesOfRootsThatAreTakenForRootsAreNoticed) {
  const Spoilt<double> spoilt(float_bounds::kRoughRoot, 0.0);
  EXPECT_GT(wrongScenes("scene_near_ties", 400), 0U);
}

}  // namespace
}  // namespace box_query::stress
