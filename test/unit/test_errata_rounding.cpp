// SPDX-License-Identifier: BSD-3-Clause
//
// Where D. Eberly, "Intersection of a Line and a Box" (2018) is right and double arithmetic is not,
// one test a row of our list of errata, 11 and 16 to 19. Each runs the row's counter-example and
// then its family of queries, against exact arithmetic: the library is never wrong, and the
// corrected listing is wrong often enough to show that the family is hostile.
#include "reference/listings.h"
#include "reference/oracle.h"
#include "reference/sampler.h"

#include <box_query/intersection.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace box_query {
namespace {

using namespace listings;  // NOLINT(google-build-using-namespace): all ten are compared with here.
using reference::Sampler;

constexpr int kQueries = 100000;

/// Answers of a family, by how often they were wrong.
struct Tally {
  int hits = 0;
  int library_wrong = 0;
  int listing_wrong = 0;

  void count(bool truth, bool library, bool listing) {
    hits += truth;
    library_wrong += library != truth;
    listing_wrong += listing != truth;
  }
  /// @param listing the least share of wrong answers of the listing, in parts of a million
  void expect(int listing) const {
    EXPECT_EQ(library_wrong, 0);
    EXPECT_GE(listing_wrong * 1e6 / kQueries, listing);
    EXPECT_GT(hits, kQueries / 5);
  }
};

AlignedBox randomAlignedBox(Sampler& sampler) {
  const Vector3 a = sampler.vector(-6.0, 6.0) / 3.0;  // A third fills all bits of a double.
  const Vector3 b = sampler.vector(-6.0, 6.0) / 3.0;
  return {a.cwiseMin(b), a.cwiseMax(b)};
}

OrientedBox randomOrientedBox(Sampler& sampler) {
  OrientedBox box;
  box.center = sampler.vector(-2.0, 2.0);
  box.orientation = sampler.rotation();
  box.half_extents = sampler.vector(0.1, 2.0);
  return box;
}

/// A point of an edge of the box, as nearly as doubles have one.
Vector3 pointOnEdge(Sampler& sampler, const OrientedBox3& box) {
  Vector3 y(box.e[0] * sampler.sign(), box.e[1] * sampler.sign(), box.e[2] * sampler.sign());
  y[sampler.index(3)] *= sampler.uniform(0.0, 0.9);
  return box.C + y[0] * box.U[0] + y[1] * box.U[1] + y[2] * box.U[2];
}

Vector3 nudged(Sampler& sampler, Vector3 point, int ulps) {
  for (int i = 0; i < 3; ++i) {
    point[i] = sampler.nudged(point[i], ulps);
  }
  return point;
}

/// A ray that grazes an edge of the box within a few roundings.
Ray grazingRay(Sampler& sampler, const OrientedBox3& box) {
  const Vector3 target = pointOnEdge(sampler, box);
  const Vector3 outward = target - box.C;
  const Vector3 along = outward.cross(sampler.direction());
  const Vector3 direction = (along + sampler.uniform(-0.2, 0.2) * outward).normalized();
  return {nudged(sampler, target - sampler.uniform(1.0, 5.0) * direction, 4), direction};
}

TEST(Errata, Row11_AlignedBoxKeepsMinAndMax) {
  const AlignedBox slab{{0.1, -1.0, -1.0}, {0.3, 1.0, 1.0}};
  const Line in_face{{0.1, 0.0, 0.0}, Vector3::UnitY()};
  ASSERT_FALSE(listing2::testIntersection(in_face, slab));
  EXPECT_TRUE(testIntersection(in_face, slab));

  const AlignedBox far{{1e308, -1.0, -1.0}, {1.5e308, 1.0, 1.0}};
  const Line through{{1.2e308, 0.0, 0.0}, Vector3::UnitY()};
  ASSERT_FALSE(listing2::testIntersection(through, far));
  EXPECT_TRUE(testIntersection(through, far));
  EXPECT_EQ(findIntersection(through, far).t_enter, -1.0);
}

TEST(Errata, Row11_LinesInFacePlanes) {
  Sampler sampler(11);
  Tally test;
  Tally find;
  for (int i = 0; i < kQueries; ++i) {
    const AlignedBox box = randomAlignedBox(sampler);
    const int axis = sampler.index(3);
    Line line;
    line.origin = box.min + sampler.uniform(0.1, 0.9) * (box.max - box.min);
    line.origin[axis] = sampler.chance(0.5) ? box.min[axis] : box.max[axis];
    line.direction = sampler.direction();
    line.direction[axis] = 0.0;
    ASSERT_TRUE(oracle::interval(line, box).hit());
    test.count(true, testIntersection(line, box), listing2::testIntersection(line, box));
    const Intersection found = findIntersection(line, box);
    find.count(true, found.num_points == 2, listing8::findIntersection(line, box).num_points == 2);
  }
  test.expect(100000);
  find.expect(100000);
}

TEST(Errata, Row16_RaysThatGrazeEdges) {
  Sampler sampler(16);
  Tally test;
  Tally find;
  int listings_disagree = 0;
  int inverted = 0;
  for (int i = 0; i < kQueries; ++i) {
    const OrientedBox box = randomOrientedBox(sampler);
    const OrientedBox3 listed_box = toOrientedBox3(box);
    const Ray ray = grazingRay(sampler, listed_box);
    const oracle::Interval exact = oracle::interval(ray, box);
    const Intersection found = findIntersection(ray, box);
    const Found listed = listing9::findIntersection(ray, listed_box);
    const bool listed_test = listing4::testIntersection(ray, listed_box);
    test.count(exact.hit(), testIntersection(ray, box), listed_test);
    find.count(exact.hit(), found.num_points > 0, listed.num_points > 0);
    listings_disagree += listed_test != (listed.num_points > 0);
    inverted += found.num_points > 0 && !(found.t_enter <= found.t_exit);
    ASSERT_EQ(found.num_points, exact.num_points) << i;
    ASSERT_EQ(found.entered, exact.entered) << i;
    ASSERT_EQ(found.left, exact.left) << i;
    if (exact.hit()) {
      ASSERT_TRUE(oracle::isCorrectlyRounded(found.t_enter, exact.enter)) << i;
      ASSERT_TRUE(oracle::isCorrectlyRounded(found.t_exit, exact.exit)) << i;
    }
  }
  test.expect(10000);
  find.expect(10000);
  EXPECT_GT(listings_disagree, kQueries / 1000);
  EXPECT_EQ(inverted, 0);
}

/// Whole numbers make the contact exact; a third of them moves the line past the edge by a
/// rounding, on either side.
TEST(Errata, Row16_LinesThatTouchEdgesExactly) {
  Sampler sampler(160);
  Tally find;
  for (int i = 0; i < kQueries; ++i) {
    // Through (1, 1, z) with a slope of -a / b: touches the edge x = y = 1 of the cube.
    const double a = 1.0 + sampler.index(1000);
    const double b = 1.0 + sampler.index(1000);
    const int steps = 1 + sampler.index(8);
    const Vector3 direction(a, -b, sampler.index(3) - 1.0);
    const Line line{Vector3(1.0, 1.0, 0.0) - steps * direction, direction};
    const AlignedBox cube{-Vector3::Ones(), Vector3::Ones()};
    ASSERT_EQ(oracle::interval(line, cube).num_points, 1);
    ASSERT_TRUE(testIntersection(line, cube));
    const Intersection found = findIntersection(line, cube);
    ASSERT_EQ(found.t_enter, steps);
    ASSERT_EQ(found.t_exit, steps);
    const Line rounded{line.origin, direction / 3.0};
    const bool truth = oracle::interval(rounded, cube).hit();
    find.count(truth, findIntersection(rounded, cube).num_points > 0,
               listing8::findIntersection(rounded, cube).num_points > 0);
  }
  find.expect(1000);
}

/// Whether the segment and the box meet, by listing 8 with the end points as they are.
bool endPointsMeet(const Segment& segment, const OrientedBox3& box) {
  const Found found =
      listing8::findIntersection(Line{segment.start, segment.end - segment.start}, box);
  return found.num_points > 0 && found.t[1] >= 0.0 && found.t[0] <= 1.0;
}

TEST(Errata, Row17_SegmentsFarFromTheOriginKeepTheirEndPoints) {
  Sampler sampler(17);
  Tally centered;
  int end_points_wrong = 0;
  for (int i = 0; i < kQueries; ++i) {
    OrientedBox box = randomOrientedBox(sampler);
    box.center += sampler.logUniform(1e3, 1e9) * sampler.direction();
    const OrientedBox3 listed_box = toOrientedBox3(box);
    const Ray ray = grazingRay(sampler, listed_box);
    const Segment segment{ray.origin, ray.origin + 6.0 * ray.direction};
    const bool truth = oracle::interval(segment, box).hit();
    centered.count(truth, testIntersection(segment, box),
                   listing6::testIntersection(segment, listed_box));
    end_points_wrong += endPointsMeet(segment, listed_box) != truth;
    const Intersection found = findIntersection(segment, box);
    ASSERT_EQ(found.num_points > 0, truth) << i;
    ASSERT_TRUE(!truth || (found.t_enter >= 0.0 && found.t_exit <= 1.0)) << i;
  }
  centered.expect(10000);
  EXPECT_LT(end_points_wrong, centered.listing_wrong / 10);
}

TEST(Errata, Row18_QuaternionsOffUnitLengthAreExact) {
  // Axes 1.001 long, as a matrix from a quaternion that is not normalised may have them.
  const OrientedBox3 stretched{
      Vector3::Zero(),
      {1.001 * Vector3::UnitX(), 1.001 * Vector3::UnitY(), 1.001 * Vector3::UnitZ()},
      Vector3::Ones()};
  const Line near_face{{0.0, 0.9995, 0.0}, Vector3::UnitX()};
  ASSERT_NE(listing1::testIntersection(near_face, stretched),
            listing2::testIntersection(near_face, stretched));
  const OrientedBox cube{Vector3::Zero(), Quaternion(1.001, 0.0, 0.0, 0.0), Vector3::Ones()};
  EXPECT_TRUE(testIntersection(near_face, cube));
  EXPECT_EQ(findIntersection(near_face, cube).t_enter, -1.0);
  EXPECT_FALSE(testIntersection(Line{{0.0, 1.0005, 0.0}, Vector3::UnitX()}, cube));
}

TEST(Errata, Row18_RaysThatGrazeBoxesOffUnitLength) {
  Sampler sampler(18);
  Tally world;
  Tally frame;
  for (int i = 0; i < kQueries; ++i) {
    OrientedBox box = randomOrientedBox(sampler);
    box.orientation.coeffs() *= sampler.uniform(0.99, 1.01);
    const OrientedBox3 listed_box = toOrientedBox3(box);
    const Ray ray = grazingRay(sampler, listed_box);
    const bool truth = oracle::interval(ray, box).hit();
    const bool library = testIntersection(ray, box);
    world.count(truth, library, listing3::testIntersection(ray, listed_box));
    frame.count(truth, library, listing4::testIntersection(ray, listed_box));
    ASSERT_EQ(findIntersection(ray, box).num_points > 0, truth) << i;
  }
  world.expect(10000);
  frame.expect(10000);
}

TEST(Errata, Row19_DirectionEqualToARoundedAxis) {
  const struct {
    double distance;  ///< [m]
    int listing_wrong_per_million;
  } rows[] = {{10.0, 200000}, {100.0, 600000}, {1000.0, 800000}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.distance);
    Sampler sampler(19);
    Tally world;
    Tally frame;
    for (int i = 0; i < kQueries; ++i) {
      const OrientedBox box = randomOrientedBox(sampler);
      const OrientedBox3 listed_box = toOrientedBox3(box);
      const auto axis = static_cast<std::size_t>(sampler.index(3));
      const Vector3 y = listed_box.e.cwiseProduct(sampler.vector(-0.5, 0.5));
      const Vector3 target =
          box.center + y[0] * listed_box.U[0] + y[1] * listed_box.U[1] + y[2] * listed_box.U[2];
      const Line line{target - row.distance * listed_box.U[axis], listed_box.U[axis]};
      ASSERT_TRUE(oracle::interval(line, box).hit());
      const bool library = testIntersection(line, box);
      world.count(true, library, listing1::testIntersection(line, listed_box));
      frame.count(true, library, listing2::testIntersection(line, listed_box));
    }
    world.expect(row.listing_wrong_per_million);
    EXPECT_EQ(frame.listing_wrong, 0);
  }
}

}  // namespace
}  // namespace box_query
