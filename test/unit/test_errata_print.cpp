// SPDX-License-Identifier: BSD-3-Clause
//
// Misprints of D. Eberly, "Intersection of a Line and a Box" (2018), one test a row of our list of
// errata, 1 to 8. Each shows the fault as printed, and that the library does not have it.
// test_listings.cpp shows the same of the corrected listings.
#include "reference/listings.h"
#include "reference/listings_as_printed.h"

#include <box_query/intersection.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace box_query {
namespace {

namespace as_printed = listings::as_printed;
using listings::toCenteredSegment3;
using listings::toOrientedBox3;

constexpr double kInf = std::numeric_limits<double>::infinity();

const AlignedBox kCube{-Vector3::Ones(), Vector3::Ones()};
const OrientedBox kOrientedCube{Vector3::Zero(), Quaternion::Identity(), Vector3::Ones()};
/// Exactly 90 degrees: two equal components are as good as two roots of one half.
const Quaternion kQuarterTurnAboutZ(std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5));

TEST(Errata, Row1_LastAxisOfEquation3) {
  const Segment through{{0.0, 0.0, 0.0}, {0.0, 0.0, 4.0}};
  ASSERT_FALSE(as_printed::equation3(toCenteredSegment3(through), toOrientedBox3(kCube)));
  EXPECT_TRUE(testIntersection(through, kCube));
  EXPECT_TRUE(testIntersection(through, kOrientedCube));

  const OrientedBox wall{{0.0, 0.0, 2.5}, Quaternion::Identity(), {1.0, 100.0, 1.0}};
  const Vector3 along(0.0, 0.95, 0.312);
  ASSERT_TRUE(as_printed::equation3({Vector3::Zero(), along, 2.0}, toOrientedBox3(wall)));
  const Segment below = Segment::fromCenterDirectionExtent(Vector3::Zero(), along, 2.0);
  EXPECT_FALSE(testIntersection(below, wall));
}

TEST(Errata, Row2_ExtentsOfListing6) {
  const Vector3 center(4.0, 4.0, 4.0);
  const Vector3 diagonal = Vector3::Ones().normalized();
  ASSERT_TRUE(as_printed::listing6::doSegmentQuery(center, diagonal, 5.0, Vector3::Ones()));
  const Segment outside = Segment::fromCenterDirectionExtent(center, diagonal, 5.0);
  EXPECT_FALSE(testIntersection(outside, kCube));
  EXPECT_FALSE(testIntersection(outside, kOrientedCube));
}

TEST(Errata, Row3_CentreIsSubtractedBeforeRotating) {
  const OrientedBox box{{10.0, 0.0, 0.0}, kQuarterTurnAboutZ, Vector3::Ones()};
  const Segment inside{{9.5, 0.0, 0.0}, {10.5, 0.0, 0.0}};
  ASSERT_FALSE(as_printed::listing6::testIntersection(inside, toOrientedBox3(box)));
  ASSERT_EQ(as_printed::listing10::findIntersection(inside, toOrientedBox3(box)).num_points, 0);
  EXPECT_TRUE(testIntersection(inside, box));
  EXPECT_EQ(findIntersection(inside, box).num_points, 2);
}

TEST(Errata, Row4_DirectionIsRotatedOnce) {
  const OrientedBox box{Vector3::Zero(), kQuarterTurnAboutZ, {0.5, 3.0, 1.0}};
  const Segment beside{{-5.0, 2.0, 0.0}, {5.0, 2.0, 0.0}};
  ASSERT_TRUE(as_printed::listing6::testIntersection(beside, toOrientedBox3(box)));
  ASSERT_GT(as_printed::listing10::findIntersection(beside, toOrientedBox3(box)).num_points, 0);
  EXPECT_FALSE(testIntersection(beside, box));
  EXPECT_EQ(findIntersection(beside, box).num_points, 0);
}

TEST(Errata, Row5_AContactIsOnePoint) {
  const Ray leaving{Vector3::UnitX(), Vector3::UnitX()};
  ASSERT_EQ(as_printed::listing9::findIntersection(leaving, kCube).num_points, 2);
  for (const Intersection& found :
       {findIntersection(leaving, kCube), findIntersection(leaving, kOrientedCube)}) {
    EXPECT_EQ(found.num_points, 1);
    EXPECT_EQ(found.t_enter, 0.0);
    EXPECT_EQ(found.t_exit, 0.0);
    EXPECT_TRUE(found.started_inside);
    EXPECT_TRUE(found.entered.empty());         // Only its own start bounds the ray here ...
    EXPECT_TRUE(found.left.contains(0, true));  // ... and the face x = 1 there.
    EXPECT_EQ(found.enter_point, leaving.origin);
    EXPECT_EQ(found.exit_point, leaving.origin);
  }
}

TEST(Errata, Row6_AMissHasNoParameters) {
  const Ray away{{5.0, 0.0, 0.0}, Vector3::UnitX()};
  const Segment beside{{5.0, 0.0, 0.0}, {7.0, 0.0, 0.0}};
  ASSERT_EQ(as_printed::listing9::findIntersection(away, kCube).t[0], -6.0);
  ASSERT_EQ(as_printed::listing10::findIntersection(beside, toOrientedBox3(kCube)).t[0], -7.0);
  for (const Intersection& found :
       {findIntersection(away, kCube), findIntersection(away, kOrientedCube),
        findIntersection(beside, kCube), findIntersection(beside, kOrientedCube)}) {
    EXPECT_EQ(found.num_points, 0);
    EXPECT_EQ(found.t_enter, kInf);
    EXPECT_EQ(found.t_exit, -kInf);
    EXPECT_TRUE(found.entered.empty());
    EXPECT_TRUE(found.left.empty());
    EXPECT_TRUE(found.enter_point.array().isNaN().all());
  }
}

/// Listing 5 takes a segment by centre, direction and extent, listings 6 and 10 by its ends: with
/// numbers that do not round both name one segment, and both of the library's ways to say so agree.
TEST(Errata, Row7_BothFormsOfASegmentAreOne) {
  const Segment ends{{-3.0, 0.5, 0.25}, {5.0, 0.5, 0.25}};
  const Segment centered =
      Segment::fromCenterDirectionExtent({1.0, 0.5, 0.25}, Vector3::UnitX(), 4.0);
  EXPECT_EQ(centered.start, ends.start);
  EXPECT_EQ(centered.end, ends.end);
  const Intersection found = findIntersection(centered, kCube);
  EXPECT_EQ(found.t_enter, 0.25);  // from 0 at the start to 1 at the end,
  EXPECT_EQ(found.t_exit, 0.5);
  const listings::Found listed = listings::listing10::findIntersection(ends, kCube);
  EXPECT_EQ(listed.t[0], -2.0);  // not metres from the centre
  EXPECT_EQ(listed.t[1], 0.0);
  EXPECT_EQ(found.enter_point, listed.point[0]);
  EXPECT_EQ(found.exit_point, listed.point[1]);
}

TEST(Errata, Row8_APointOutsideIsSeparated) {
  const Ray point{{2.0, 0.0, 0.0}, Vector3::Zero()};
  ASSERT_TRUE(as_printed::section22(point, toOrientedBox3(kCube)));
  EXPECT_FALSE(testIntersection(point, kCube));
  EXPECT_FALSE(testIntersection(point, kOrientedCube));
  EXPECT_EQ(findIntersection(point, kCube).num_points, 0);
  EXPECT_EQ(findIntersection(point, kOrientedCube).num_points, 0);
}

}  // namespace
}  // namespace box_query
