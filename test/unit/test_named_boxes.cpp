// SPDX-License-Identifier: BSD-3-Clause
#include "ros/named_boxes.h"

#include <algorithm>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace box_query {
namespace {

TEST(Renumber, GivesEachBoxItsPlaceAndLeavesWhatIsNone) {
  BoxIndices one = {7, -1, 3, 7};
  BoxIndices other = {5, 3};
  EXPECT_EQ(renumber({&one, &other}), (BoxIndices{3, 5, 7}));
  EXPECT_EQ(one, (BoxIndices{2, -1, 0, 2}));
  EXPECT_EQ(other, (BoxIndices{1, 0}));
}

TEST(Renumber, HasNoBoxesWhereNoneIsNamed) {
  BoxIndices nothing;
  BoxIndices misses = {-1, -1};
  EXPECT_EQ(renumber({&nothing, &misses}), BoxIndices{});
  EXPECT_EQ(misses, (BoxIndices{-1, -1}));
  EXPECT_EQ(renumber({}), BoxIndices{});
}

TEST(Renumber, TakesTheFirstAndTheLastIndexThatThereAre) {
  constexpr std::int32_t kLast = std::numeric_limits<std::int32_t>::max();
  BoxIndices ends = {kLast, 0, kLast};
  EXPECT_EQ(renumber({&ends}), (BoxIndices{0, kLast}));
  EXPECT_EQ(ends, (BoxIndices{1, 0, 1}));
  BoxIndices last = {kLast, -1};
  EXPECT_EQ(renumber({&last}), (BoxIndices{kLast}));
  EXPECT_EQ(last, (BoxIndices{0, -1}));
}

TEST(Renumber, IsTheSameForFewAndForManyIndicesOfAnyScene) {
  std::mt19937 random(5);
  for (const std::size_t count : {1, 2, 10, 100, 5000}) {
    for (const std::int32_t boxes : {1, 10, 1000, 100000, 100000000}) {
      BoxIndices arrays[2];
      std::set<std::int32_t> named;
      for (BoxIndices& array : arrays) {
        for (std::size_t i = 0; i < count; ++i) {
          array.push_back(std::uniform_int_distribution<std::int32_t>(-1, boxes - 1)(random));
        }
        named.insert(array.begin(), array.end());
      }
      named.erase(-1);
      const BoxIndices before[2] = {arrays[0], arrays[1]};
      const BoxIndices listed = renumber({&arrays[0], &arrays[1]});
      ASSERT_EQ(listed, BoxIndices(named.begin(), named.end()));
      for (std::size_t a = 0; a < 2; ++a) {
        for (std::size_t i = 0; i < count; ++i) {
          const std::int32_t place = arrays[a][i];
          ASSERT_EQ(place < 0 ? -1 : listed.at(static_cast<std::size_t>(place)), before[a][i]);
        }
      }
    }
  }
}

}  // namespace
}  // namespace box_query
