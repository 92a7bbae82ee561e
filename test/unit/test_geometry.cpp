// SPDX-License-Identifier: BSD-3-Clause
#include <box_query/geometry.h>

#include <limits>

#include <gtest/gtest.h>

namespace box_query {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();

TEST(Geometry, WhatIsNotFiniteIsNotValid) {
  for (const double bad : {kInf, -kInf, kNan}) {
    for (int i = 0; i < 3; ++i) {
      Vector3 v(1.0, 2.0, 3.0);
      v[i] = bad;
      const Vector3 good(1.0, 2.0, 3.0);
      EXPECT_FALSE(isValid(Line{v, good}));
      EXPECT_FALSE(isValid(Line{good, v}));
      EXPECT_FALSE(isValid(Ray{v, good}));
      EXPECT_FALSE(isValid(Ray{good, v}));
      EXPECT_FALSE(isValid(Segment{v, good}));
      EXPECT_FALSE(isValid(Segment{good, v}));
      EXPECT_FALSE(isValid(AlignedBox{v, good}));
      EXPECT_FALSE(isValid(AlignedBox{good, v}));
      EXPECT_FALSE(isValid(OrientedBox{v, Quaternion::Identity(), good}));
      EXPECT_FALSE(isValid(OrientedBox{good, Quaternion::Identity(), v}));
    }
    EXPECT_FALSE(
        isValid(OrientedBox{Vector3::Zero(), Quaternion(1.0, bad, 0.0, 0.0), Vector3::Ones()}));
  }
}

TEST(Geometry, FlatBoxesPointsAndOddQuaternionsAreValid) {
  EXPECT_TRUE(isValid(AlignedBox{Vector3::Zero(), Vector3::Zero()}));
  EXPECT_TRUE(
      isValid(OrientedBox{Vector3::Zero(), Quaternion(0.0, 0.0, 0.0, kTiny), Vector3::Zero()}));
  EXPECT_TRUE(
      isValid(Box(OrientedBox{Vector3::Zero(), Quaternion(3.0, 0.0, 4.0, 0.0), Vector3::Ones()})));
  EXPECT_TRUE(isValid(Ray{Vector3::Zero(), Vector3::Zero()}));
}

TEST(Geometry, NegativeSizesAndZeroQuaternionsAreNotValid) {
  EXPECT_FALSE(isValid(AlignedBox{Vector3(0.0, 0.0, kTiny), Vector3(1.0, 1.0, 0.0)}));
  EXPECT_FALSE(
      isValid(OrientedBox{Vector3::Zero(), Quaternion::Identity(), Vector3(1.0, -kTiny, 1.0)}));
  EXPECT_FALSE(
      isValid(Box(OrientedBox{Vector3::Zero(), Quaternion(0.0, -0.0, 0.0, 0.0), Vector3::Ones()})));
}

TEST(Geometry, SegmentFromCenterDirectionExtent) {
  const Segment segment =
      Segment::fromCenterDirectionExtent(Vector3(1.0, 2.0, 3.0), Vector3::UnitY(), 0.5);
  EXPECT_EQ(segment.start, Vector3(1.0, 1.5, 3.0));
  EXPECT_EQ(segment.end, Vector3(1.0, 2.5, 3.0));
}

TEST(Geometry, FacesAreNumberedByAxisAndSide) {
  FaceSet faces;
  EXPECT_TRUE(faces.empty());
  faces.insert(0, false);
  faces.insert(2, true);
  EXPECT_EQ(faces.bits(), 0b100001);
  EXPECT_TRUE(faces.contains(0, false));
  EXPECT_FALSE(faces.contains(0, true));
  EXPECT_EQ(faces, FaceSet(0b100001U));
}

}  // namespace
}  // namespace box_query
