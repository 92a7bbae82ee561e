// SPDX-License-Identifier: BSD-3-Clause
#include "unit/foreign_messages.h"
#include "unit/source_fixture.h"

#include <set>
#include <utility>

namespace box_query::test {
namespace {

constexpr const char* kType = "jsk_recognition_msgs/BoundingBoxArray";

JskBoundingBox boxOf(std::uint32_t label, double x) {
  JskBoundingBox box;
  box.header.frame_id = "/camera";
  box.header.stamp = ros::Time(1234, 5678);
  box.pose.position.x = x;
  box.pose.position.y = -0.2;
  box.pose.orientation.z = 0.6;
  box.pose.orientation.w = 0.8;
  box.dimensions.x = 1.0;
  box.dimensions.z = 3.0;
  box.value = 0.5F;
  box.label = label;
  return box;
}

JskBoundingBoxArray arrayOf(const std::vector<JskBoundingBox>& boxes) {
  JskBoundingBoxArray array;
  array.header.frame_id = "elsewhere";
  array.header.stamp = ros::Time(1235);
  array.boxes = boxes;
  return array;
}

DecodedMessage decode(const std::vector<JskBoundingBox>& boxes, std::size_t max_boxes = kPlenty) {
  return decodeBytes(kType, wire(arrayOf(boxes)), max_boxes);
}

TEST(JskSource, DecodesEveryFieldOfABox) {
  const DecodedMessage message = decode({boxOf(4294967295U, 0.1)});
  ASSERT_EQ(message.problem, "");
  EXPECT_TRUE(message.whole);
  ASSERT_EQ(message.changes.size(), 1U);
  const BoxChange& change = message.changes[0];
  EXPECT_EQ(change.kind, BoxChange::Kind::kSet);
  EXPECT_EQ(change.ns, "4294967295");
  EXPECT_EQ(change.label, "4294967295");
  EXPECT_EQ(change.frame, "camera") << "the array's own frame means nothing";
  EXPECT_EQ(change.stamp, ros::Time(1234, 5678));
  EXPECT_EQ(change.lifetime, 0);
  EXPECT_FALSE(change.frame_locked);
  ASSERT_EQ(change.boxes.size(), 1U);
  EXPECT_EQ(change.boxes[0].id, 0);
  EXPECT_EQ(change.boxes[0].box.center, Vector3(0.1, -0.2, 0.0));
  EXPECT_EQ(change.boxes[0].box.orientation.coeffs(), Eigen::Vector4d(0.0, 0.0, 0.6, 0.8));
  EXPECT_EQ(change.boxes[0].box.half_extents, Vector3(0.5, 0.0, 1.5));
}

TEST(JskSource, GathersBoxesByClassAndNumbersThemInTheirOrder) {
  const DecodedMessage message = decode({boxOf(7, 1), boxOf(0, 2), boxOf(7, 3), boxOf(0, 4)});
  EXPECT_EQ(contents(message), "7/0:1 7/2:3 0/1:2 0/3:4 ");
  EXPECT_EQ(message.changes.size(), 2U);
}

TEST(JskSource, KeepsTheHeaderOfEveryBox) {
  std::vector<JskBoundingBox> boxes = {boxOf(1, 1), boxOf(1, 2), boxOf(1, 3)};
  boxes[1].header.frame_id = "lidar";
  boxes[2].header.stamp = ros::Time(1234, 5679);
  const DecodedMessage message = decode(boxes);
  ASSERT_EQ(message.changes.size(), 3U);
  EXPECT_EQ(message.changes[1].frame, "lidar");
  EXPECT_EQ(message.changes[2].stamp, ros::Time(1234, 5679));
  for (std::int64_t n = 0; n < 3; ++n) {
    EXPECT_EQ(message.changes[static_cast<std::size_t>(n)].id, n) << "each has its own identity";
  }
}

TEST(JskSource, KeepsEveryBoxOfManyAlternatingClasses) {
  std::vector<JskBoundingBox> boxes;
  for (std::uint32_t n = 0; n < 300; ++n) {
    boxes.push_back(boxOf(n % 30, n));
  }
  const DecodedMessage message = decode(boxes);
  std::set<std::pair<std::string, std::int64_t>> keys;
  std::size_t count = 0;
  for (const BoxChange& change : message.changes) {
    EXPECT_TRUE(keys.emplace(change.ns, change.id).second) << "two would replace one another";
    count += change.boxes.size();
    for (const IdentifiedBox& each : change.boxes) {
      EXPECT_EQ(change.ns, std::to_string(each.id % 30));
      EXPECT_EQ(each.box.center.x(), static_cast<double>(each.id));
    }
  }
  EXPECT_EQ(count, 300U);
}

TEST(JskSource, TakesAnArrayWithoutBoxesAsTheEmptySet) {
  const DecodedMessage message = decode({});
  EXPECT_EQ(message.problem, "");
  EXPECT_TRUE(message.whole);
  EXPECT_TRUE(message.changes.empty());
  EXPECT_EQ(message.stamp, ros::Time(1235));
}

TEST(JskSource, RejectsBadBoxesAndKeepsTheRest) {
  std::vector<JskBoundingBox> boxes(8, boxOf(1, 5));
  boxes[1].pose.position.y = kNan;
  boxes[2].pose.orientation.w = kInf;
  boxes[3].dimensions.x = -kInf;
  boxes[4].dimensions.y = -1e-9;
  boxes[5].pose.orientation = geometry_msgs::Quaternion();
  boxes[6].header.frame_id = "";
  const DecodedMessage message = decode(boxes);
  EXPECT_EQ(contents(message), "1/0:5 1/7:5 ");
  ASSERT_EQ(message.changes.size(), 2U);
  EXPECT_EQ(countOf(message.changes[0], Rejection::kNotFinite), 3U);
  EXPECT_EQ(countOf(message.changes[0], Rejection::kNegativeSize), 1U);
  EXPECT_EQ(countOf(message.changes[0], Rejection::kOrientation), 1U);
  EXPECT_NE(message.changes[0].problem().find("box 1 of namespace '1'"), std::string::npos)
      << message.changes[0].problem();
  EXPECT_EQ(countOf(message.changes[1], Rejection::kFrame), 1U);
  EXPECT_NE(message.changes[1].problem().find("box 6 "), std::string::npos)
      << message.changes[1].problem();
}

TEST(JskSource, RefusesMessagesWithTooManyBoxes) {
  EXPECT_EQ(decode({boxOf(1, 1), boxOf(2, 2)}, 2).changes.size(), 2U);
  const DecodedMessage message = decode({boxOf(1, 1), boxOf(2, 2)}, 1);
  EXPECT_TRUE(message.changes.empty());
  EXPECT_NE(message.problem.find("max_boxes_per_message"), std::string::npos) << message.problem;
}

TEST(JskSource, KnowsTheSmallestBox) {
  // The bound on array lengths: too large would refuse real messages.
  EXPECT_EQ(wire(JskBoundingBox()).size(), 104U);
  EXPECT_EQ(decode(std::vector<JskBoundingBox>(5)).problem, "");
}

TEST(JskSource, SurvivesDamage) {
  const Bytes whole = wire(arrayOf({boxOf(1, 1), boxOf(2, 2), boxOf(1, 3)}));
  expectRefusedIfCutOffOrTooLong(kType, whole);
  expectClaimsRefused(kType, whole, 4 + 1 + 4);  // frames, boxes, stamps
  expectSurvivesAnyBytes(kType, whole);
}

}  // namespace
}  // namespace box_query::test
