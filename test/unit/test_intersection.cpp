// SPDX-License-Identifier: BSD-3-Clause
#include <box_query/intersection.h>

#include <cmath>
#include <initializer_list>
#include <limits>

#include <gtest/gtest.h>

namespace box_query {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kMax = std::numeric_limits<double>::max();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();

const AlignedBox kCube{{-1, -1, -1}, {1, 1, 1}};
const OrientedBox kOrientedCube{Vector3::Zero(), Quaternion(1, 0, 0, 0), Vector3::Ones()};
/// Exactly a quarter turn about z, though the quaternion is not of unit length.
const Quaternion kQuarterTurn(0.7, 0, 0, 0.7);

FaceSet faces(std::initializer_list<unsigned> numbers) {
  unsigned bits = 0;
  for (const unsigned n : numbers) {
    bits |= 1U << n;
  }
  return FaceSet(bits);
}

bool same(double a, double b) {
  return a == b && std::signbit(a) == std::signbit(b);
}

/// What is true of every answer.
template <typename T, typename BoxType>
Intersection checked(const T& linear, const BoxType& box) {
  Intersection result = findIntersection(linear, box);
  EXPECT_EQ(testIntersection(linear, box), result.num_points > 0);
  EXPECT_EQ(result.num_points == 0, std::isnan(result.enter_point[0]));
  if (result.num_points > 0) {
    EXPECT_LE(result.t_enter, result.t_exit);
    EXPECT_FALSE(result.enter_point.hasNaN());
    EXPECT_FALSE(result.exit_point.hasNaN());
  } else {
    EXPECT_EQ(result.t_enter, kInf);
    EXPECT_EQ(result.t_exit, -kInf);
    EXPECT_TRUE(result.entered.empty() && result.left.empty());
  }
  return result;
}

/// The same for the unit cube in both of its forms.
template <typename T>
Intersection inCube(const T& linear) {
  Intersection a = checked(linear, kCube);
  const Intersection b = checked(linear, kOrientedCube);
  EXPECT_EQ(a.num_points, b.num_points);
  EXPECT_TRUE(same(a.t_enter, b.t_enter) && same(a.t_exit, b.t_exit));
  EXPECT_EQ(a.started_inside, b.started_inside);
  EXPECT_EQ(a.entered, b.entered);
  EXPECT_EQ(a.left, b.left);
  return a;
}

TEST(FindIntersection, ParametersOfALineARayAndASegmentThroughTheMiddle) {
  const Intersection line = inCube(Line{{5, 0, 0}, {-2, 0, 0}});
  EXPECT_EQ(line.num_points, 2);
  EXPECT_EQ(line.t_enter, 2.0);
  EXPECT_EQ(line.t_exit, 3.0);
  EXPECT_EQ(line.entered, faces({1}));
  EXPECT_EQ(line.left, faces({0}));
  EXPECT_EQ(line.enter_point, Vector3(1, 0, 0));
  EXPECT_EQ(line.exit_point, Vector3(-1, 0, 0));

  EXPECT_EQ(inCube(Line{{-5, 0, 0}, {-2, 0, 0}}).t_enter, -3.0);
  EXPECT_EQ(inCube(Ray{{-5, 0, 0}, {-2, 0, 0}}).num_points, 0);
  EXPECT_EQ(inCube(Ray{{5, 0, 0}, {-2, 0, 0}}).t_enter, 2.0);

  const Intersection segment = inCube(Segment{{3, 0, 0}, {-1, 0, 0}});
  EXPECT_EQ(segment.num_points, 2);
  EXPECT_EQ(segment.t_enter, 0.5);
  EXPECT_EQ(segment.t_exit, 1.0);
  EXPECT_EQ(segment.left, faces({0})) << "the face through which it passes at its own end";
  EXPECT_EQ(inCube(Segment{{3, 0, 0}, {2, 0, 0}}).num_points, 0);
}

TEST(FindIntersection, StartingInsideEntersThroughNoFace) {
  const Intersection ray = inCube(Ray{{0, 0, 0}, {0, 0, 1}});
  EXPECT_TRUE(ray.started_inside);
  EXPECT_EQ(ray.t_enter, 0.0);
  EXPECT_TRUE(ray.entered.empty());
  EXPECT_EQ(ray.left, faces({5}));
  const Intersection segment = inCube(Segment{{0, 0, 0}, {0, 0.5, 0}});
  EXPECT_TRUE(segment.started_inside);
  EXPECT_TRUE(segment.entered.empty() && segment.left.empty());
  EXPECT_EQ(segment.t_exit, 1.0);
  EXPECT_FALSE(inCube(Line{{0, 0, 0}, {0, 0, 1}}).started_inside);
}

TEST(FindIntersection, AFacePassedAtTheStartBelongsToTheSet) {
  const Intersection in = inCube(Ray{{-1, 0, 0}, {1, 0, 0}});
  EXPECT_TRUE(in.started_inside);
  EXPECT_EQ(in.entered, faces({0}));
  EXPECT_EQ(in.num_points, 2);
  const Intersection out = inCube(Ray{{1, 0, 0}, {1, 0, 0}});
  EXPECT_EQ(out.num_points, 1);
  EXPECT_TRUE(out.started_inside);
  EXPECT_TRUE(same(out.t_enter, 0.0) && same(out.t_exit, 0.0));
  EXPECT_EQ(out.left, faces({1}));
}

TEST(FindIntersection, EdgesAndCornersAreSetsOfFaces) {
  const Intersection corner = inCube(Ray{{-2, -2, -2}, {1, 1, 1}});
  EXPECT_EQ(corner.entered, faces({0, 2, 4}));
  EXPECT_EQ(corner.left, faces({1, 3, 5}));
  const Intersection edge = inCube(Line{{-2, -2, 0}, {3, 3, 0}});
  EXPECT_EQ(edge.entered, faces({0, 2}));
  const Intersection graze = inCube(Line{{-2, 0, 0.25}, {1, 1, 0}});
  EXPECT_EQ(graze.num_points, 1);
  EXPECT_EQ(graze.entered, faces({0}));
  EXPECT_EQ(graze.left, faces({3}));
  EXPECT_EQ(graze.t_enter, 1.0);
  EXPECT_EQ(inCube(Line{{-2 - 0x1p-50, 0, 0.25}, {1, 1, 0}}).num_points, 0);
  EXPECT_EQ(inCube(Line{{-2 + 0x1p-50, 0, 0.25}, {1, 1, 0}}).num_points, 2);
}

TEST(FindIntersection, RunningInAFacePlaneTouches) {
  EXPECT_EQ(inCube(Ray{{-3, 1, 0}, {1, 0, 0}}).num_points, 2);
  EXPECT_EQ(inCube(Ray{{-3, 1, 1}, {1, -0.0, 0}}).num_points, 2);
  EXPECT_EQ(inCube(Ray{{-3, 1 + 0x1p-52, 1}, {1, 0, 0}}).num_points, 0);
  EXPECT_EQ(inCube(Ray{{-3, 1, 1}, {1, kTiny, 0}}).num_points, 0);
  EXPECT_EQ(inCube(Ray{{-3, 1, 1}, {1, -kTiny, 0}}).num_points, 2);
}

TEST(FindIntersection, FlatBoxesLinesAndPointsAreSolids) {
  const AlignedBox flat{{-1, -1, 2}, {1, 1, 2}};
  const Intersection through = checked(Ray{{0, 0, 0}, {0, 0, 1}}, flat);
  EXPECT_EQ(through.num_points, 1);
  EXPECT_EQ(through.t_enter, 2.0);
  EXPECT_EQ(through.entered, faces({4}));
  EXPECT_EQ(through.left, faces({5}));
  EXPECT_EQ(checked(Ray{{-3, 0, 2}, {1, 0, 0}}, flat).num_points, 2);
  const AlignedBox point{{1, 2, 3}, {1, 2, 3}};
  EXPECT_EQ(checked(Line{{0, 0, 0}, {1, 2, 3}}, point).entered, faces({0, 2, 4}));
  EXPECT_EQ(checked(Line{{0, 0, kTiny}, {1, 2, 3}}, point).num_points, 0);
}

TEST(FindIntersection, AZeroDirectionIsAPointThatKeepsItsOwnInterval) {
  const Intersection line = inCube(Line{{1, 0, 0}, {0, 0, 0}});
  EXPECT_EQ(line.num_points, 1);
  EXPECT_EQ(line.t_enter, -kInf);
  EXPECT_EQ(line.t_exit, kInf);
  EXPECT_EQ(line.enter_point, Vector3(1, 0, 0));
  const Intersection ray = inCube(Ray{{0, 0.5, 0}, {-0.0, 0, 0}});
  EXPECT_EQ(ray.num_points, 1);
  EXPECT_EQ(ray.t_enter, 0.0);
  EXPECT_EQ(ray.t_exit, kInf);
  EXPECT_TRUE(ray.started_inside);
  const Intersection segment = inCube(Segment{{0, 0.5, 0}, {0, 0.5, 0}});
  EXPECT_EQ(segment.num_points, 1);
  EXPECT_EQ(segment.t_exit, 1.0);
  EXPECT_EQ(inCube(Segment{{5, 5, 5}, {5, 5, 5}}).num_points, 0);
}

TEST(FindIntersection, ParametersAreCorrectlyRounded) {
  EXPECT_EQ(inCube(Ray{{-2, 0, 0}, {3, 0, 0}}).t_enter, 1.0 / 3.0);
  // The exact difference of the ends is not a double: t = 0.1 / (0.1 + 2^60).
  EXPECT_EQ(
      checked(Segment{{-0.1, 0, 0}, {0x1p60, 0, 0}}, AlignedBox{{0, 0, 0}, {1, 1, 1}}).t_enter,
      0.1 * 0x1p-60);
  EXPECT_EQ(checked(Line{{0.1, 0, 0}, {0.3, 0, 0}}, AlignedBox{{0.3, 0, 0}, {1, 1, 1}}).t_enter,
            0x1.5555555555555p-1);
}

TEST(FindRanges, MetresAlongTheComponentCorrectlyRounded) {
  const IntersectionRanges line = findRanges(Line{{5, 0, 0}, {2, 2, 0}}, kCube);
  EXPECT_EQ(line.enter, kInf);
  EXPECT_EQ(line.exit, -kInf);
  const Segment diagonal{{-3, -3, 0}, {4, 4, 0}};
  for (const IntersectionRanges& r :
       {findRanges(diagonal, kCube), findRanges(diagonal, kOrientedCube)}) {
    EXPECT_EQ(r.enter, std::sqrt(8.0));
    EXPECT_EQ(r.exit, std::sqrt(32.0));
  }
  EXPECT_EQ(findRanges(Line{{2, 2, 0}, {1, 1, 0}}, kCube).enter, -std::sqrt(18.0));
  EXPECT_EQ(findRanges(Ray{{-2, 0, 0}, {1e-310, 0, 0}}, kCube).exit, 3.0);
  EXPECT_EQ(findRanges(Line{{1, 0, 0}, {0, 0, 0}}, kCube).enter, 0.0);
}

TEST(FindIntersection, TheWholeRangeOfDouble) {
  const Intersection slow = inCube(Ray{{-1.5, 0, 0}, {1e-310, 0, 0}});
  EXPECT_EQ(slow.num_points, 2);
  EXPECT_EQ(slow.t_enter, kInf);
  EXPECT_EQ(slow.enter_point, Vector3(-1, 0, 0));
  const Intersection fast = inCube(Ray{{-1 - 0x1p-52, 0, 0}, {kMax, 0, 0}});
  EXPECT_EQ(fast.num_points, 2);
  EXPECT_TRUE(same(fast.t_enter, 0.0));
  EXPECT_EQ(fast.entered, faces({0}));
  EXPECT_EQ(inCube(Line{{1e200, 1.1e200, 0}, {1e200, 1e200, 0}}).num_points, 0);
  EXPECT_EQ(inCube(Segment{{-kMax, 0, 0}, {kMax, 0, 0}}).t_enter, 0.5);
  const AlignedBox huge{{1e308, 0, 0}, {1.5e308, 1, 1}};
  EXPECT_EQ(checked(Ray{{0, 0, 0}, {1, 0, 0}}, huge).t_enter, 1e308);
  const AlignedBox tiny{{kTiny, 0, 0}, {2 * kTiny, 1, 1}};
  EXPECT_EQ(checked(Ray{{0, 0, 0}, {1, 0, 0}}, tiny).t_exit, 2 * kTiny);
}

TEST(FindIntersection, OrientedBoxesAreExactlyOrthogonalWhateverTheNorm) {
  const OrientedBox box{{10, 0, 0}, kQuarterTurn, {1, 2, 3}};
  // Its own x axis is the world's y.
  const Intersection hit = checked(Ray{{10, -5, 3}, {0, 1, 0}}, box);
  EXPECT_EQ(hit.num_points, 2);
  EXPECT_EQ(hit.t_enter, 4.0);
  EXPECT_EQ(hit.entered, faces({0}));
  EXPECT_EQ(hit.left, faces({1}));
  EXPECT_EQ(checked(Ray{{10, -5, 3 + 0x1p-51}, {0, 1, 0}}, box).num_points, 0);
  for (const double scale : {1e-160, 1e-300, 1.0, 1e150, 1e300}) {
    OrientedBox scaled = box;
    scaled.orientation.coeffs() *= scale;
    EXPECT_EQ(checked(Ray{{0, 0, 0}, {1, 0, 0}}, scaled).t_enter, 8.0);
  }
}

// The kernels compared sums that were not normalised with bounds of double-doubles: a false miss.
TEST(FindIntersection, ALineInAFacePlaneOfABoxThatIsHardlyTurned) {
  const OrientedBox box{
      {-0.5, -1, -1}, Quaternion(-0x1.ccf7b05b93319p-42, 0, 0x1.fffffffffffffp-1, 0), {2, 0, 2}};
  const Vector3 origin(-0x1.bfffffffff198p+1, -3, 0x1.0000000002b37p+0);
  const Intersection touch = checked(Line{origin, {2, 2, -0x1.ccf7b05b9331ap-40}}, box);
  EXPECT_EQ(touch.num_points, 1);
  EXPECT_EQ(touch.t_enter, 1.0);
  EXPECT_EQ(touch.entered, faces({2}));
}

TEST(FindIntersection, APointBeyondTheLargestDoubleIsFinite) {
  const OrientedBox box = {{1e308, 0, 0}, Quaternion::Identity(), {1e308, 1, 1}};
  const Intersection i = findIntersection(Ray{{0.5e308, 0, 0}, {1, 0, 0}}, box);
  ASSERT_EQ(i.num_points, 2);
  EXPECT_EQ(i.t_exit, 1.5e308);
  EXPECT_EQ(i.exit_point, Vector3(std::numeric_limits<double>::max(), 0, 0));
}

}  // namespace
}  // namespace box_query
