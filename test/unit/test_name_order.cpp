// SPDX-License-Identifier: BSD-3-Clause
#include "ros/name_order.h"

#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace box_query {
namespace {

using Places = std::vector<std::size_t>;

std::vector<BoxName> names(const std::vector<std::string>& texts) {
  std::vector<BoxName> result;
  for (const std::string& text : texts) {  // topic, namespace, id
    BoxName name;
    name.topic = text.substr(0, 1);
    name.ns = text.substr(1, 1);
    name.id = std::stoll(text.substr(2));
    result.push_back(name);
  }
  return result;
}

TEST(PlacesOf, FindsEachNameAmongTheOthers) {
  const auto before = names({"ax-1", "ax1", "ax2", "ay1", "bx1"});
  EXPECT_EQ(placesOf(before, before), (Places{0, 1, 2, 3, 4}));
  EXPECT_EQ(placesOf(names({"aw1", "ax2", "ax3", "bx1", "bx2"}), before),
            (Places{kNoBox, 2, kNoBox, 4, kNoBox}));
  EXPECT_EQ(placesOf(names({"bx0"}), before), (Places{kNoBox}));
  EXPECT_EQ(placesOf({}, before), Places{});
  EXPECT_EQ(placesOf(names({"ax1"}), {}), (Places{kNoBox}));
}

TEST(PlacesOf, GivesEachOfManyBoxesOfOneNameAnother) {
  EXPECT_EQ(placesOf(names({"ax1", "ax1", "ax1"}), names({"ax1", "ax1"})), (Places{0, 1, kNoBox}));
  EXPECT_EQ(placesOf(names({"ax1", "ax2"}), names({"ax1", "ax1", "ax2"})), (Places{0, 2}));
}

}  // namespace
}  // namespace box_query
