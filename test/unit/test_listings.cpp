// SPDX-License-Identifier: BSD-3-Clause
#include "reference/listings.h"
#include "reference/listings_as_printed.h"
#include "reference/sampler.h"

#include <box_query/intersection.h>

#include <gtest/gtest.h>

namespace box_query::listings {
namespace {

using reference::Sampler;

constexpr int kQueries = 100000;
/// Of parameters and points of order 10, after some twenty roundings of numbers of that order.
constexpr double kRounding = 1e-11;

/// A quarter to a half of these hit; nothing in them ties.
struct Query {
  Line line;
  Ray ray;
  Segment segment;
  OrientedBox oriented;
  AlignedBox aligned;
};

Query randomQuery(Sampler& sampler) {
  Query query;
  query.oriented.center = sampler.vector(-2.0, 2.0);
  query.oriented.orientation = sampler.rotation();
  query.oriented.half_extents = sampler.vector(0.5, 3.0);
  query.aligned.min = query.oriented.center - query.oriented.half_extents;
  query.aligned.max = query.oriented.center + query.oriented.half_extents;
  query.segment.start = sampler.vector(-6.0, 6.0);
  query.segment.end = sampler.vector(-6.0, 6.0);
  query.ray.origin = query.segment.start;
  query.ray.direction = (query.segment.end - query.segment.start).normalized();
  query.line = {query.ray.origin, query.ray.direction};
  return query;
}

void expectEnoughOfEach(int hits) {
  EXPECT_GT(hits, kQueries / 5);
  EXPECT_LT(hits, kQueries * 4 / 5);
}

TEST(Listings, OneTwoAndEightAgreeOnLines) {
  Sampler sampler(1);
  int hits = 0;
  for (int i = 0; i < kQueries; ++i) {
    const Query query = randomQuery(sampler);
    const OrientedBox3 box = toOrientedBox3(query.oriented);
    const bool hit = listing1::testIntersection(query.line, box);
    hits += hit;
    ASSERT_EQ(listing2::testIntersection(query.line, box), hit) << i;
    ASSERT_EQ(listing8::findIntersection(query.line, box).num_points, hit ? 2 : 0) << i;
    ASSERT_EQ(testIntersection(query.line, query.oriented), hit) << i;
    const bool aligned_hit = listing1::testIntersection(query.line, toOrientedBox3(query.aligned));
    ASSERT_EQ(testIntersection(query.line, query.aligned), aligned_hit) << i;
    ASSERT_EQ(listing2::testIntersection(query.line, query.aligned), aligned_hit) << i;
    ASSERT_EQ(listing8::findIntersection(query.line, query.aligned).num_points, aligned_hit ? 2 : 0)
        << i;
  }
  expectEnoughOfEach(hits);
}

TEST(Listings, ThreeFourAndNineAgreeOnRays) {
  Sampler sampler(2);
  int hits = 0;
  for (int i = 0; i < kQueries; ++i) {
    const Query query = randomQuery(sampler);
    const OrientedBox3 box = toOrientedBox3(query.oriented);
    const bool hit = listing3::testIntersection(query.ray, box);
    hits += hit;
    ASSERT_EQ(listing4::testIntersection(query.ray, box), hit) << i;
    ASSERT_EQ(listing9::findIntersection(query.ray, box).num_points, hit ? 2 : 0) << i;
    ASSERT_EQ(testIntersection(query.ray, query.oriented), hit) << i;
    const bool aligned_hit = listing3::testIntersection(query.ray, toOrientedBox3(query.aligned));
    ASSERT_EQ(testIntersection(query.ray, query.aligned), aligned_hit) << i;
    ASSERT_EQ(listing4::testIntersection(query.ray, query.aligned), aligned_hit) << i;
    ASSERT_EQ(listing9::findIntersection(query.ray, query.aligned).num_points, aligned_hit ? 2 : 0)
        << i;
  }
  expectEnoughOfEach(hits);
}

TEST(Listings, FiveSixAndTenAgreeOnSegments) {
  Sampler sampler(3);
  int hits = 0;
  for (int i = 0; i < kQueries; ++i) {
    const Query query = randomQuery(sampler);
    const OrientedBox3 box = toOrientedBox3(query.oriented);
    const CenteredSegment3 centered = toCenteredSegment3(query.segment);
    const bool hit = listing5::testIntersection(centered, box);
    hits += hit;
    ASSERT_EQ(listing6::testIntersection(query.segment, box), hit) << i;
    ASSERT_EQ(listing10::findIntersection(query.segment, box).num_points, hit ? 2 : 0) << i;
    ASSERT_EQ(testIntersection(query.segment, query.oriented), hit) << i;
    const bool aligned_hit = listing5::testIntersection(centered, toOrientedBox3(query.aligned));
    ASSERT_EQ(testIntersection(query.segment, query.aligned), aligned_hit) << i;
    ASSERT_EQ(listing6::testIntersection(query.segment, query.aligned), aligned_hit) << i;
    ASSERT_EQ(listing10::findIntersection(query.segment, query.aligned).num_points,
              aligned_hit ? 2 : 0)
        << i;
  }
  expectEnoughOfEach(hits);
}

TEST(Listings, FindWhatTheLibraryFinds) {
  Sampler sampler(4);
  int points = 0;
  for (int i = 0; i < kQueries; ++i) {
    const Query query = randomQuery(sampler);
    const OrientedBox3 box = toOrientedBox3(query.oriented);
    const double length = (query.segment.end - query.segment.start).norm();
    const struct {
      Found listing;
      Intersection library;
      double unit;  ///< [m] that a parameter of the library stands for
      double zero;  ///< [m] from where the listing counts to where the library does
    } answers[] = {
        {listing8::findIntersection(query.line, box), findIntersection(query.line, query.oriented),
         1.0, 0.0},
        {listing9::findIntersection(query.ray, box), findIntersection(query.ray, query.oriented),
         1.0, 0.0},
        // A listing counts a segment's metres from its centre.
        {listing10::findIntersection(query.segment, box),
         findIntersection(query.segment, query.oriented), length, -length / 2.0},
    };
    for (const auto& [listing, library, unit, zero] : answers) {
      ASSERT_EQ(listing.num_points, library.num_points) << i;
      if (listing.num_points == 2) {
        ASSERT_NEAR(listing.t[0], zero + unit * library.t_enter, kRounding) << i;
        ASSERT_NEAR(listing.t[1], zero + unit * library.t_exit, kRounding) << i;
        ASSERT_LT((listing.point[0] - library.enter_point).norm(), kRounding) << i;
        ASSERT_LT((listing.point[1] - library.exit_point).norm(), kRounding) << i;
        points += 2;
      }
    }
  }
  EXPECT_GT(points, kQueries);
}

// What the paper prints, where it is wrong and can be run. Each correction is shown to be one: the
// printed text errs where the corrected listing does not.

const Vector3 kOnes = Vector3::Ones();
const OrientedBox3 kUnitCube = toOrientedBox3(AlignedBox{-kOnes, kOnes});

TEST(ListingsAsPrinted, Equation3TakesTheWrongAxis) {
  const CenteredSegment3 through = toCenteredSegment3(Segment{{0.0, 0.0, 0.0}, {0.0, 0.0, 4.0}});
  EXPECT_FALSE(as_printed::equation3(through, kUnitCube));
  EXPECT_TRUE(listing5::testIntersection(through, kUnitCube));

  const OrientedBox3 wall =
      toOrientedBox3(OrientedBox{{0.0, 0.0, 2.5}, Quaternion::Identity(), {1.0, 100.0, 1.0}});
  const CenteredSegment3 below{{0.0, 0.0, 0.0}, {0.0, 0.95, 0.312}, 2.0};
  EXPECT_TRUE(as_printed::equation3(below, wall));
  EXPECT_FALSE(listing5::testIntersection(below, wall));
}

TEST(ListingsAsPrinted, Listing6SwapsTheExtents) {
  const Vector3 P(4.0, 4.0, 4.0);
  const Vector3 D = kOnes.normalized();
  EXPECT_TRUE(as_printed::listing6::doSegmentQuery(P, D, 5.0, kOnes));
  EXPECT_FALSE(listing6::doSegmentQuery(P, D, 5.0, kOnes));
}

TEST(ListingsAsPrinted, Listings6And10SubtractTheCentreAfterRotating) {
  const OrientedBox3 box = {
      {10.0, 0.0, 0.0}, {Vector3::UnitY(), -Vector3::UnitX(), Vector3::UnitZ()}, kOnes};
  const Segment segment{{9.5, 0.0, 0.0}, {10.5, 0.0, 0.0}};
  EXPECT_FALSE(as_printed::listing6::testIntersection(segment, box));
  EXPECT_EQ(as_printed::listing10::findIntersection(segment, box).num_points, 0);
  EXPECT_TRUE(listing6::testIntersection(segment, box));
  EXPECT_EQ(listing10::findIntersection(segment, box).num_points, 2);
}

TEST(ListingsAsPrinted, Listings6And10RotateTheDirectionTwice) {
  const OrientedBox3 box = {
      Vector3::Zero(), {Vector3::UnitY(), -Vector3::UnitX(), Vector3::UnitZ()}, {0.5, 3.0, 1.0}};
  const Segment segment{{-5.0, 2.0, 0.0}, {5.0, 2.0, 0.0}};
  EXPECT_TRUE(as_printed::listing6::testIntersection(segment, box));
  EXPECT_GT(as_printed::listing10::findIntersection(segment, box).num_points, 0);
  EXPECT_FALSE(listing6::testIntersection(segment, box));
  EXPECT_EQ(listing10::findIntersection(segment, box).num_points, 0);
}

TEST(ListingsAsPrinted, Listing9CountsAContactTwice) {
  const AlignedBox box{-kOnes, kOnes};
  const Ray leaving{Vector3::UnitX(), Vector3::UnitX()};
  const Found printed = as_printed::listing9::findIntersection(leaving, box);
  EXPECT_EQ(printed.num_points, 2);
  EXPECT_EQ(printed.t[0], printed.t[1]);
  EXPECT_EQ(listing9::findIntersection(leaving, box).num_points, 1);
}

TEST(ListingsAsPrinted, Listings9And10LeaveParametersOnAMiss) {
  const AlignedBox box{-kOnes, kOnes};
  const Ray away{{5.0, 0.0, 0.0}, Vector3::UnitX()};
  const Found printed_ray = as_printed::listing9::findIntersection(away, box);
  EXPECT_EQ(printed_ray.num_points, 0);
  EXPECT_EQ(printed_ray.t[0], -6.0);
  EXPECT_EQ(printed_ray.t[1], -4.0);
  const Found ray = listing9::findIntersection(away, box);
  EXPECT_EQ(ray.num_points, 0);
  EXPECT_EQ(ray.t[0], kInfinity);
  EXPECT_EQ(ray.t[1], -kInfinity);

  const Segment beside{{5.0, 0.0, 0.0}, {7.0, 0.0, 0.0}};
  const Found printed_segment = as_printed::listing10::findIntersection(beside, kUnitCube);
  EXPECT_EQ(printed_segment.num_points, 0);
  EXPECT_EQ(printed_segment.t[0], -7.0);
  const Found segment = listing10::findIntersection(beside, kUnitCube);
  EXPECT_EQ(segment.t[0], kInfinity);
  EXPECT_EQ(segment.t[1], -kInfinity);
}

TEST(ListingsAsPrinted, Section22LetsAPointOutsideTouch) {
  const Ray point{{2.0, 0.0, 0.0}, Vector3::Zero()};
  EXPECT_TRUE(as_printed::section22(point, kUnitCube));
  EXPECT_FALSE(listing3::testIntersection(point, kUnitCube));
  EXPECT_FALSE(listing4::testIntersection(point, kUnitCube));
}

}  // namespace
}  // namespace box_query::listings
