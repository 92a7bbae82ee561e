// SPDX-License-Identifier: BSD-3-Clause
//
// Row 20 of our list of errata: the distance from a segment to a box, as the author of the paper
// computes it in his library, is the square root of a number that rounding makes negative.
#include "reference/oracle.h"
#include "reference/sampler.h"

#include <box_query/distance.h>
#include <box_query/intersection.h>

#include <gtest/gtest.h>

namespace box_query {
namespace {

constexpr int kQueries = 100000;

Vector3 nudged(reference::Sampler& sampler, Vector3 point, int ulps) {
  for (int i = 0; i < 3; ++i) {
    point[i] = sampler.nudged(point[i], ulps);
  }
  return point;
}

/// Squared distance from the line of a segment to the edge x = y = 1 of the cube, in the way of the
/// author's library: the square of the offset, less that of its part along the line.
double plainSquaredDistance(const Segment& segment) {
  const Vector3 d = segment.end - segment.start;
  Vector3 offset = segment.start - Vector3(1.0, 1.0, -1.0);
  const double across = d.x() * d.x() + d.y() * d.y();
  // From the point of the edge that is nearest to the line.
  offset.z() -= (across * offset.z() - d.z() * (d.x() * offset.x() + d.y() * offset.y())) / across;
  const double along = offset.dot(d);
  return offset.y() * offset.y() + offset.z() * offset.z() + offset.x() * offset.x() +
         along * (-along / (across + d.z() * d.z()));
}

TEST(Errata, Row20_DistanceIsNeverNan) {
  const AlignedBox cube{-Vector3::Ones(), Vector3::Ones()};
  const Segment past_edge{{1.1, 0.93, -0.4}, {0.7, 1.21, -0.1}};
  ASSERT_LT(plainSquaredDistance(past_edge), 0.0);
  const SegmentDistance found = distance(past_edge, cube);
  const oracle::Nearest exact = oracle::nearest(past_edge, cube);
  EXPECT_TRUE(oracle::isCorrectlyRoundedSqrt(found.distance, exact.squared));
  EXPECT_TRUE(oracle::isCorrectlyRounded(found.t, exact.t));
  EXPECT_LT(found.distance, 1e-15);
}

TEST(Errata, Row20_SegmentsPastEdges) {
  reference::Sampler sampler(20);
  const AlignedBox cube{-Vector3::Ones(), Vector3::Ones()};
  int plain_negative = 0;
  int touching = 0;
  for (int i = 0; i < kQueries; ++i) {
    const Vector3 edge(1.0, 1.0, sampler.uniform(-0.9, 0.9));
    const Vector3 direction(sampler.uniform(0.1, 1.0), sampler.uniform(-1.0, -0.1),
                            sampler.uniform(-0.1, 0.1));
    const Segment segment{nudged(sampler, edge - sampler.uniform(0.1, 1.0) * direction, 2),
                          nudged(sampler, edge + sampler.uniform(0.1, 1.0) * direction, 2)};
    const SegmentDistance found = distance(segment, cube);
    const oracle::Nearest exact = oracle::nearest(segment, cube);
    ASSERT_TRUE(oracle::isCorrectlyRoundedSqrt(found.distance, exact.squared)) << i;
    ASSERT_TRUE(oracle::isCorrectlyRounded(found.t, exact.t)) << i;
    ASSERT_EQ(found.distance == 0.0, testIntersection(segment, cube)) << i;
    ASSERT_EQ(isClear(segment, cube, 0.0), found.distance > 0.0) << i;
    touching += found.distance == 0.0;
    plain_negative += plainSquaredDistance(segment) < 0.0;
  }
  EXPECT_GT(plain_negative, kQueries / 20);
  EXPECT_GT(touching, kQueries / 5);
  EXPECT_LT(touching, kQueries * 4 / 5);
}

}  // namespace
}  // namespace box_query
