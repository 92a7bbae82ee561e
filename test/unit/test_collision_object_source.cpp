// SPDX-License-Identifier: BSD-3-Clause
#include "ros/rigid_object.h"
#include "unit/collision_objects.h"

#include <algorithm>
#include <cmath>

namespace box_query::test {
namespace {

constexpr const char* kType = "moveit_msgs/CollisionObject";

DecodedMessage decode(const CollisionObject& message, std::size_t max_boxes = kPlenty) {
  return decodeBytes(kType, wire(message), max_boxes);
}

TEST(CollisionObjectSource, DecodesEveryFieldOfAnObject) {
  const DecodedMessage message = decode(object("shelf", {0.1, 0.2}));
  ASSERT_EQ(message.problem, "");
  EXPECT_FALSE(message.whole);
  ASSERT_EQ(message.changes.size(), 1U);
  const BoxChange& change = message.changes[0];
  EXPECT_EQ(change.kind, BoxChange::Kind::kSet);
  EXPECT_TRUE(change.whole_namespace);
  EXPECT_EQ(change.ns, "shelf");
  EXPECT_EQ(change.id, 0);
  EXPECT_EQ(change.label, "furniture");
  EXPECT_EQ(change.frame, "map");
  EXPECT_EQ(change.stamp, ros::Time(1234, 5678));
  EXPECT_EQ(change.lifetime, 0);
  ASSERT_EQ(change.boxes.size(), 2U);
  EXPECT_EQ(change.boxes[0].id, 0);
  EXPECT_EQ(change.boxes[1].id, 1);
  EXPECT_EQ(change.boxes[1].box.center, Vector3(0.2, 0.0, 0.0));
  EXPECT_EQ(change.boxes[1].box.half_extents, Vector3(0.5, 0.0, 1.5));
}

TEST(CollisionObjectSource, PlacesPrimitivesByThePoseOfTheObject) {
  CollisionObject turned = object("shelf", {2.0});
  turned.primitive_poses[0] = poseAt(2.0, M_PI / 2);
  turned.pose = poseAt(10.0, M_PI / 2);
  const DecodedMessage message = decode(turned);
  ASSERT_EQ(message.changes.at(0).boxes.size(), 1U);
  const OrientedBox& box = message.changes[0].boxes[0].box;
  EXPECT_TRUE(box.center.isApprox(Vector3(10.0, 2.0, 0.0), 1e-15));
  EXPECT_NEAR(std::abs(box.orientation.z()), 1.0, 1e-15) << "two quarter turns";
}

TEST(CollisionObjectSource, TakesPosesThatAreNotGivenAsTheIdentity) {
  CollisionObject bare = object("shelf", {1.0 / 3.0, 7.0});
  bare.pose = geometry_msgs::Pose();
  bare.primitive_poses[0].orientation = geometry_msgs::Quaternion();
  bare.primitive_poses.pop_back();
  const DecodedMessage message = decode(bare);
  ASSERT_EQ(message.changes.at(0).boxes.size(), 2U);
  EXPECT_EQ(message.changes[0].boxes[0].box.center, Vector3(1.0 / 3.0, 0.0, 0.0));
  EXPECT_EQ(message.changes[0].boxes[1].box.center, Vector3::Zero());
  for (const IdentifiedBox& each : message.changes[0].boxes) {
    EXPECT_EQ(each.box.orientation.coeffs(), Quaternion::Identity().coeffs());
  }
}

TEST(CollisionObjectSource, CountsOtherShapesAndKeepsTheBoxesNumbers) {
  CollisionObject mixed = object("shelf", {1.0, 2.0});
  mixed.primitives[0] = solid(3, {1.0, 2.0});  // a cylinder
  mixed.meshes.resize(2);
  mixed.meshes[0].triangles.resize(3);
  mixed.meshes[0].vertices.resize(4);
  mixed.mesh_poses.resize(2);
  mixed.planes.resize(1);
  mixed.plane_poses.resize(1);
  mixed.subframe_names = {"handle", ""};
  mixed.subframe_poses.resize(2);
  const DecodedMessage message = decode(mixed);
  EXPECT_EQ(message.ignored, 4U);
  EXPECT_EQ(contents(message), "shelf/1:2 ");
  mixed.operation = kRemove;
  EXPECT_EQ(decode(mixed).ignored, 0U);
}

TEST(CollisionObjectSource, TellsOperationsApart) {
  EXPECT_EQ(decode(object("shelf", {1}, kAppend)).changes.at(0).kind, BoxChange::Kind::kAppend);
  EXPECT_EQ(decode(object("shelf", {}, kRemove)).changes.at(0).kind, BoxChange::Kind::kRemove);
  EXPECT_EQ(decode(object("", {}, kRemove)).changes.at(0).kind, BoxChange::Kind::kClear);
  const DecodedMessage with_shapes = decode(object("shelf", {1.0, kNan}, kRemove));
  EXPECT_TRUE(with_shapes.changes.at(0).boxes.empty()) << "what leaves has no shapes";
  EXPECT_EQ(with_shapes.changes.at(0).rejected(), 0U) << "nor bad ones";
  for (const Operation bad : {Operation(4), Operation(-1)}) {
    const BoxChange change = decode(object("shelf", {1}, bad)).changes.at(0);
    EXPECT_EQ(change.kind, BoxChange::Kind::kSet);
    EXPECT_TRUE(change.boxes.empty());
    EXPECT_EQ(countOf(change, Rejection::kAction), 1U);
  }
  CollisionObject nowhere = object("shelf", {1, 2}, kMove);
  nowhere.header.frame_id.clear();
  EXPECT_TRUE(decode(nowhere).changes.at(0).boxes.empty()) << "no box without a frame";
  EXPECT_EQ(decode(nowhere).changes.at(0).rejected(), 1U);
  const BoxChange move = decode(object("shelf", {1, 2}, kMove)).changes.at(0);
  EXPECT_EQ(move.kind, BoxChange::Kind::kMove);
  EXPECT_EQ(move.boxes.size(), 3U) << "the pose of the object, and of two shapes";
}

TEST(CollisionObjectSource, FindsOneBadBoxOfAnyKindAmongGoodOnes) {
  const auto rejection = [](const auto& spoil) {
    CollisionObject one = object("shelf", {1, 2, 3});
    spoil(one.primitives[1].dimensions, one.primitive_poses[1]);
    const DecodedMessage message = decode(one);
    EXPECT_EQ(contents(message), "shelf/0:1 shelf/2:3 ");
    const BoxChange& change = message.changes.at(0);
    EXPECT_EQ(change.rejected(), 1U);
    EXPECT_EQ(change.object->boxes.size(), 2U) << "nor can it be moved";
    const auto& counts = change.rejections->counts;
    return static_cast<Rejection>(std::find(counts.begin(), counts.end(), 1U) - counts.begin());
  };
  EXPECT_EQ(rejection([](auto& sides, auto&) { sides.pop_back(); }), Rejection::kShape);
  EXPECT_EQ(rejection([](auto& sides, auto&) { sides[2] = -1.0; }), Rejection::kNegativeSize);
  EXPECT_EQ(rejection([](auto& sides, auto&) { sides[2] = kNan; }), Rejection::kNotFinite);
  EXPECT_EQ(rejection([](auto& sides, auto&) { sides[2] = 5e-324; }), Rejection::kOutOfBounds)
      << "half of it is 0";
  EXPECT_EQ(rejection([](auto&, auto& pose) { pose.position.z = 1e8; }), Rejection::kOutOfBounds);
  EXPECT_EQ(rejection([](auto&, auto& pose) { pose.orientation.z = kNan; }), Rejection::kNotFinite);
  EXPECT_EQ(rejection([](auto&, auto& pose) { pose.orientation.w = 1.1; }),
            Rejection::kOrientation);
}

TEST(CollisionObjectSource, RejectsBadBoxesAndKeepsTheRest) {
  CollisionObject bad = object("shelf", {1, 2, 3, 4, 5});
  bad.primitives[0].dimensions.pop_back();
  bad.primitives[1].dimensions[0] = -1.0;
  bad.primitives[2].dimensions[0] = kInf;
  bad.primitive_poses[3].orientation.w = 0.5;
  const DecodedMessage message = decode(bad);
  EXPECT_EQ(contents(message), "shelf/4:5 ");
  EXPECT_EQ(countOf(message.changes.at(0), Rejection::kShape), 1U);
  EXPECT_EQ(countOf(message.changes[0], Rejection::kNegativeSize), 1U);
  EXPECT_EQ(countOf(message.changes[0], Rejection::kNotFinite), 1U);
  EXPECT_EQ(countOf(message.changes[0], Rejection::kOrientation), 1U);
  bad.pose.position.x = kNan;
  EXPECT_EQ(contents(decode(bad)), "");
  EXPECT_EQ(countOf(decode(object("shelf", {})).changes.at(0), Rejection::kShape), 1U);
  CollisionObject nowhere = object("shelf", {1, 2});
  nowhere.header.frame_id = "";
  EXPECT_EQ(countOf(decode(nowhere).changes.at(0), Rejection::kFrame), 2U);
  EXPECT_EQ(contents(decode(nowhere)), "");
}

TEST(CollisionObjectSource, RefusesMessagesWithTooManyBoxes) {
  EXPECT_EQ(decode(object("shelf", {1, 2}), 2).problem, "");
  const DecodedMessage message = decode(object("shelf", {1, 2}), 1);
  EXPECT_TRUE(message.changes.empty());
  EXPECT_NE(message.problem.find("max_boxes_per_message"), std::string::npos) << message.problem;
}

class DamagedCollisionObject : public testing::TestWithParam<Operation> {};
INSTANTIATE_TEST_SUITE_P(Operations, DamagedCollisionObject, testing::Values(kAdd, kMove));

TEST_P(DamagedCollisionObject, IsSurvived) {
  CollisionObject full = object("shelf", {1, 2});
  full.meshes.resize(2);
  full.meshes[0].triangles.resize(1);
  full.meshes[1].vertices.resize(1);
  full.mesh_poses.resize(1);
  full.planes.resize(1);
  full.plane_poses.resize(1);
  full.subframe_names = {"handle", ""};
  full.subframe_poses.resize(1);
  full.operation = GetParam();
  const Bytes whole = wire(full);
  expectRefusedIfCutOffOrTooLong(kType, whole);
  // Frame, stamp, id, type, primitives, meshes, planes, their poses, subframes.
  expectClaimsRefused(kType, whole, 1 + 1 + 1 + 2 + 3 + 1 + 5 + 1 + 2 + 3 + 1);
  expectSurvivesAnyBytes(kType, whole);
}

std::string after(const std::vector<CollisionObject>& messages) {
  std::vector<DecodedMessage> decoded;
  for (const CollisionObject& message : messages) {
    decoded.push_back(decode(message));
  }
  return contentsAfter(kType, std::move(decoded));
}

TEST(CollisionObjects, AreReplacedAppendedAndRemovedOneByOne) {
  const CollisionObject shelf = object("shelf", {1, 2});
  const CollisionObject table = object("table", {5});
  const CollisionObject more = object("shelf", {3, 4}, kAppend);
  EXPECT_EQ(after({shelf, table}), "shelf/0:1 shelf/1:2 table/0:5 ");
  EXPECT_EQ(after({shelf, table, more, more}),
            "shelf/0:1 shelf/1:2 shelf/4294967296:3 shelf/4294967297:4 shelf/8589934592:3 "
            "shelf/8589934593:4 table/0:5 ");
  EXPECT_EQ(after({more}), "shelf/0:3 shelf/1:4 ") << "what is appended to nothing is added";
  EXPECT_EQ(after({shelf, table, more, object("shelf", {7})}), "shelf/0:7 table/0:5 ");
  EXPECT_EQ(after({shelf, table, more, object("shelf", {}, kRemove)}), "table/0:5 ");
  EXPECT_EQ(after({shelf, table, more, object("", {}, kRemove)}), "");
}

TEST(CollisionObjects, StayAsTheyWereIfAChangeIsRejected) {
  const CollisionObject shelf = object("shelf", {1, 2});
  const CollisionObject more = object("shelf", {3}, kAppend);
  const CollisionObject odd = object("shelf", {}, Operation(4));
  EXPECT_EQ(after({shelf, more, odd}), "shelf/0:1 shelf/1:2 shelf/4294967296:3 rejected 1");
  EXPECT_EQ(after({shelf, more, odd, shelf}), "shelf/0:1 shelf/1:2 ");
}

CollisionObject moveTo(const std::string& id, const geometry_msgs::Pose& pose,
                       const std::vector<double>& shapes = {}) {
  CollisionObject message = object(id, shapes, kMove);
  message.primitives.clear();
  message.pose = pose;
  return message;
}

TEST(CollisionObjects, MoveAsOne) {
  CollisionObject shelf = object("shelf", {1, 2});
  shelf.pose = poseAt(10.0);
  const CollisionObject table = object("table", {5});
  const CollisionObject more = object("shelf", {3, 4}, kAppend);
  EXPECT_EQ(after({shelf, table, moveTo("shelf", poseAt(20.0))}),
            "shelf/0:21 shelf/1:22 table/0:5 ");
  const std::string moved = "shelf/0:-19 shelf/1:-18 shelf/4294967296:-17 shelf/4294967297:-16 ";
  EXPECT_EQ(after({shelf, more, moveTo("shelf", poseAt(20.0)), moveTo("shelf", poseAt(-20.0))}),
            moved)
      << "from where its shapes are within it, whatever came in between";
  EXPECT_EQ(after({shelf, moveTo("shelf", poseAt(-17.0, M_PI))}), "shelf/0:-18 shelf/1:-19 ");
  EXPECT_EQ(after({shelf, moveTo("shelf", poseAt(20.0)), more, object("shelf", {7})}),
            "shelf/0:7 ");
}

TEST(CollisionObjects, MoveByThePosesOfTheirShapes) {
  CollisionObject shelf = object("shelf", {1, 2, 3});
  shelf.primitives[1] = solid(2, {1.0});  // a sphere
  const CollisionObject more = object("shelf", {4}, kAppend);
  const CollisionObject move = moveTo("shelf", poseAt(100.0), {10, 20, 30, 40});
  EXPECT_EQ(after({shelf, more, move}), "shelf/0:110 shelf/2:130 shelf/4294967296:140 ");
  EXPECT_EQ(after({shelf, more, move, moveTo("shelf", poseAt(0.0))}),
            "shelf/0:10 shelf/2:30 shelf/4294967296:40 ")
      << "they keep these poses";
  EXPECT_EQ(after({shelf, more, moveTo("shelf", poseAt(0.0), {10, 20, 30})}),
            "shelf/0:1 shelf/2:3 shelf/4294967296:4 rejected 1");
}

TEST(CollisionObjects, OfOneShapeMoveToThePoseOfIt) {
  EXPECT_EQ(after({object("crate", {5}), moveTo("crate", poseAt(7.0))}), "crate/0:7 ");
  CollisionObject crate = object("crate", {5});
  crate.pose = poseAt(1.0);
  EXPECT_EQ(after({crate, moveTo("crate", poseAt(7.0))}), "crate/0:12 ") << "the pose was given";
}

TEST(CollisionObjects, StayWhereTheyAreIfAMoveIsBad) {
  const CollisionObject shelf = object("shelf", {1, 2});
  geometry_msgs::Pose bad = poseAt(5.0);
  bad.orientation.w = 0.5;
  EXPECT_EQ(after({shelf, moveTo("shelf", bad)}), "shelf/0:1 shelf/1:2 rejected 1");
  EXPECT_EQ(after({shelf, moveTo("shelf", bad), moveTo("shelf", poseAt(5.0))}),
            "shelf/0:6 shelf/1:7 ");
  EXPECT_EQ(after({moveTo("shelf", poseAt(5.0))}), "rejected 1") << "not known";
  EXPECT_EQ(after({shelf, object("shelf", {}, kRemove), moveTo("shelf", poseAt(5.0))}),
            "rejected 1");
  CollisionObject half = object("shelf", {1, 2});
  half.primitives[0].dimensions.pop_back();
  EXPECT_EQ(after({half, moveTo("shelf", poseAt(5.0))}), "shelf/1:7 rejected 1")
      << "what was bad does not become good";
}

}  // namespace
}  // namespace box_query::test
