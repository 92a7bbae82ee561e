// SPDX-License-Identifier: BSD-3-Clause
// Boxes in the fixed frame, from publishers through the real master into snapshots.
#include "rostest/monitor_fixture.h"

#include <cmath>
#include <limits>

#include <ros/init.h>

namespace box_query {
namespace {

using visualization_msgs::Marker;

TEST(SceneMonitor, KnowsNothingBeforeTheFirstMessage) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"silent"}));
  const SnapshotPtr snapshot = monitor.currentScene();
  EXPECT_EQ(snapshot->scene.size(), 0U);
  const Completeness known = snapshot->completeness(ros::Time::now());
  EXPECT_FALSE(known.complete);
  EXPECT_NE(known.reason.find("/silent"), std::string::npos) << known.reason;
  EXPECT_TRUE(std::isinf(snapshot->age(ros::Time::now())));
}

TEST(SceneMonitor, KeepsBoxesOfTheFixedFrameBitForBit) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"equal_frames"}));
  ArrayTalker talker("equal_frames");
  ASSERT_TRUE(talker.isHeard());
  Marker one = cube("map", 7, 0.1, 1e6 / 3.0, -0.0);
  one.pose.orientation.w = 0.7;  // within the tolerance, and neither normalised nor rounded
  one.pose.orientation.x = 0.71;
  one.scale.x = 0.3;
  one.text = "a crate";
  one.header.stamp = ros::Time(12, 34);
  talker.say(array({cube("/map", 9, 5.0), one}));
  ASSERT_TRUE(hasBoxes(monitor, 2));

  const SnapshotPtr snapshot = monitor.scene();
  const OrientedBox& box = boxOf(*snapshot, 0);
  EXPECT_EQ(box.center, Vector3(0.1, 1e6 / 3.0, -0.0));
  EXPECT_TRUE(std::signbit(box.center.z()));
  EXPECT_EQ(box.orientation.coeffs(), Quaternion(0.7, 0.71, 0.0, 0.0).coeffs());
  EXPECT_EQ(box.half_extents, Vector3(0.15, 0.5, 0.5));
  EXPECT_EQ(snapshot->names[0].topic, "/equal_frames");
  EXPECT_EQ(snapshot->names[0].ns, "test");
  EXPECT_EQ(snapshot->names[0].id, 7);
  EXPECT_EQ(snapshot->names[0].label, "a crate");
  EXPECT_EQ(snapshot->stamps[0], ros::Time(12, 34));
  EXPECT_EQ(snapshot->names[1].id, 9);
  EXPECT_EQ(snapshot->frame, "map");
  EXPECT_TRUE(snapshot->completeness(ros::Time::now()).complete);
  EXPECT_EQ(monitor.statistics().avoided_transforms, 2U);
  EXPECT_EQ(monitor.sceneById(snapshot->id), snapshot);
  EXPECT_EQ(monitor.sceneById(snapshot->id + 1), nullptr);
}

}  // namespace
}  // namespace box_query

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_scene_monitor");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
