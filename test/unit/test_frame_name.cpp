// SPDX-License-Identifier: BSD-3-Clause
#include "ros/frame_name.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace box_query {
namespace {

TEST(FrameName, HasNoLeadingSlash) {
  EXPECT_EQ(stripSlash("/map"), "map");
  EXPECT_EQ(stripSlash("map"), "map");
  EXPECT_EQ(stripSlash("/robot/base"), "robot/base");
  EXPECT_EQ(stripSlash("/"), "");
  EXPECT_EQ(stripSlash(""), "");
  EXPECT_TRUE(isBadFrame(""));
  EXPECT_TRUE(isBadFrame("/map"));
  EXPECT_FALSE(isBadFrame("robot/base"));
}

TEST(FrameName, KeepsNamesOfAnyLength) {
  for (const std::size_t length : {0U, 1U, 39U, 40U, 41U, 255U}) {
    const std::string name(length, 'f');
    std::vector<FrameName> frames;  // which move as there are more
    for (int n = 0; n < 9; ++n) {
      frames.emplace_back(std::string_view(name));
    }
    frames.push_back(frames.front());
    for (const FrameName& frame : frames) {
      EXPECT_EQ(frame.size(), length);
      EXPECT_TRUE(frame == name);
      EXPECT_FALSE(frame == name + "g");
      EXPECT_EQ(frame.str(), name);
    }
    FrameName other{std::string_view("map")};
    other = name;
    EXPECT_EQ(other.str(), name);
  }
}

}  // namespace
}  // namespace box_query
