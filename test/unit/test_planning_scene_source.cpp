// SPDX-License-Identifier: BSD-3-Clause
#include "unit/collision_objects.h"

namespace box_query::test {
namespace {

constexpr const char* kType = "moveit_msgs/PlanningScene";

PlanningScene sceneOf(const std::vector<CollisionObject>& objects) {
  PlanningScene scene;
  scene.collision_objects = objects;
  return scene;
}

PlanningScene diffOf(const std::vector<CollisionObject>& objects) {
  PlanningScene scene = sceneOf(objects);
  scene.is_diff = 1;
  return scene;
}

AttachedCollisionObject attached(const CollisionObject& object) {
  AttachedCollisionObject one;
  one.link_name = "gripper";
  one.object = object;
  return one;
}

/// Something in every field.
PlanningScene fullScene() {
  PlanningScene scene = sceneOf({object("shelf", {1, 2}), object("table", {5})});
  scene.name = "kitchen";
  scene.joint_state.name = {"elbow", "wrist"};
  scene.joint_state.position = {0.1, 0.2};
  scene.joint_state.velocity = {0.3};
  scene.joint_state.effort = {0.4};
  scene.multi_dof_joint_state.joint_names = {"base"};
  scene.multi_dof_joint_state.transforms.resize(1);
  scene.multi_dof_joint_state.twist.resize(1);
  scene.multi_dof_joint_state.wrench.resize(1);
  AttachedCollisionObject cup = attached(object("cup", {3}));
  cup.touch_links = {"finger", "thumb"};
  cup.detach_posture.joint_names = {"finger"};
  cup.detach_posture.points.resize(1);
  cup.detach_posture.points[0].positions = {0.5};
  cup.detach_posture.points[0].effort = {0.6, 0.7};
  scene.attached_collision_objects = {cup};
  scene.robot_model_name = "arm";
  scene.fixed_frame_transforms.resize(1);
  scene.fixed_frame_transforms[0].child_frame_id = "odom";
  scene.entry_names = {"elbow"};
  scene.entry_values.resize(1);
  scene.entry_values[0].enabled = {1};
  scene.default_entry_names = {"wrist"};
  scene.default_entry_values = {0};
  scene.link_padding.resize(1);
  scene.link_scale.resize(2);
  scene.object_colors.resize(1);
  scene.octomap.id = "OcTree";
  scene.octomap.data = {1, 2, 3};
  return scene;
}

DecodedMessage decode(const PlanningScene& scene, std::size_t max_boxes = kPlenty) {
  return decodeBytes(kType, wire(scene), max_boxes);
}

std::string after(const std::vector<PlanningScene>& scenes) {
  std::vector<DecodedMessage> decoded;
  for (const PlanningScene& scene : scenes) {
    decoded.push_back(decode(scene));
  }
  return contentsAfter(kType, std::move(decoded));
}

TEST(PlanningSceneSource, DecodesTheWorldAmongAllOtherFields) {
  const DecodedMessage message = decode(fullScene());
  ASSERT_EQ(message.problem, "");
  EXPECT_TRUE(message.whole);
  EXPECT_EQ(message.ignored, 2U) << "the attached box and the octomap";
  ASSERT_EQ(message.changes.size(), 3U);
  EXPECT_EQ(message.changes[0].kind, BoxChange::Kind::kRemove);
  EXPECT_EQ(message.changes[0].ns, "cup");
  EXPECT_EQ(message.changes[1].label, "furniture");
  EXPECT_EQ(message.changes[1].stamp, ros::Time(1234, 5678));
  EXPECT_EQ(contents(message), "shelf/0:1 shelf/1:2 table/0:5 ");
  EXPECT_EQ(decode(PlanningScene()).changes.size(), 0U);
  EXPECT_EQ(decode(PlanningScene()).ignored, 0U);
}

TEST(PlanningSceneSource, RefusesMessagesWithTooManyBoxes) {
  EXPECT_EQ(decode(fullScene(), 3).problem, "");
  const DecodedMessage message = decode(fullScene(), 2);
  EXPECT_TRUE(message.changes.empty());
  EXPECT_NE(message.problem.find("more than 2 boxes"), std::string::npos) << message.problem;
}

TEST(PlanningSceneSource, SurvivesDamage) {
  const Bytes whole = wire(fullScene());
  expectRefusedIfCutOffOrTooLong(kType, whole);
  // Every string, array and time once: the lengths within arrays come on top.
  expectClaimsRefused(kType, whole, 60);
  expectSurvivesAnyBytes(kType, whole);
}

TEST(PlanningScenes, AreWholeOrChanges) {
  const PlanningScene kitchen = sceneOf({object("shelf", {1, 2}), object("table", {5})});
  EXPECT_EQ(after({kitchen}), "shelf/0:1 shelf/1:2 table/0:5 ");
  EXPECT_EQ(after({kitchen, sceneOf({object("table", {6})})}), "table/0:6 ");
  EXPECT_EQ(after({kitchen, sceneOf({})}), "");
  EXPECT_EQ(after({kitchen, diffOf({})}), "shelf/0:1 shelf/1:2 table/0:5 ");
  EXPECT_EQ(after({kitchen, diffOf({object("shelf", {}, kRemove), object("table", {7}, kAppend)})}),
            "table/0:5 table/4294967296:7 ");
  CollisionObject move = object("shelf", {}, kMove);
  move.pose = poseAt(10.0);
  EXPECT_EQ(after({kitchen, diffOf({move})}), "shelf/0:11 shelf/1:12 table/0:5 ");
}

TEST(PlanningScenes, LoseWhatIsAttachedAndDoNotKnowWhatIsDetached) {
  const PlanningScene kitchen = sceneOf({object("cup", {3}), object("table", {5})});
  PlanningScene attach = diffOf({});
  attach.attached_collision_objects = {attached(object("cup", {}, kAdd))};
  EXPECT_EQ(after({kitchen, attach}), "table/0:5 ");
  PlanningScene detach = diffOf({});
  detach.attached_collision_objects = {attached(object("cup", {}, kRemove))};
  EXPECT_EQ(after({kitchen, attach, detach}), "table/0:5 rejected 1");
  detach.collision_objects = {object("cup", {8})};
  EXPECT_EQ(after({kitchen, attach, detach}), "cup/0:8 table/0:5 ");
}

}  // namespace
}  // namespace box_query::test
