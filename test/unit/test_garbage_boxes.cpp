// SPDX-License-Identifier: BSD-3-Clause
// Every field of every message of boxes, with every kind of garbage: no box is lost without being
// counted and explained, and none that is kept is bad.
#include "ros/box_tracker.h"
#include "unit/foreign_messages.h"
#include "unit/recorded_fields.h"
#include "unit/source_fixture.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <tf2/buffer_core.h>
#include <visualization_msgs/MarkerArray.h>

namespace box_query::test {
namespace {

using Kind = RecordedField::Kind;

/// A message of that type, and where its fields are.
struct Example {
  std::string type;
  Bytes bytes;
  std::vector<RecordedField> fields;
  std::size_t boxes;
  std::size_t numbers;  ///< of its boxes: those that NaN makes bad
};

template <class Message>
Example exampleOf(const std::string& type, const Message& message, std::size_t boxes,
                  std::size_t numbers) {
  return {type, wire(message), fieldsOf(message), boxes, numbers};
}

geometry_msgs::Pose unitPose() {
  geometry_msgs::Pose pose;
  pose.position.x = 1.0;
  pose.orientation.w = 1.0;
  return pose;
}
geometry_msgs::Vector3 unitSize() {
  geometry_msgs::Vector3 size;
  size.x = size.y = size.z = 1.0;
  return size;
}
std_msgs::Header inMap() {
  std_msgs::Header header;
  header.frame_id = "map";
  return header;
}
SolidPrimitive unitBox() {
  SolidPrimitive solid;
  solid.type = 1;
  solid.dimensions.assign(3, 1.0);
  return solid;
}

visualization_msgs::Marker markerOf(std::int32_t type, std::size_t points) {
  visualization_msgs::Marker marker;
  marker.header = inMap();
  marker.ns = "rack";
  marker.type = type;
  marker.pose = unitPose();
  marker.scale = unitSize();
  marker.points.resize(points);
  marker.colors.resize(points);
  marker.text = "label";
  marker.mesh_resource = "none";
  return marker;
}

CollisionObject objectOf(const std::string& id) {
  CollisionObject object;
  object.header = inMap();
  object.id = id;
  object.type_key = "furniture";
  object.pose = unitPose();
  object.primitives.assign(2, unitBox());
  object.primitive_poses.assign(2, unitPose());
  object.subframe_names = {"handle"};
  object.subframe_poses.resize(1);
  return object;
}

PointCloud2 cloud() {
  PointCloud2 cloud;
  cloud.fields.resize(1);
  cloud.fields[0].name = "x";
  cloud.data.assign(4, 1);
  return cloud;
}

std::vector<Example> markerExamples() {
  using visualization_msgs::Marker;
  visualization_msgs::MarkerArray array;
  array.markers = {markerOf(Marker::CUBE, 0), markerOf(Marker::CUBE_LIST, 2)};
  array.markers[1].id = 1;
  return {exampleOf("visualization_msgs/Marker", markerOf(Marker::CUBE_LIST, 2), 2, 10 + 6),
          exampleOf("visualization_msgs/MarkerArray", array, 3, 20 + 6)};
}

std::vector<Example> arrayExamples() {
  JskBoundingBoxArray jsk;
  jsk.header = inMap();
  jsk.boxes.assign(2, {inMap(), unitPose(), unitSize(), 0.5F, 7});
  VisionBoundingBox3DArray boxes;
  boxes.header = inMap();
  boxes.boxes.assign(2, {unitPose(), unitSize()});
  VisionDetection3DArray detections;
  detections.detections.resize(2);
  for (VisionDetection3D& detection : detections.detections) {
    detection.header = inMap();
    detection.results.resize(2);
    detection.bbox = {unitPose(), unitSize()};
    detection.source_cloud = cloud();
  }
  DerivedObjectArray derived;
  derived.objects.resize(2);
  for (DerivedObject& object : derived.objects) {
    object.header = inMap();
    object.pose = unitPose();
    object.polygon.points.resize(2);
    object.shape = unitBox();
  }
  AutowareObjectArray autoware;
  autoware.header = inMap();
  autoware.objects.resize(2);
  for (AutowareObject& object : autoware.objects) {
    object.label = "car";
    object.valid = object.pose_reliable = 1;
    object.pose = unitPose();
    object.dimensions = unitSize();
    object.pointcloud = cloud();
    object.lanes.resize(1);
    object.lanes[0].waypoints.resize(1);
    object.user_defined_info = {"info"};
  }
  return {exampleOf("jsk_recognition_msgs/BoundingBoxArray", jsk, 2, 20),
          exampleOf("vision_msgs/BoundingBox3DArray", boxes, 2, 20),
          exampleOf("vision_msgs/Detection3DArray", detections, 2, 20),
          exampleOf("derived_object_msgs/ObjectArray", derived, 2, 20),
          exampleOf("autoware_msgs/DetectedObjectArray", autoware, 2, 20)};
}

std::vector<Example> objectExamples() {
  PlanningScene scene;
  scene.joint_state.name = {"joint"};
  scene.joint_state.position = {1.0};
  scene.multi_dof_joint_state.transforms.resize(1);
  scene.fixed_frame_transforms.resize(1);
  scene.entry_values.resize(1);
  scene.link_padding.resize(1);
  scene.object_colors.resize(1);
  scene.collision_objects = {objectOf("table"), objectOf("chair")};
  scene.octomap.data.assign(1, 1);
  return {exampleOf("moveit_msgs/CollisionObject", objectOf("table"), 2, 7 + 20),
          exampleOf("moveit_msgs/PlanningScene", scene, 4, 14 + 40)};
}

std::vector<Example> examples() {
  std::vector<Example> all = markerExamples();
  for (const auto& more : {arrayExamples(), objectExamples()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

std::size_t boxesOf(const DecodedMessage& message) {
  std::size_t boxes = 0;
  for (const BoxChange& change : message.changes) {
    boxes += change.boxes.size();
  }
  return boxes;
}
std::size_t rejectedOf(const DecodedMessage& message) {
  std::size_t boxes = 0;
  for (const BoxChange& change : message.changes) {
    boxes += change.rejected();
  }
  return boxes;
}

void expectGood(const DecodedMessage& message) {
  for (const BoxChange& change : message.changes) {
    for (const IdentifiedBox& each : change.boxes) {
      EXPECT_TRUE(isValid(each.box));
      EXPECT_TRUE(isWithin(Limits().coordinate, each.box.center));
      EXPECT_LE(each.box.half_extents.maxCoeff(), Limits().coordinate);
      EXPECT_TRUE(isNearUnit(each.box.orientation));
    }
    EXPECT_LE(std::max({change.ns.size(), change.label.size(), change.frame.size()}), 255U);
  }
}

/// What a topic has after the message alone. What was bad in it is counted.
Draft draftAfter(const Example& example, DecodedMessage message) {
  Parameters parameters;
  const tf2::BufferCore tf;
  BoxTracker tracker(parameters, tf);
  const std::size_t rejected = message.problem.empty() ? rejectedOf(message) : 0;
  const bool is_refused = !message.problem.empty();
  tracker.receive(0, &sourceNamed(example.type), std::move(message), ros::Time(100));
  // A MOVE of what is not known is rejected there.
  EXPECT_GE(tracker.counts().rejected_boxes, rejected);
  EXPECT_EQ(tracker.counts().malformed_messages, is_refused ? 1U : 0U);
  std::size_t by_reason = 0;
  for (const auto& [reason, boxes] : tracker.counts().rejections) {
    by_reason += boxes;
  }
  EXPECT_EQ(by_reason, tracker.counts().rejected_boxes);
  return tracker.draft();
}

/// What the topic says of itself then.
std::string reasonOf(const Draft& draft) {
  return draft.snapshot.completeness(ros::Time(100)).reason;
}

void expectExplained(const Example& example, const Bytes& bytes) {
  const DecodedMessage message = decodeBytes(example.type, bytes);
  expectGood(message);
  const bool is_bad = !message.problem.empty() || rejectedOf(message) > 0;
  const std::string reason = reasonOf(draftAfter(example, message));
  if (is_bad) {
    const char* const what = message.problem.empty() ? "box " : "The last message on topic ";
    EXPECT_NE(reason.find(what), std::string::npos) << example.type << ": " << reason;
    EXPECT_LT(reason.size(), 1000U) << "it does not repeat garbage";
  }
}

TEST(GarbageInBoxes, TheExamplesAreGood) {
  const std::vector<Example> all = examples();
  ASSERT_EQ(all.size(), boxSources().size());
  for (const Example& example : all) {
    const DecodedMessage message = decodeBytes(example.type, example.bytes);
    EXPECT_EQ(message.problem, "");
    EXPECT_EQ(boxesOf(message), example.boxes) << example.type;
    EXPECT_EQ(rejectedOf(message), 0U) << example.type;
    const Draft draft = draftAfter(example, message);
    EXPECT_EQ(reasonOf(draft), "") << example.type;
    EXPECT_EQ(draft.boxes.size(), example.boxes) << example.type;
  }
}

TEST(GarbageInBoxes, NumbersRejectTheirBoxAndNoOther) {
  for (const Example& example : examples()) {
    std::size_t spoil = 0;  // fields in which NaN makes boxes bad
    for (const RecordedField& field : example.fields) {
      if (field.kind != Kind::kDouble) {
        continue;
      }
      for (const double number : hostileDoubles()) {
        const Bytes bytes = withValue(example.bytes, field, number);
        const DecodedMessage message = decodeBytes(example.type, bytes);
        ASSERT_EQ(message.problem, "") << example.type;
        EXPECT_EQ(boxesOf(message) + rejectedOf(message), example.boxes) << "none is lost";
        expectExplained(example, bytes);
      }
      const double nan = std::numeric_limits<double>::quiet_NaN();
      spoil += rejectedOf(decodeBytes(example.type, withValue(example.bytes, field, nan))) > 0;
    }
    EXPECT_EQ(spoil, example.numbers) << example.type;
  }
}

TEST(GarbageInBoxes, NumbersOutOfBoundsAreExplained) {
  const Example example = markerExamples().front();
  const auto field =
      std::find_if(example.fields.begin(), example.fields.end(),
                   [](const RecordedField& each) { return each.kind == Kind::kDouble; });
  const auto problemOf = [&](double x) {
    return decodeBytes(example.type, withValue(example.bytes, *field, x)).changes.at(0).problem();
  };
  EXPECT_EQ(problemOf(1e7), "");
  EXPECT_EQ(problemOf(-1.5e7),
            "box 0 of namespace 'rack' has a position or size out of bounds (its position is "
            "(-1.5e+07, 0, 0) m; give 0, or magnitudes from 1e-200 to 1e+07 m, or raise "
            "~max_coordinate)");
  EXPECT_EQ(problemOf(1e-200), "");
  EXPECT_NE(problemOf(5e-324), "");
}

TEST(GarbageInBoxes, IntegersAreTakenOrExplained) {
  for (const Example& example : examples()) {
    for (const RecordedField& field : example.fields) {
      if (field.kind != Kind::kInteger && field.kind != Kind::kFloat && field.kind != Kind::kTime) {
        continue;
      }
      for (const std::uint64_t number : hostileIntegers()) {
        Bytes bytes = example.bytes;
        std::memcpy(&bytes[field.at], &number, field.size);
        expectExplained(example, bytes);
      }
    }
  }
}

TEST(GarbageInBoxes, StringsAreTakenOrExplained) {
  for (const Example& example : examples()) {
    std::size_t refused = 0;
    for (const RecordedField& field : example.fields) {
      if (field.kind != Kind::kString) {
        continue;
      }
      for (const std::string& text : hostileStrings()) {
        const Bytes bytes = withString(example.bytes, field, text);
        const DecodedMessage message = decodeBytes(example.type, bytes);
        if (message.problem.empty()) {
          EXPECT_EQ(boxesOf(message) + rejectedOf(message), example.boxes) << "none is lost";
        } else {
          EXPECT_GT(text.size(), 255U) << example.type << ": " << message.problem;
          EXPECT_EQ(message.problem.find("a "), 0U);
          EXPECT_NE(message.problem.find(" of " + std::to_string(text.size()) +
                                         " bytes, at most 255 are taken"),
                    std::string::npos)
              << message.problem;
          ++refused;
        }
        expectExplained(example, bytes);
      }
    }
    EXPECT_GT(refused, 0U) << example.type;
  }
}

TEST(GarbageInBoxes, LengthsRefuseTheMessageOrAreExplained) {
  for (const Example& example : examples()) {
    std::size_t lengths = 0;
    for (const RecordedField& field : example.fields) {
      if (field.kind != Kind::kString && field.kind != Kind::kCount) {
        continue;
      }
      ++lengths;
      for (const std::uint32_t length : wrongLengths(field.size)) {
        const Bytes bytes = withValue(example.bytes, field, length);
        if (length > example.bytes.size()) {
          EXPECT_NE(decodeBytes(example.type, bytes).problem, "") << example.type << " " << length;
        }
        expectExplained(example, bytes);
      }
    }
    EXPECT_GE(lengths, 2U);
  }
}

}  // namespace
}  // namespace box_query::test
