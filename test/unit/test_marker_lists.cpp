// SPDX-License-Identifier: BSD-3-Clause
// Markers of type CUBE_LIST, serialised by roscpp, decoded by us.
#include "unit/marker_messages.h"

#include <cmath>

#include <gtest/gtest.h>

namespace box_query::test {
namespace {

using visualization_msgs::Marker;

TEST(MarkerLists, GiveEveryBoxItsOwnIdAndPlace) {
  Marker list = cubeList();
  list.pose.orientation.w = list.pose.orientation.z = std::sqrt(0.5);  // a quarter turn about z
  const DecodedMessage message = decode(list);
  ASSERT_EQ(message.changes.size(), 1U);
  const BoxList& boxes = message.changes[0].boxes;
  ASSERT_EQ(boxes.size(), 3U);
  EXPECT_EQ(message.changes[0].id, -3);
  EXPECT_EQ(boxes[0].id, -3);
  EXPECT_EQ(boxes[1].id, (1LL << 32) - 3);
  EXPECT_EQ(boxes[2].id, (2LL << 32) - 3);
  EXPECT_TRUE(boxes[0].box.center.isApprox(Vector3(0.1, -0.2, 0.3), 1e-15));
  EXPECT_TRUE(boxes[1].box.center.isApprox(Vector3(0.1, 0.8, 0.3), 1e-15));
  EXPECT_TRUE(boxes[2].box.center.isApprox(Vector3(-1.9, -0.2, 0.3), 1e-15));
  for (const IdentifiedBox& each : boxes) {
    EXPECT_EQ(each.box.orientation.w(), std::sqrt(0.5));
    EXPECT_EQ(each.box.half_extents, Vector3(0.5, 0.0, 1.5));
  }
}

TEST(MarkerLists, KeepPointsBitForBitWhereTheyAreNotMoved) {
  Marker list = cubeList();
  list.pose = geometry_msgs::Pose();  // position and quaternion zero
  list.points[1].x = 1e6 / 3.0;
  const DecodedMessage message = decode(list);
  EXPECT_EQ(message.changes.at(0).boxes[1].box.center, Vector3(1e6 / 3.0, 0.0, 0.0));
}

TEST(MarkerLists, WithoutPointsAreNoBoxes) {
  Marker list = cubeList();
  list.points.clear();
  const DecodedMessage message = decode(list);
  ASSERT_EQ(message.changes.size(), 1U);
  EXPECT_EQ(message.changes[0].kind, BoxChange::Kind::kSet);
  EXPECT_TRUE(message.changes[0].boxes.empty());
  EXPECT_EQ(message.changes[0].rejected(), 0U);
}

TEST(MarkerLists, LoseOnlyTheirBadPoints) {
  Marker list = cubeList();
  list.points.resize(7);  // 21 numbers
  using Field = double& (*)(geometry_msgs::Point&);
  for (const Field field : {Field([](geometry_msgs::Point& p) -> double& { return p.x; }),
                            Field([](geometry_msgs::Point& p) -> double& { return p.y; }),
                            Field([](geometry_msgs::Point& p) -> double& { return p.z; })}) {
    for (std::size_t n = 0; n < list.points.size(); ++n) {
      for (const double bad : {kNan, kInf, -kInf, 3e7, -1e300}) {
        Marker damaged = list;
        field(damaged.points[n]) = bad;
        const BoxChange change = decode(damaged).changes.at(0);
        ASSERT_EQ(change.boxes.size(), 6U) << n;
        EXPECT_EQ(change.boxes[5].id, ((n < 6 ? 6LL : 5LL) << 32) - 3)
            << "identities do not move up";
        const Rejection why =
            std::abs(bad) < kInf ? Rejection::kOutOfBounds : Rejection::kNotFinite;
        EXPECT_EQ(countOf(change, why), 1U) << bad << " at " << n;
      }
    }
  }
}

TEST(MarkerLists, AreBoundedInTheirPlacesAndNotTheirPoints) {
  const double largest = Limits().coordinate;
  Marker list = cubeList();
  list.pose = geometry_msgs::Pose();
  const BoxChange close = decode(list).changes.at(0);
  list.points[2].x = largest;
  const BoxChange far_away = decode(list).changes.at(0);
  ASSERT_EQ(far_away.boxes.size(), 3U);
  EXPECT_EQ(far_away.boxes[2].box.center.x(), largest);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(far_away.boxes[n].id, close.boxes[n].id);
    EXPECT_EQ(far_away.boxes[n].box.center, close.boxes[n].box.center);
    EXPECT_EQ(far_away.boxes[n].box.half_extents, close.boxes[n].box.half_extents);
  }
  for (const double center : {0.0, 0.9 * largest, largest}) {
    for (const double point : {0.101 * largest, 2.0 * largest, 1e-210}) {
      list.pose.position.x = center;
      list.points = {geometry_msgs::Point(), geometry_msgs::Point()};
      list.points[1].x = point;
      const double place = center + point;
      const bool is_good = place <= largest && place >= kSmallestCoordinate;
      const BoxChange change = decode(list).changes.at(0);
      EXPECT_EQ(change.boxes.size(), is_good ? 2U : 1U) << center << " " << point;
      EXPECT_EQ(countOf(change, Rejection::kOutOfBounds), is_good ? 0U : 1U);
    }
  }
}

}  // namespace
}  // namespace box_query::test
