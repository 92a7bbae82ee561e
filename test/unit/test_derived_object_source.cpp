// SPDX-License-Identifier: BSD-3-Clause
#include "unit/foreign_messages.h"
#include "unit/source_fixture.h"

namespace box_query::test {
namespace {

constexpr const char* kType = "derived_object_msgs/ObjectArray";
constexpr std::uint8_t kBox = 1;
constexpr std::uint8_t kSphere = 2;
constexpr std::uint8_t kCar = 6;

DerivedObject objectAt(double x, std::uint32_t id) {
  DerivedObject object;
  object.header.frame_id = "/ego";
  object.header.stamp = ros::Time(1234, 5678);
  object.id = id;
  object.object_classified = 1;
  object.pose.position.x = x;
  object.pose.position.y = -0.2;
  object.pose.orientation.z = 0.6;
  object.pose.orientation.w = 0.8;
  object.twist.linear.x = 1e9;
  object.polygon.points.resize(2);
  object.shape.type = kBox;
  object.shape.dimensions = {1.0, 0.0, 3.0};
  object.classification = kCar;
  object.classification_certainty = 255;
  object.classification_age = 9;
  return object;
}

DerivedObjectArray arrayOf(const std::vector<DerivedObject>& objects) {
  DerivedObjectArray array;
  array.header.frame_id = "map";
  array.header.stamp = ros::Time(1235);
  array.objects = objects;
  return array;
}

DecodedMessage decode(const std::vector<DerivedObject>& objects, std::size_t max_boxes = kPlenty) {
  return decodeBytes(kType, wire(arrayOf(objects)), max_boxes);
}

TEST(DerivedObjectSource, DecodesEveryFieldOfAnObject) {
  const DecodedMessage message = decode({objectAt(0.1, 4294967295U)});
  ASSERT_EQ(message.problem, "");
  EXPECT_TRUE(message.whole);
  ASSERT_EQ(message.changes.size(), 1U);
  const BoxChange& change = message.changes[0];
  EXPECT_EQ(change.kind, BoxChange::Kind::kSet);
  EXPECT_EQ(change.ns, "CAR");
  EXPECT_EQ(change.label, "CAR");
  EXPECT_EQ(change.frame, "ego");
  EXPECT_EQ(change.stamp, ros::Time(1234, 5678));
  EXPECT_EQ(change.lifetime, 0);
  ASSERT_EQ(change.boxes.size(), 1U);
  EXPECT_EQ(change.boxes[0].id, 4294967295);
  EXPECT_EQ(change.boxes[0].box.center, Vector3(0.1, -0.2, 0.0));
  EXPECT_EQ(change.boxes[0].box.orientation.coeffs(), Eigen::Vector4d(0.0, 0.0, 0.6, 0.8));
  EXPECT_EQ(change.boxes[0].box.half_extents, Vector3(0.5, 0.0, 1.5));
}

TEST(DerivedObjectSource, TakesTheHeaderOfTheArrayForObjectsWithoutAFrame) {
  DerivedObject object = objectAt(1, 2);
  object.header.frame_id = "";
  const DecodedMessage message = decode({object});
  ASSERT_EQ(message.changes.size(), 1U);
  EXPECT_EQ(message.changes[0].frame, "map");
  EXPECT_EQ(message.changes[0].stamp, ros::Time(1235));
}

TEST(DerivedObjectSource, NamesClasses) {
  const auto classOf = [](std::uint8_t classification, std::uint8_t classified) {
    DerivedObject object = objectAt(1, 2);
    object.classification = classification;
    object.object_classified = classified;
    return decode({object}).changes.at(0).ns;
  };
  EXPECT_EQ(classOf(0, 1), "UNKNOWN");
  EXPECT_EQ(classOf(4, 1), "PEDESTRIAN");
  EXPECT_EQ(classOf(11, 1), "SIGN");
  EXPECT_EQ(classOf(12, 1), "12") << "a number that later definitions may name";
  EXPECT_EQ(classOf(kCar, 0), "UNKNOWN") << "what is not classified has no valid class";
}

TEST(DerivedObjectSource, KeepsObjectsThatShareAnId) {
  EXPECT_EQ(contents(decode({objectAt(1, 0), objectAt(2, 0), objectAt(3, 5)})),
            "CAR/0:1 CAR/0:2 CAR/5:3 ");
}

TEST(DerivedObjectSource, CountsOtherShapes) {
  DerivedObject sphere = objectAt(1, 1);
  sphere.shape.type = kSphere;
  sphere.shape.dimensions = {2.0};
  const DecodedMessage message = decode({sphere, objectAt(2, 2)});
  EXPECT_EQ(message.ignored, 1U);
  EXPECT_EQ(contents(message), "CAR/2:2 ");
}

TEST(DerivedObjectSource, RejectsBadBoxesAndKeepsTheRest) {
  std::vector<DerivedObject> objects(8, objectAt(5, 3));
  objects[1].shape.dimensions = {1.0, 2.0};
  objects[2].shape.dimensions = {1.0, 2.0, 3.0, 4.0};
  objects[3].shape.dimensions.clear();
  objects[4].shape.dimensions[2] = kNan;
  objects[5].shape.dimensions[1] = -1.0;
  objects[6].pose.orientation.w = 0.9;
  const DecodedMessage message = decode(objects);
  EXPECT_EQ(contents(message), "CAR/3:5 CAR/3:5 ");
  ASSERT_EQ(message.changes.size(), 1U);
  EXPECT_EQ(countOf(message.changes[0], Rejection::kShape), 3U);
  EXPECT_EQ(countOf(message.changes[0], Rejection::kNotFinite), 1U);
  EXPECT_EQ(countOf(message.changes[0], Rejection::kNegativeSize), 1U);
  EXPECT_EQ(countOf(message.changes[0], Rejection::kOrientation), 1U);
  EXPECT_NE(message.changes[0].problem().find("it has 2"), std::string::npos)
      << message.changes[0].problem();
}

TEST(DerivedObjectSource, RefusesMessagesWithTooManyBoxes) {
  const DecodedMessage message = decode({objectAt(1, 1), objectAt(2, 2)}, 1);
  EXPECT_TRUE(message.changes.empty());
  EXPECT_NE(message.problem.find("max_boxes_per_message"), std::string::npos) << message.problem;
}

TEST(DerivedObjectSource, KnowsTheSmallestObject) {
  // The bound on array lengths: too large would refuse real messages.
  EXPECT_EQ(wire(DerivedObject()).size(), 189U);
  EXPECT_EQ(wire(SolidPrimitive()).size(), 5U);
  EXPECT_EQ(decode(std::vector<DerivedObject>(5)).problem, "");
}

TEST(DerivedObjectSource, SurvivesDamage) {
  const Bytes whole = wire(arrayOf({objectAt(1, 1), objectAt(2, 2)}));
  expectRefusedIfCutOffOrTooLong(kType, whole);
  expectClaimsRefused(kType, whole, 3 + 3 + 1 + 2 * 2);  // frames, stamps, objects, points, sides
  expectSurvivesAnyBytes(kType, whole);
}

}  // namespace
}  // namespace box_query::test
