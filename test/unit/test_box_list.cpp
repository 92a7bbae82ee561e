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

std::shared_ptr<const PointList> pointList(std::vector<Vector3> points,
                                           const OrientedBox& shape = kShape) {
  return std::make_shared<PointList>(-3, shape, std::move(points));
}

void expectSame(const IdentifiedBox& a, const IdentifiedBox& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.box.center, b.box.center);
  EXPECT_EQ(a.box.orientation.coeffs(), b.box.orientation.coeffs());
  EXPECT_EQ(a.box.half_extents, b.box.half_extents);
}

TEST(BoxList, SaysTheSameOfPointsOnceTheyAreSpread) {
  const BoxList list(pointList({Vector3(1.0, 0.0, 0.0), Vector3(0.0, 1.0 / 3.0, 7.0)}));
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
  const BoxList list(pointList(points));
  EXPECT_TRUE(list.isSame(BoxList(pointList(points))));
  EXPECT_TRUE(BoxList().isSame(BoxList()));
  std::vector<Vector3> moved = points;
  moved[1].z() = std::nextafter(7.0, 8.0);
  EXPECT_FALSE(list.isSame(BoxList(pointList(moved))));
  OrientedBox wider = kShape;
  wider.half_extents.y() = 5e-324;
  EXPECT_FALSE(list.isSame(BoxList(pointList(points, wider))));
  EXPECT_FALSE(list.isSame(BoxList(std::make_shared<PointList>(-4, kShape, std::vector(points)))));
  EXPECT_FALSE(list.isSame(BoxList(pointList({points[0]}))));
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
    const auto list = pointList({somePlace(random), somePlace(random)}, shape);
    const bool is_within =
        isWithin(limit, (*list)[0].box.center) && isWithin(limit, (*list)[1].box.center);
    const bool is_sure = list->isSurelyWithin(limit);
    ASSERT_TRUE(is_within || !is_sure) << n;
    sure += is_sure ? 1 : 0;
    within += is_within ? 1 : 0;
  }
  EXPECT_GT(sure, 1000U);
  EXPECT_GT(within, sure);
  EXPECT_TRUE(pointList({}, OrientedBox{Vector3::Zero(), Quaternion::Identity(), Vector3::Ones()})
                  ->isSurelyWithin(1.0));
}

TEST(BoxList, IsSureOfPlacesOnEarthInMetresFromItsEquator) {
  const OrientedBox upright{Vector3::Zero(), Quaternion::Identity(), Vector3::Ones()};
  EXPECT_TRUE(pointList({Vector3(500000.0, 9300000.0, 0.0)}, upright)->isSurelyWithin(1e7));
}

}  // namespace
}  // namespace box_query
