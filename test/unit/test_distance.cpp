// SPDX-License-Identifier: BSD-3-Clause
#include <box_query/distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace box_query {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();
constexpr double kHuge = std::numeric_limits<double>::max();

const AlignedBox kCube{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};
const Quaternion kIdentity = Quaternion::Identity();

OrientedBox oriented(const AlignedBox& box) {
  return {(box.min + box.max) / 2.0, kIdentity, (box.max - box.min) / 2.0};
}

struct Case {
  Segment segment;
  double distance;
  double t;
  Vector3 on_segment;
  Vector3 on_box;
};

// clang-format off
const Case kCases[] = {
    // nearest at the start, at the end, at a face, at an edge, at a corner
    {{{3, 0, 0}, {5, 0, 0}}, 2, 0, {3, 0, 0}, {1, 0, 0}},
    {{{5, 0, 0}, {3, 0, 0}}, 2, 1, {3, 0, 0}, {1, 0, 0}},
    {{{4, 5, 0}, {6, 5, 0}}, 5, 0, {4, 5, 0}, {1, 1, 0}},
    {{{0, 4, 0}, {4, 0, 0}}, std::sqrt(2.0), 0.5, {2, 2, 0}, {1, 1, 0}},
    {{{2, 2, -4}, {2, 2, 4}}, std::sqrt(2.0), 0.375, {2, 2, -1}, {1, 1, -1}},
    {{{2, 3, 3}, {2, 3, 4}}, 3, 0, {2, 3, 3}, {1, 1, 1}},
    {{{3, 2, 3}, {3, 6, 7}}, 3, 0, {3, 2, 3}, {1, 1, 1}},
    // along a face: the smallest parameter of many
    {{{-4, 0, 3}, {4, 0, 3}}, 2, 0.375, {-1, 0, 3}, {-1, 0, 1}},
    {{{0, 0, 3}, {4, 0, 3}}, 2, 0, {0, 0, 3}, {0, 0, 1}},
    {{{-4, 1, 3}, {4, 1, 3}}, 2, 0.375, {-1, 1, 3}, {-1, 1, 1}},
    // meeting: through, from inside, touching a face, an edge, a corner
    {{{-3, 0, 0}, {3, 0, 0}}, 0, 1.0 / 3.0, {-1, 0, 0}, {-1, 0, 0}},
    {{{0.5, 0, 0}, {3, 0, 0}}, 0, 0, {0.5, 0, 0}, {0.5, 0, 0}},
    {{{1, -2, 0}, {1, 2, 0}}, 0, 0.25, {1, -1, 0}, {1, -1, 0}},
    {{{0, 2, 0}, {2, 0, 0}}, 0, 0.5, {1, 1, 0}, {1, 1, 0}},
    {{{1, 1, -3}, {1, 1, 5}}, 0, 0.25, {1, 1, -1}, {1, 1, -1}},
    // a point
    {{{4, 5, 0}, {4, 5, 0}}, 5, 0, {4, 5, 0}, {1, 1, 0}},
    {{{1, 1, 1}, {1, 1, 1}}, 0, 0, {1, 1, 1}, {1, 1, 1}},
};
// clang-format on

TEST(Distance, Table) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(testing::Message()
                 << c.segment.start.transpose() << " to " << c.segment.end.transpose());
    for (const SegmentDistance& d :
         {distance(c.segment, kCube), distance(c.segment, oriented(kCube))}) {
      EXPECT_EQ(d.distance, c.distance);
      EXPECT_EQ(d.t, c.t);
      EXPECT_LE((d.on_segment - c.on_segment).cwiseAbs().maxCoeff(), 1e-15);
      EXPECT_LE((d.on_box - c.on_box).cwiseAbs().maxCoeff(), 1e-15);
    }
  }
}

TEST(Distance, ErrataRow20IsNotTheRootOfANegativeNumber) {
  const Segment segment{{1.1, 0.93, -0.4}, {0.7, 1.21, -0.1}};
  for (const SegmentDistance& d : {distance(segment, kCube), distance(segment, oriented(kCube))}) {
    // The nearest point is in the plane of the segment and the edge x = y = 1.
    const double expected = (0.1 * 0.28 - 0.07 * 0.4) / std::hypot(0.4, 0.28);
    EXPECT_FALSE(std::isnan(d.distance));
    EXPECT_GE(d.distance, 0.0);
    EXPECT_NEAR(d.distance, std::abs(expected), 1e-15);
    EXPECT_NEAR(d.t, 0.25, 1e-12);
  }
}

TEST(Distance, FlatLineAndPointBoxes) {
  const AlignedBox plate{{-1, -1, 0}, {1, 1, 0}};
  const AlignedBox line{{0, 0, -1}, {0, 0, 1}};
  const AlignedBox point{{0, 0, 0}, {0, 0, 0}};
  const Segment above{{-2, 0, 2}, {2, 0, 2}};
  for (const AlignedBox& box : {plate, line, point}) {
    EXPECT_EQ(distance(above, box).distance, distance(above, oriented(box)).distance);
    EXPECT_EQ(distance(above, box).t, distance(above, oriented(box)).t);
  }
  EXPECT_EQ(distance(above, plate).distance, 2.0);
  EXPECT_EQ(distance(above, plate).t, 0.25);
  EXPECT_EQ(distance(above, line).distance, 1.0);
  EXPECT_EQ(distance(above, point).distance, 2.0);
  EXPECT_EQ(distance(above, point).t, 0.5);
  EXPECT_EQ(distance({{-1, 0, -1}, {1, 0, 1}}, plate).distance, 0.0);
  EXPECT_EQ(distance({{-1, 0, -1}, {1, 0, 1}}, point).t, 0.5);
}

TEST(Distance, TheNormOfTheQuaternionDoesNotMatter) {
  const Segment segment{{2.0, 3.0, 5.0}, {-4.0, 3.5, 4.0}};
  const OrientedBox box{{0.25, -0.5, 0.125}, {0.5, -0.25, 0.75, 0.125}, {1.0, 0.5, 0.25}};
  const SegmentDistance expected = distance(segment, box);
  for (const double scale : {-1.0, 0x1p500, 0x1p-500, 0x1p-1070}) {
    const SegmentDistance d = distance(
        segment, {box.center, Quaternion(scale * box.orientation.coeffs()), box.half_extents});
    EXPECT_EQ(d.distance, expected.distance);
    EXPECT_EQ(d.t, expected.t);
    EXPECT_EQ(d.on_segment, expected.on_segment);
    EXPECT_EQ(d.on_box, expected.on_box);
  }
}

TEST(Distance, ASegmentWhoseDirectionUnderflowsInTheFrameOfTheBox) {
  const Segment segment{{-kTiny, -kTiny, 1.0}, {2 * kTiny, -2 * kTiny, 1.0}};
  for (const double x : {0.1, 0.2, 0.3, 0.4}) {
    for (const double y : {-0.4, -0.2, 0.2, 0.4}) {
      const OrientedBox point{{0, 0, 0}, Quaternion(0.7, x, y, 0.3), {0, 0, 0}};
      const SegmentDistance d = distance(segment, point);
      EXPECT_EQ(d.distance, 1.0);
      EXPECT_EQ(d.t, 0.2) << x << " " << y;
    }
  }
}

TEST(Distance, WholeRangeOfDouble) {
  const AlignedBox all{Vector3::Constant(-kHuge), Vector3::Constant(kHuge)};
  EXPECT_EQ(distance({Vector3::Constant(-kHuge), Vector3::Constant(kHuge)}, all).distance, 0.0);
  // Farther than a double can say: infinite, but not clear of nothing.
  const AlignedBox far{Vector3::Constant(-kHuge), Vector3::Constant(-kHuge)};
  const Segment opposite{Vector3::Constant(kHuge), Vector3::Constant(kHuge)};
  EXPECT_EQ(distance(opposite, far).distance, kInf);
  EXPECT_TRUE(isClear(opposite, far, kHuge));
  // Less than half the smallest double: the distance is 0, yet the two do not meet.
  const OrientedBox tilted{{0, 0, 0}, {1.0, 0.5, 0, 0}, {1.0, kTiny, kTiny}};
  const Segment near{{0, kTiny, kTiny}, {0, kTiny, kTiny}};
  EXPECT_EQ(distance(near, tilted).distance, 0.0);
  EXPECT_TRUE(isClear(near, tilted, 0.0));
  EXPECT_FALSE(isClear(near, tilted, kTiny));
  // The nearest point divides a huge segment, and a tiny one.
  EXPECT_EQ(distance({{-kHuge, 2, 0}, {kHuge, 2, 0}}, {{0, 0, 0}, {0, 0, 0}}).t, 0.5);
  EXPECT_EQ(distance({{-2 * kTiny, kTiny, 0}, {2 * kTiny, kTiny, 0}}, {{0, 0, 0}, {0, 0, 0}}).t,
            0.5);
  const SegmentDistance d = distance({{-kHuge, kHuge, 0}, {kHuge, kHuge, 0}},
                                     OrientedBox{{kHuge, 0, 0}, {1, 2, 3, 4}, {kHuge, kHuge, 0}});
  EXPECT_TRUE(d.on_segment.allFinite());
  EXPECT_FALSE(d.on_box.hasNaN());
}

TEST(IsClear, TouchingTheRadiusIsNotClear) {
  const Segment segment{{4, 5, -1}, {4, 5, 1}};
  const double below = std::nextafter(5.0, 0.0);
  for (const Box& any : {Box(kCube), Box(oriented(kCube))}) {
    std::visit(
        [&](const auto& box) {
          EXPECT_FALSE(isClear(segment, box, 5.0));
          EXPECT_TRUE(isClear(segment, box, below));
          EXPECT_EQ(blockedAt(segment, box, 5.0), 0.0);
          EXPECT_EQ(blockedAt(segment, box, below), kInf);
          EXPECT_FALSE(isClear({{1, -3, 0}, {1, 3, 0}}, box, 0.0));
          EXPECT_TRUE(isClear({{std::nextafter(1.0, 2.0), -3, 0}, {2, 3, 0}}, box, 0.0));
        },
        any);
  }
}

TEST(BlockedAt, Table) {
  struct {
    Segment segment;
    double radius;
    double t;
  } const cases[] = {
      {{{-5, 0, 0}, {3, 0, 0}}, 0, 0.5},    // enters
      {{{-5, 0, 0}, {3, 0, 0}}, 2, 0.25},   // reaches the rounded box at a face
      {{{-7, 2, 0}, {9, 2, 0}}, 1, 0.375},  // touches it along a face: the first of many
      {{{6, 5, 0}, {-2, 5, 0}}, 5, 0.25},   // at an edge, 3-4-5 from it
      {{{0, 0, 0}, {9, 0, 0}}, 3, 0.0},     // starts inside
      {{{3, 0, 0}, {9, 0, 0}}, 3, 0.0},     // starts within the radius
      {{{3, 0, 0}, {9, 0, 0}}, 1, kInf},    // leaves
      {{{9, 0, 0}, {2, 0, 0}}, 1, 1.0},     // only the end is within
      {{{3, 0, 0}, {3, 0, 0}}, 2, 0.0},     // a point
      {{{3, 0, 0}, {3, 0, 0}}, 1, kInf},
  };
  for (const auto& c : cases) {
    EXPECT_EQ(blockedAt(c.segment, kCube, c.radius), c.t);
    EXPECT_EQ(blockedAt(c.segment, oriented(kCube), c.radius), c.t);
  }
}

TEST(BlockedAt, RoundsDownWhereTheRootIsNotADouble) {
  // t = 0.3 is between two doubles: 1 / 10 of the way below or above.
  const Segment segment{{-4, 0, 0}, {6, 0, 0}};
  const double t = blockedAt(segment, kCube, 0.0);
  EXPECT_EQ(t, 0.3);
  const Segment scaled{{-5, 0, 0}, {7, 0, 0}};  // 3 / 12 with radius 1
  EXPECT_EQ(blockedAt(scaled, kCube, 1.0), 0.25);
  const Segment thirds{{-4, 0, 0}, {2, 0, 0}};          // 2 / 6
  EXPECT_EQ(blockedAt(thirds, kCube, 1.0), 1.0 / 3.0);  // 1.0 / 3.0 is below a third
  const Segment fifths{{-8, 0, 0}, {2, 0, 0}};          // 6 / 10, whose nearest double is below
  EXPECT_EQ(blockedAt(fifths, kCube, 1.0), 0.6);
  const Segment tenth{{-3, 0, 0}, {7, 0, 0}};  // 1 / 10, whose nearest double is above
  EXPECT_EQ(blockedAt(tenth, kCube, 1.0), std::nextafter(0.1, 0.0));
}

TEST(Distance, AClosestPointBeyondTheLargestDoubleIsFinite) {
  // An eighth turn about z: the nearest point of the box lies in direction (1, -1) of the segment.
  const double half_angle = std::atan(1.0) / 2.0;
  const OrientedBox box = {{1.7e308, -1e308, 0},
                           Quaternion(std::cos(half_angle), 0, 0, std::sin(half_angle)),
                           {1.7e308, 1e307, 1}};
  const Vector3 at(1.79e308, 1e308, 0);
  const SegmentDistance nearest = distance(Segment{at, at}, box);
  EXPECT_NEAR(nearest.distance / 1e308, 1.25, 0.01);
  EXPECT_EQ(nearest.on_box.x(), std::numeric_limits<double>::max());
  EXPECT_NEAR(nearest.on_box.y() / 1e308, 0.115, 0.01);
}

}  // namespace
}  // namespace box_query
