// SPDX-License-Identifier: BSD-3-Clause
#include "unit/foreign_messages.h"
#include "unit/source_fixture.h"

namespace box_query::test {
namespace {

constexpr const char* kType = "autoware_msgs/DetectedObjectArray";

/// With something in every array and string.
AutowareObject objectAt(double x, std::uint32_t id, const std::string& label = "car") {
  AutowareObject object;
  object.header.frame_id = "own";
  object.header.stamp = ros::Time(7);
  object.id = id;
  object.label = label;
  object.valid = 1;
  object.space_frame = "space";
  object.pose.position.x = x;
  object.pose.position.y = -0.2;
  object.pose.orientation.z = 0.6;
  object.pose.orientation.w = 0.8;
  object.dimensions.x = 1.0;
  object.dimensions.z = 3.0;
  object.variance.x = kNan;
  object.velocity.linear.x = kInf;
  object.pointcloud.fields.resize(2);
  object.pointcloud.fields[1].name = "y";
  object.pointcloud.data.resize(3);
  object.convex_hull.header.frame_id = "hull";
  object.convex_hull.polygon.points.resize(2);
  object.lanes.resize(2);
  object.lanes[0].header.frame_id = "lane";
  object.lanes[0].waypoints.resize(2);
  object.lanes[0].waypoints[1].twist.header.frame_id = "twist";
  object.pose_reliable = 1;
  object.image_frame = "image";
  object.roi_image.encoding = "bgr8";
  object.roi_image.data.resize(4);
  object.user_defined_info = {"a", "bc"};
  return object;
}

AutowareObjectArray arrayOf(const std::vector<AutowareObject>& objects) {
  AutowareObjectArray array;
  array.header.frame_id = "/velodyne";
  array.header.stamp = ros::Time(1234, 5678);
  array.objects = objects;
  return array;
}

DecodedMessage decode(const std::vector<AutowareObject>& objects, std::size_t max_boxes = kPlenty) {
  return decodeBytes(kType, wire(arrayOf(objects)), max_boxes);
}

TEST(AutowareSource, DecodesEveryFieldOfAnObject) {
  const DecodedMessage message = decode({objectAt(0.1, 4294967295U)});
  ASSERT_EQ(message.problem, "");
  EXPECT_TRUE(message.whole);
  ASSERT_EQ(message.changes.size(), 1U);
  const BoxChange& change = message.changes[0];
  EXPECT_EQ(change.kind, BoxChange::Kind::kSet);
  EXPECT_EQ(change.ns, "car");
  EXPECT_EQ(change.label, "car");
  EXPECT_EQ(change.frame, "velodyne");
  EXPECT_EQ(change.stamp, ros::Time(1234, 5678));
  EXPECT_EQ(change.lifetime, 0);
  ASSERT_EQ(change.boxes.size(), 1U);
  EXPECT_EQ(change.boxes[0].id, 4294967295);
  EXPECT_EQ(change.boxes[0].box.center, Vector3(0.1, -0.2, 0.0));
  EXPECT_EQ(change.boxes[0].box.orientation.coeffs(), Eigen::Vector4d(0.0, 0.0, 0.6, 0.8));
  EXPECT_EQ(change.boxes[0].box.half_extents, Vector3(0.5, 0.0, 1.5));
}

TEST(AutowareSource, TakesAnObjectsOwnHeaderWhereTheArraysNamesNoFrame) {
  AutowareObjectArray array = arrayOf({objectAt(1, 2)});
  array.header.frame_id = "";
  const DecodedMessage message = decodeBytes(kType, wire(array));
  ASSERT_EQ(message.changes.size(), 1U);
  EXPECT_EQ(message.changes[0].frame, "own");
  EXPECT_EQ(message.changes[0].stamp, ros::Time(7));
}

TEST(AutowareSource, KeepsObjectsThatShareAnId) {
  EXPECT_EQ(contents(decode({objectAt(1, 0), objectAt(2, 0, "bike"), objectAt(3, 0)})),
            "car/0:1 car/0:3 bike/0:2 ");
}

TEST(AutowareSource, CountsObjectsThatAreNotValid) {
  AutowareObject filtered = objectAt(1, 1);
  filtered.valid = 0;
  const DecodedMessage message = decode({filtered, objectAt(2, 2)});
  EXPECT_EQ(message.ignored, 1U);
  EXPECT_EQ(contents(message), "car/2:2 ");
}

TEST(AutowareSource, TakesAnOrientationThatIsNotGivenAsTheIdentityUnlessItIsReliable) {
  AutowareObject object = objectAt(1, 1);
  object.pose.orientation = geometry_msgs::Quaternion();
  EXPECT_EQ(countOf(decode({object}).changes.at(0), Rejection::kOrientation), 1U);
  object.pose_reliable = 0;
  const DecodedMessage message = decode({object});
  ASSERT_EQ(message.changes.at(0).boxes.size(), 1U);
  EXPECT_EQ(message.changes[0].boxes[0].box.orientation.coeffs(), Quaternion::Identity().coeffs());
  object.pose.orientation.z = 1.0;
  EXPECT_EQ(decode({object}).changes.at(0).boxes[0].box.orientation.z(), 1.0);
}

TEST(AutowareSource, RejectsBadBoxesAndKeepsTheRest) {
  std::vector<AutowareObject> objects(5, objectAt(5, 3));
  objects[1].pose.position.x = kNan;
  objects[2].dimensions.z = -1.0;
  objects[3].pose.orientation.w = 0.9;
  const DecodedMessage message = decode(objects);
  EXPECT_EQ(contents(message), "car/3:5 car/3:5 ");
  ASSERT_EQ(message.changes.size(), 1U);
  EXPECT_EQ(countOf(message.changes[0], Rejection::kNotFinite), 1U);
  EXPECT_EQ(countOf(message.changes[0], Rejection::kNegativeSize), 1U);
  EXPECT_EQ(countOf(message.changes[0], Rejection::kOrientation), 1U);
}

TEST(AutowareSource, RefusesMessagesWithTooManyBoxes) {
  const DecodedMessage message = decode({objectAt(1, 1), objectAt(2, 2)}, 1);
  EXPECT_TRUE(message.changes.empty());
  EXPECT_NE(message.problem.find("max_boxes_per_message"), std::string::npos) << message.problem;
}

TEST(AutowareSource, KnowsTheSmallestOfEverything) {
  // The bounds on array lengths: too large would refuse real messages.
  EXPECT_EQ(wire(AutowareObject()).size(), 389U);
  EXPECT_EQ(wire(AutowareLane()).size(), 45U);
  EXPECT_EQ(wire(AutowareWaypoint()).size(), 249U);
  EXPECT_EQ(decode(std::vector<AutowareObject>(5)).problem, "");
}

TEST(AutowareSource, SurvivesDamage) {
  const Bytes whole = wire(arrayOf({objectAt(1, 1), objectAt(2, 2)}));
  expectRefusedIfCutOffOrTooLong(kType, whole);
  expectClaimsRefused(kType, whole, 2 + 2 * (8 + 14));
  expectSurvivesAnyBytes(kType, whole);
}

}  // namespace
}  // namespace box_query::test
