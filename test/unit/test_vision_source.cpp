// SPDX-License-Identifier: BSD-3-Clause
#include "unit/foreign_messages.h"
#include "unit/source_fixture.h"

namespace box_query::test {
namespace {

constexpr const char* kBoxes = "vision_msgs/BoundingBox3DArray";
constexpr const char* kDetections = "vision_msgs/Detection3DArray";

VisionBoundingBox3D boxAt(double x) {
  VisionBoundingBox3D box;
  box.center.position.x = x;
  box.center.position.y = -0.2;
  box.center.orientation.z = 0.6;
  box.center.orientation.w = 0.8;
  box.size.x = 1.0;
  box.size.z = 3.0;
  return box;
}

VisionHypothesis hypothesis(std::int64_t id, double score) {
  VisionHypothesis result;
  result.id = id;
  result.score = score;
  result.pose.pose.position.x = 1e9;
  return result;
}

VisionDetection3D detection(double x, const std::vector<VisionHypothesis>& results) {
  VisionDetection3D one;
  one.bbox = boxAt(x);
  one.results = results;
  one.source_cloud.header.frame_id = "nowhere";
  one.source_cloud.fields.resize(2);
  one.source_cloud.fields[0].name = "x";
  one.source_cloud.data.resize(5);
  return one;
}

VisionBoundingBox3DArray boxes(const std::vector<VisionBoundingBox3D>& list) {
  VisionBoundingBox3DArray array;
  array.header.frame_id = "lidar";
  array.header.stamp = ros::Time(1234, 5678);
  array.boxes = list;
  return array;
}

VisionDetection3DArray detections(const std::vector<VisionDetection3D>& list) {
  VisionDetection3DArray array;
  array.header.frame_id = "lidar";
  array.header.stamp = ros::Time(1234, 5678);
  array.detections = list;
  return array;
}

void expectBoxAt(double x, const OrientedBox& box) {
  EXPECT_EQ(box.center, Vector3(x, -0.2, 0.0));
  EXPECT_EQ(box.orientation.coeffs(), Eigen::Vector4d(0.0, 0.0, 0.6, 0.8));
  EXPECT_EQ(box.half_extents, Vector3(0.5, 0.0, 1.5));
}

TEST(VisionSource, DecodesEveryFieldOfABox) {
  const DecodedMessage message = decodeBytes(kBoxes, wire(boxes({boxAt(0.1), boxAt(0.2)})));
  ASSERT_EQ(message.problem, "");
  EXPECT_TRUE(message.whole);
  ASSERT_EQ(message.changes.size(), 1U);
  const BoxChange& change = message.changes[0];
  EXPECT_EQ(change.kind, BoxChange::Kind::kSet);
  EXPECT_EQ(change.ns, "");
  EXPECT_EQ(change.label, "");
  EXPECT_EQ(change.frame, "lidar");
  EXPECT_EQ(change.stamp, ros::Time(1234, 5678));
  EXPECT_EQ(change.lifetime, 0);
  ASSERT_EQ(change.boxes.size(), 2U);
  EXPECT_EQ(change.boxes[1].id, 1);
  expectBoxAt(0.1, change.boxes[0].box);
  expectBoxAt(0.2, change.boxes[1].box);
}

TEST(VisionSource, DecodesEveryFieldOfADetection) {
  VisionDetection3D own = detection(0.1, {hypothesis(-5, 0.5)});
  own.header.frame_id = "/camera";
  own.header.stamp = ros::Time(7);
  const DecodedMessage message =
      decodeBytes(kDetections, wire(detections({own, detection(0.2, {hypothesis(6, 0.5)})})));
  ASSERT_EQ(message.problem, "");
  EXPECT_TRUE(message.whole);
  ASSERT_EQ(message.changes.size(), 2U);
  EXPECT_EQ(message.changes[0].ns, "-5");
  EXPECT_EQ(message.changes[0].label, "-5");
  EXPECT_EQ(message.changes[0].frame, "camera");
  EXPECT_EQ(message.changes[0].stamp, ros::Time(7));
  EXPECT_EQ(message.changes[1].ns, "6");
  EXPECT_EQ(message.changes[1].frame, "lidar") << "where it has none, that of the array";
  EXPECT_EQ(message.changes[1].stamp, ros::Time(1234, 5678));
  ASSERT_EQ(message.changes[1].boxes.size(), 1U);
  EXPECT_EQ(message.changes[1].boxes[0].id, 1);
  expectBoxAt(0.1, message.changes[0].boxes[0].box);
  expectBoxAt(0.2, message.changes[1].boxes[0].box);
}

TEST(VisionSource, TakesTheClassOfTheHighestScore) {
  const auto classOf = [](const std::vector<VisionHypothesis>& results) {
    return decodeBytes(kDetections, wire(detections({detection(0.1, results)}))).changes.at(0).ns;
  };
  EXPECT_EQ(classOf({hypothesis(1, 0.2), hypothesis(2, 0.7), hypothesis(3, 0.1)}), "2");
  EXPECT_EQ(classOf({hypothesis(1, 0.2), hypothesis(2, 0.2)}), "1");
  EXPECT_EQ(classOf({hypothesis(1, kNan), hypothesis(2, -1.0)}), "2");
  EXPECT_EQ(classOf({hypothesis(1, kNan), hypothesis(2, kNan)}), "1");
  EXPECT_EQ(classOf({hypothesis(INT64_MIN, 0.0)}), "-9223372036854775808");
  EXPECT_EQ(classOf({}), "");
}

TEST(VisionSource, TakesArraysWithoutBoxesAsTheEmptySet) {
  for (const DecodedMessage& message :
       {decodeBytes(kBoxes, wire(boxes({}))), decodeBytes(kDetections, wire(detections({})))}) {
    EXPECT_EQ(message.problem, "");
    EXPECT_TRUE(message.whole);
    EXPECT_TRUE(message.changes.empty());
    EXPECT_EQ(message.stamp, ros::Time(1234, 5678));
  }
}

TEST(VisionSource, FindsASingleBadNumberAmongManyBoxes) {
  std::size_t found = 0;
  const auto expectRejected = [&found](const VisionBoundingBox3D& bad, Rejection why) {
    std::vector<VisionBoundingBox3D> list(5, boxAt(5));
    list[3] = bad;
    const BoxChange change = decodeBytes(kBoxes, wire(boxes(list))).changes.at(0);
    EXPECT_EQ(change.boxes.size(), 4U);
    EXPECT_EQ(countOf(change, why), 1U) << change.problem();
    EXPECT_EQ(change.rejected(), 1U);
    EXPECT_EQ(change.problem().rfind("box 3 ", 0), 0U) << change.problem();
    EXPECT_EQ(change.boxes.id(2), 2);
    EXPECT_EQ(change.boxes.id(3), 4) << "identities do not move up";
    ++found;
  };
  for (std::size_t field = 0; field < 10; ++field) {
    for (const double bad : {kNan, kInf, -kInf}) {
      VisionBoundingBox3D box = boxAt(5);
      std::memcpy(reinterpret_cast<char*>(&box) + field * sizeof(double), &bad, sizeof bad);
      expectRejected(box, Rejection::kNotFinite);
    }
  }
  for (std::size_t field = 7; field < 10; ++field) {
    VisionBoundingBox3D box = boxAt(5);
    const double bad = -1e-300;
    std::memcpy(reinterpret_cast<char*>(&box) + field * sizeof(double), &bad, sizeof bad);
    expectRejected(box, Rejection::kNegativeSize);
  }
  for (const std::size_t field : {0, 1, 2, 7, 8, 9}) {
    for (const double bad : {2e7, 1e300, 1e-201, 5e-324}) {
      VisionBoundingBox3D box = boxAt(5);
      std::memcpy(reinterpret_cast<char*>(&box) + field * sizeof(double), &bad, sizeof bad);
      expectRejected(box, Rejection::kOutOfBounds);
    }
  }
  for (const double norm : {0.0, 0.98, 1.02}) {
    VisionBoundingBox3D box = boxAt(5);
    box.center.orientation.z = 0.6 * norm;
    box.center.orientation.w = 0.8 * norm;
    expectRejected(box, Rejection::kOrientation);
  }
  EXPECT_EQ(found, 60U);
}

TEST(VisionSource, RejectsBadBoxesAndKeepsTheRest) {
  std::vector<VisionBoundingBox3D> list(6, boxAt(5));
  list[1].center.position.z = -kInf;
  list[2].size.y = kNan;
  list[3].size.x = -1e-300;
  list[4].center.orientation = geometry_msgs::Quaternion();
  const DecodedMessage of_boxes = decodeBytes(kBoxes, wire(boxes(list)));
  std::vector<VisionDetection3D> seen(6, detection(0, {}));
  for (std::size_t n = 0; n < 6; ++n) {
    seen[n].bbox = list[n];
  }
  const DecodedMessage of_detections = decodeBytes(kDetections, wire(detections(seen)));
  for (const DecodedMessage& message : {of_boxes, of_detections}) {
    EXPECT_EQ(contents(message), "/0:5 /5:5 ");
    ASSERT_EQ(message.changes.size(), 1U);
    EXPECT_EQ(countOf(message.changes[0], Rejection::kNotFinite), 2U);
    EXPECT_EQ(countOf(message.changes[0], Rejection::kNegativeSize), 1U);
    EXPECT_EQ(countOf(message.changes[0], Rejection::kOrientation), 1U);
  }
  VisionBoundingBox3DArray nowhere = boxes(list);
  nowhere.header.frame_id = "";
  EXPECT_EQ(countOf(decodeBytes(kBoxes, wire(nowhere)).changes.at(0), Rejection::kFrame), 6U);
}

TEST(VisionSource, RefusesMessagesWithTooManyBoxes) {
  for (const DecodedMessage& message :
       {decodeBytes(kBoxes, wire(boxes({boxAt(1), boxAt(2)})), 1),
        decodeBytes(kDetections, wire(detections({detection(1, {}), detection(2, {})})), 1)}) {
    EXPECT_TRUE(message.changes.empty());
    EXPECT_NE(message.problem.find("max_boxes_per_message"), std::string::npos) << message.problem;
  }
}

TEST(VisionSource, KnowsTheSmallestOfEverything) {
  // The bounds on array lengths: too large would refuse real messages.
  EXPECT_EQ(wire(VisionBoundingBox3D()).size(), 80U);
  EXPECT_EQ(wire(VisionDetection3D()).size(), 142U);
  EXPECT_EQ(wire(VisionHypothesis()).size(), 360U);
  EXPECT_EQ(wire(PointField()).size(), 13U);
  EXPECT_EQ(decodeBytes(kDetections, wire(VisionDetection3DArray{{}, {5, VisionDetection3D()}}))
                .changes.size(),
            1U);
}

TEST(VisionSource, SurvivesDamage) {
  const Bytes some_boxes = wire(boxes({boxAt(1), boxAt(2)}));
  expectRefusedIfCutOffOrTooLong(kBoxes, some_boxes);
  expectClaimsRefused(kBoxes, some_boxes, 1 + 1 + 1);  // frame, boxes, stamp
  expectSurvivesAnyBytes(kBoxes, some_boxes);
  const Bytes some_detections =
      wire(detections({detection(1, {hypothesis(1, 0.5)}), detection(2, {})}));
  expectRefusedIfCutOffOrTooLong(kDetections, some_detections);
  // Frames and stamps of the array, of two detections and of their clouds; results, fields and
  // their names, data.
  expectClaimsRefused(kDetections, some_detections, 2 * 5 + 1 + 2 * (1 + 1 + 2 + 1));
  expectSurvivesAnyBytes(kDetections, some_detections);
}

}  // namespace
}  // namespace box_query::test
