// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_list.h"
#include "ros/limits.h"

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace box_query {
namespace {

const OrientedBox kShape{Vector3(0.1, -0.2, 0.3), Quaternion(0.8, 0.0, 0.0, 0.6),
                         Vector3(0.5, 0.0, 1.5)};
const OrientedBox kUpright{Vector3::Zero(), Quaternion::Identity(), Vector3::Ones()};

/// Points as the bytes of a message.
WireArray wireArray(const std::vector<Vector3>& points) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(points.data());
  return {static_cast<std::uint32_t>(points.size()), WireBlock(bytes)};
}

BoxList pointList(const std::vector<Vector3>& points, const OrientedBox& shape = kShape,
                  std::int64_t first_id = -3) {
  BoxList list;
  list.setPoints(first_id, shape, wireArray(points));
  return list;
}

bool areSurelyWithin(double limit, const OrientedBox& shape, const std::vector<Vector3>& points) {
  Magnitudes places;
  places.see(points.data(), 3 * points.size());
  return areSurelyWithin(limit, shape.center, shape.orientation, places);
}

void expectSame(const IdentifiedBox& a, const IdentifiedBox& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.box.center, b.box.center);
  EXPECT_EQ(a.box.orientation.coeffs(), b.box.orientation.coeffs());
  EXPECT_EQ(a.box.half_extents, b.box.half_extents);
}

TEST(BoxList, SaysTheSameOfPointsOnceTheyAreSpread) {
  const BoxList list = pointList({Vector3(1.0, 0.0, 0.0), Vector3(0.0, 1.0 / 3.0, 7.0)});
  BoxList spread = list;
  ASSERT_EQ(spread.each().size(), 2U);
  ASSERT_EQ(spread.size(), 2U);
  std::size_t n = 0;
  for (const IdentifiedBox& box : list) {
    EXPECT_EQ(list.id(n), box.id);
    expectSame(box, spread[n]);
    expectSame(box, spread.each()[n++]);
  }
  EXPECT_EQ(n, 2U);
  EXPECT_EQ(list.id(1), (1LL << 32) - 3);
  EXPECT_NEAR(list[0].box.center.x(), 0.1 + 0.28, 1e-15);
  EXPECT_NEAR(list[0].box.center.y(), -0.2 + 0.96, 1e-15);
  EXPECT_EQ(list.size(), 2U) << "the copy was spread";
}

TEST(BoxList, TellsListsApartByTheLastBit) {
  const std::vector<Vector3> points = {Vector3(1.0, 0.0, 0.0), Vector3(0.0, 2.0, 7.0)};
  const BoxList list = pointList(points);
  EXPECT_TRUE(list.isSame(pointList(points)));
  EXPECT_TRUE(BoxList().isSame(BoxList()));
  std::vector<Vector3> moved = points;
  moved[1].z() = std::nextafter(7.0, 8.0);
  EXPECT_FALSE(list.isSame(pointList(moved)));
  OrientedBox wider = kShape;
  wider.half_extents.y() = 5e-324;
  EXPECT_FALSE(list.isSame(pointList(points, wider)));
  EXPECT_FALSE(list.isSame(pointList(points, kShape, -4)));
  EXPECT_FALSE(list.isSame(pointList({points[0]})));
  BoxList each = list;
  each.each();
  EXPECT_FALSE(each.isSame(list)) << "another form";
  EXPECT_TRUE(each.isSame(each));
  BoxList turned = each;
  turned.each()[1].box.orientation.w() = -0.8;
  EXPECT_FALSE(each.isSame(turned));
}

/// A number, 0, or one of any magnitude around what decides.
double someNumber(std::mt19937& random) {
  const double sign = random() % 2 == 0 ? 1.0 : -1.0;
  constexpr double kMagnitudes[] = {0.0, 1.0, 1e6, 4e6, 1e7, 1e-99, 1e-150, 1e-199, 1e-201};
  const double factor = std::uniform_real_distribution<double>(0.5, 1.5)(random);
  return sign * factor * kMagnitudes[random() % 3 == 0 ? random() % 9 : random() % 3];
}

Vector3 somePlace(std::mt19937& random) {
  return {someNumber(random), someNumber(random), someNumber(random)};
}

TEST(BoxList, IsSurelyWithinOnlyWhatItsBoxesAreWithin) {
  std::mt19937 random(3);
  std::size_t sure = 0;
  std::size_t within = 0;
  for (int n = 0; n < 200000; ++n) {
    const double angle = random() % 3 == 0 ? 0.0 : someNumber(random);
    const OrientedBox shape{
        somePlace(random),
        Quaternion(Eigen::AngleAxisd(angle, Vector3::Unit(static_cast<int>(random() % 3)))),
        Vector3::Ones()};
    const double limit = random() % 2 == 0 ? 1e7 : 2.0;
    const std::vector<Vector3> points = {somePlace(random), somePlace(random)};
    const BoxList list = pointList(points, shape);
    const bool is_within =
        isWithin(limit, list[0].box.center) && isWithin(limit, list[1].box.center);
    const bool is_sure = areSurelyWithin(limit, shape, points);
    ASSERT_TRUE(is_within || !is_sure) << n;
    sure += is_sure ? 1 : 0;
    within += is_within ? 1 : 0;
  }
  EXPECT_GT(sure, 1000U);
  EXPECT_GT(within, sure);
  EXPECT_TRUE(areSurelyWithin(1.0, kUpright, {}));
}

TEST(BoxList, IsSureOfPlacesOnEarthInMetresFromItsEquator) {
  EXPECT_TRUE(areSurelyWithin(1e7, kUpright, {Vector3(500000.0, 9300000.0, 0.0)}));
}

TEST(BoxList, ReadsInterleavedListsAsEachSays) {
  const BoxList turned = pointList({Vector3(1.0, 2.0, 3.0), Vector3(4.0, 5.0, 6.0)});
  const BoxList upright = pointList({Vector3(7.0, 8.0, 9.0)}, kUpright, 5);
  BoxList full = turned;
  full.each();
  const BoxList::Reader of_turned(turned);
  const BoxList::Reader of_upright(upright);
  const BoxList::Reader of_full(full);
  expectSame(of_turned[1], full[1]);
  expectSame(of_full[1], full[1]);
  EXPECT_EQ(of_upright[0].box.center, Vector3(7.0, 8.0, 9.0));
  EXPECT_EQ(of_upright[0].id, 5);
  expectSame(of_turned[0], full[0]);
  EXPECT_NE(of_turned[0].box.center.x(), 1.1) << "it is turned";
}

}  // namespace
}  // namespace box_query
