// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The stress suite as tests, one a family. BOX_QUERY_STRESS_PER_FAMILY and BOX_QUERY_STRESS_SCENES
/// change how many samples there are.
#include "stress/families.h"
#include "stress/run_families.h"
#include "stress/scene_families.h"

#include <cstdlib>

#include <gtest/gtest.h>

namespace box_query::stress {
namespace {

constexpr std::uint64_t kSeed = 20180101;

std::uint64_t countFrom(const char* variable, std::uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

std::uint64_t perFamily() {
  return countFrom("BOX_QUERY_STRESS_PER_FAMILY", 2000);
}

void expectAllRight(const Tally& tally) {
  for (const std::string& failure : tally.failures) {
    ADD_FAILURE() << failure;
  }
  EXPECT_EQ(tally.wrong, 0U);
  // Errors are told in double, so that a tie is half an ulp but for the last digits.
  constexpr double kHalf = 0.5 + 0x1p-40;
  EXPECT_LE(tally.worst_t, kHalf);
  EXPECT_LE(tally.worst_range, kHalf);
  EXPECT_LE(tally.worst_distance, kHalf);
}

/// A family without a real share of hits and of misses proves little.
void expectBothOutcomes(const Tally& tally) {
  EXPECT_GT(8 * tally.hits, tally.queries);
  EXPECT_LT(8 * tally.hits, 7 * tally.queries);
}

class StressOfPairs : public testing::TestWithParam<std::size_t> {};

TEST_P(StressOfPairs, IntersectionsAreExact) {
  const Tally tally = runIntersections(GetParam(), kSeed, perFamily(), 2);
  expectAllRight(tally);
  expectBothOutcomes(tally);
}

TEST_P(StressOfPairs, DistancesAreExact) {
  const Tally tally = runDistances(GetParam(), kSeed, perFamily(), 2);
  expectAllRight(tally);
  expectBothOutcomes(tally);
}

INSTANTIATE_TEST_SUITE_P(Families, StressOfPairs,
                         testing::Range<std::size_t>(0, familyNames().size()),
                         [](const auto& family) { return familyNames()[family.param]; });

class StressOfScenes : public testing::TestWithParam<std::size_t> {};

TEST_P(StressOfScenes, AnswersAreExact) {
  const std::uint64_t count =
      sceneCount(GetParam(), countFrom("BOX_QUERY_STRESS_SCENES", 50 * sceneFamilyNames().size()));
  const Tally tally = runScenes(GetParam(), kSeed, count, 2);
  expectAllRight(tally);
  expectBothOutcomes(tally);
}

INSTANTIATE_TEST_SUITE_P(Families, StressOfScenes,
                         testing::Range<std::size_t>(0, sceneFamilyNames().size()),
                         [](const auto& family) { return sceneFamilyNames()[family.param]; });

}  // namespace
}  // namespace box_query::stress
