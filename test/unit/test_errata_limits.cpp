// SPDX-License-Identifier: BSD-3-Clause
//
// What D. Eberly, "Intersection of a Line and a Box" (2018) leaves open, one test a row of our list
// of errata, 9, 10 and 12 to 15: zero directions, underflow, overflow, numbers that are none. Each
// shows the corrected listing failing, and the library not.
#include "reference/listings.h"

#include <box_query/intersection.h>
#include <box_query/scene.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace box_query {
namespace {

using namespace listings;  // NOLINT(google-build-using-namespace): all ten are compared with here.

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const AlignedBox kCube{-Vector3::Ones(), Vector3::Ones()};
const OrientedBox kOrientedCube{Vector3::Zero(), Quaternion::Identity(), Vector3::Ones()};

/// A cube around the origin.
AlignedBox cube(double half_extent) {
  return {Vector3::Constant(-half_extent), Vector3::Constant(half_extent)};
}
OrientedBox orientedCube(double half_extent) {
  return {Vector3::Zero(), Quaternion::Identity(), Vector3::Constant(half_extent)};
}

TEST(Errata, Row9_ZeroDirectionIsAPoint) {
  const Line outside{{5.0, 5.0, 5.0}, Vector3::Zero()};
  ASSERT_TRUE(listing1::testIntersection(outside, toOrientedBox3(kCube)));
  ASSERT_TRUE(listing2::testIntersection(outside, kCube));
  EXPECT_FALSE(testIntersection(outside, kCube));
  EXPECT_FALSE(testIntersection(outside, kOrientedCube));
  EXPECT_EQ(findIntersection(outside, kCube).num_points, 0);
  EXPECT_EQ(findIntersection(outside, kOrientedCube).num_points, 0);

  const Line inside{{0.5, 1.0, -0.5}, Vector3::Zero()};
  const Found listed = listing8::findIntersection(inside, kCube);
  ASSERT_TRUE(std::isinf(listed.t[0]));
  ASSERT_TRUE(std::isnan(listed.point[0].x()));
  for (const Intersection& found :
       {findIntersection(inside, kCube), findIntersection(inside, kOrientedCube)}) {
    EXPECT_EQ(found.num_points, 1);
    EXPECT_EQ(found.enter_point, inside.origin);
    EXPECT_EQ(found.exit_point, inside.origin);
  }
}

TEST(Errata, Row10_ZeroLengthSegmentIsAPoint) {
  const Segment outside{{5.0, 5.0, 5.0}, {5.0, 5.0, 5.0}};
  ASSERT_TRUE(listing6::testIntersection(outside, kCube));
  EXPECT_FALSE(testIntersection(outside, kCube));
  EXPECT_FALSE(testIntersection(outside, kOrientedCube));
  EXPECT_EQ(findIntersection(outside, kCube).num_points, 0);
  EXPECT_EQ(findIntersection(outside, kOrientedCube).num_points, 0);

  // With a direction that is NaN, listing 10 is saved by its branch for parallels, but not its
  // point.
  const Segment corner{Vector3::Ones(), Vector3::Ones()};
  ASSERT_TRUE(std::isnan(listing10::findIntersection(corner, kCube).point[0].x()));
  for (const Intersection& found :
       {findIntersection(corner, kCube), findIntersection(corner, kOrientedCube)}) {
    EXPECT_EQ(found.num_points, 1);
    EXPECT_TRUE(found.started_inside);
    EXPECT_EQ(found.enter_point, corner.start);
  }
}

TEST(Errata, Row12_SignsAreComparedNotMultiplied) {
  const Ray towards{{1e-200, 0.0, 0.0}, {-1e-200, 0.0, 0.0}};
  ASSERT_FALSE(listing4::testIntersection(towards, cube(1e-201)));
  EXPECT_TRUE(testIntersection(towards, cube(1e-201)));
  EXPECT_TRUE(testIntersection(towards, orientedCube(1e-201)));
  const Ray away{{1e-200, 0.0, 0.0}, {1e-200, 0.0, 0.0}};
  EXPECT_FALSE(testIntersection(away, cube(1e-201)));
  EXPECT_FALSE(testIntersection(away, orientedCube(1e-201)));
}

TEST(Errata, Row13_ProductsDoNotOverflow) {
  const Line beside{{1e200, 1.1e200, 0.0}, {1e200, 1e200, 0.0}};
  ASSERT_TRUE(listing1::testIntersection(beside, toOrientedBox3(kCube)));
  ASSERT_TRUE(listing2::testIntersection(beside, kCube));
  EXPECT_FALSE(testIntersection(beside, kCube));
  EXPECT_FALSE(testIntersection(beside, kOrientedCube));
  EXPECT_EQ(findIntersection(beside, kOrientedCube).num_points, 0);
  const Line through{{1e200, 1e200, 0.0}, {1e200, 1e200, 0.0}};
  EXPECT_TRUE(testIntersection(through, kCube));
  EXPECT_TRUE(testIntersection(through, kOrientedCube));
}

TEST(Errata, Row14_AParameterThatOverflowsIsStillAHit) {
  const Line slow{{-1.5, 0.0, 0.0}, {1e-310, 0.0, 0.0}};
  ASSERT_EQ(listing8::findIntersection(slow, kCube).num_points, 0);
  for (const Intersection& found :
       {findIntersection(slow, kCube), findIntersection(slow, kOrientedCube)}) {
    EXPECT_EQ(found.num_points, 2);
    EXPECT_EQ(found.t_enter, std::numeric_limits<double>::infinity());  // 5e309
    EXPECT_EQ(found.enter_point, -Vector3::UnitX());
    EXPECT_EQ(found.exit_point, Vector3::UnitX());
  }
  EXPECT_TRUE(testIntersection(slow, kCube));
}

TEST(Errata, Row15_WhatIsNoNumberOrNoSizeIsRefused) {
  const Line nowhere{{kNan, 0.0, 0.0}, Vector3::UnitX()};
  ASSERT_EQ(listing8::findIntersection(nowhere, kCube).num_points, 2);
  EXPECT_FALSE(isValid(nowhere));

  const OrientedBox inside_out{Vector3::Zero(), Quaternion::Identity(), {-1.0, 1.0, 1.0}};
  const Line through{{0.0, 0.5, 0.0}, Vector3::UnitX()};
  ASSERT_TRUE(listing2::testIntersection(through, toOrientedBox3(inside_out)));
  ASSERT_EQ(listing8::findIntersection(through, toOrientedBox3(inside_out)).num_points, 0);
  EXPECT_FALSE(isValid(inside_out));
  EXPECT_THROW(Scene({kCube, inside_out}), std::invalid_argument);
  EXPECT_THROW(Scene({OrientedBox{{kNan, 0.0, 0.0}, Quaternion::Identity(), Vector3::Ones()}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace box_query
