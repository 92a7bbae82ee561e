// SPDX-License-Identifier: BSD-3-Clause
// Simulated time that stands still, runs, and goes back. The test is the clock.
#include "rostest/monitor_fixture.h"

#include <atomic>

#include <ros/init.h>
#include <rosgraph_msgs/Clock.h>

namespace box_query {
namespace {

using visualization_msgs::Marker;

class SceneMonitorClock : public MonitorOfOneTopic {
 protected:
  /// Sets the ROS time of this process, monitor included.
  void setTime(double seconds) {
    rosgraph_msgs::Clock message;
    message.clock = ros::Time(seconds);
    ASSERT_TRUE(clock_.isHeard());
    clock_.say(message);
    ASSERT_TRUE(eventually([&] { return ros::Time::now() == message.clock; }));
  }

  Talker<rosgraph_msgs::Clock> clock_{"/clock"};
};

// The first tests, since a clock cannot be unset again.
TEST_F(SceneMonitorClock, IsIncompleteBeforeItHasStarted) {
  ASSERT_TRUE(ros::Time::now().isZero());
  start();
  say({cube("map", 1, 1.0)});
  ASSERT_TRUE(hasBoxes(*monitor_, 1));
  EXPECT_EQ(completenessOf(*monitor_).reason,
            "The ROS clock has not started: publish /clock, or unset /use_sim_time.");
  EXPECT_FALSE(completenessOf(*monitor_).complete);
  EXPECT_EQ(monitor_->currentScene()->age(ros::Time::now()),
            std::numeric_limits<double>::infinity());
}

// What is latched comes once: before the first message of /clock or after it, as it happens. This
// test starts the clock.
TEST_F(SceneMonitorClock, TakesWhatCameBeforeItHasStartedAsReceivedThen) {
  ASSERT_TRUE(ros::Time::now().isZero());
  parameters_.box_topics[0].timeout = 2.0;
  start();
  Talker<tf2_msgs::TFMessage> tf("/tf_static");
  ASSERT_TRUE(tf.isHeard());
  Marker mortal = cube("map", 1, 1.0);
  mortal.lifetime = ros::Duration(1.5);
  Marker waiting = cube("late", 2, 2.0);
  waiting.lifetime = ros::Duration(1.5);
  say({mortal, waiting});
  ASSERT_TRUE(hasBoxes(*monitor_, 1));
  setTime(50.0);
  EXPECT_EQ(monitor_->currentScene()->age(ros::Time::now()), 0.0);
  tf.say(transform("map", "late", ros::Time(), 1.0));
  ASSERT_TRUE(hasBoxes(*monitor_, 2));
  EXPECT_TRUE(completenessOf(*monitor_).complete) << completenessOf(*monitor_).reason;
  setTime(51.0);
  EXPECT_EQ(monitor_->currentScene()->age(ros::Time::now()), 1.0);
  EXPECT_EQ(monitor_->currentScene()->scene.size(), 2U);
  setTime(51.5);
  EXPECT_EQ(monitor_->currentScene()->scene.size(), 0U);
  setTime(52.5);
  expectReason({"Topic " + topic_ + " is stale: its last message came 2.5 s ago"});
}

TEST_F(SceneMonitorClock, EndsLifetimesAndTimeoutsToTheNanosecond) {
  setTime(100.0);
  parameters_.box_topics[0].timeout = 2.0;
  start();
  Marker mortal = cube("map", 1, 1.0);
  mortal.lifetime = ros::Duration(1.5);
  say({mortal, cube("map", 2, 2.0)});
  ASSERT_TRUE(hasBoxes(*monitor_, 2));
  setTime(101.499999999);
  EXPECT_EQ(monitor_->currentScene()->scene.size(), 2U);
  setTime(101.5);
  EXPECT_EQ(monitor_->currentScene()->scene.size(), 1U)
      << "at the query, not at the worker's leisure";
  setTime(102.0);
  EXPECT_TRUE(completenessOf(*monitor_).complete);
  EXPECT_EQ(monitor_->currentScene()->age(ros::Time::now()), 2.0) << "no stamp: that of receipt";
  setTime(102.000000001);
  EXPECT_FALSE(completenessOf(*monitor_).complete);
}

TEST_F(SceneMonitorClock, DropsTheBoxesOfAStaleTopicIfItIsToldTo) {
  setTime(110.0);
  parameters_ = listenTo({"/dropped", "/kept"});
  parameters_.box_topics[0].timeout = 2.0;
  parameters_.box_topics[0].drop_stale = true;
  parameters_.box_topics[1].timeout = 5.0;
  listen();
  ArrayTalker dropped("/dropped");
  ArrayTalker kept("/kept");
  ASSERT_TRUE(dropped.isHeard() && kept.isHeard());
  dropped.say(array({cube("map", 1, 1.0), cube("absent", 2, 2.0)}));
  kept.say(array({cube("map", 3, 3.0)}));
  ASSERT_TRUE(hasBoxes(*monitor_, 2));
  setTime(112.0);
  EXPECT_EQ(contents(*monitor_->currentScene()), "1:1 3:3 ");
  expectReason({"'absent'"});

  setTime(112.000000001);
  EXPECT_EQ(contents(*monitor_->currentScene()), "3:3 ") << "each topic has a timeout of its own";
  expectReason(
      {"Topic /dropped is stale", "its timeout is 2 s, after which its boxes are dropped"});
  EXPECT_EQ(completenessOf(*monitor_).reason.find("/kept"), std::string::npos);
  EXPECT_EQ(monitor_->statistics().dropped_boxes, 2U) << "the waiting one too";
  setTime(116.0);
  EXPECT_EQ(contents(*monitor_->currentScene()), "3:3 ") << "stale, and kept";
  expectReason({"Topic /dropped is stale", "Topic /kept is stale", "its timeout is 5 s: check"});

  dropped.say(array({cube("map", 4, 4.0)}));
  kept.say(array({cube("map", 5, 5.0)}));
  EXPECT_TRUE(holds("4:4 3:3 5:5 "));
  EXPECT_TRUE(becomes(true));
}

TEST_F(SceneMonitorClock, DropsOldBoxesEvenIfTheNextMessageComesFirst) {
  setTime(120.0);
  parameters_.box_topics[0].timeout = 1.0;
  parameters_.box_topics[0].drop_stale = true;
  start();
  say({cube("map", 1, 1.0)});
  ASSERT_TRUE(hasBoxes(*monitor_, 1));
  // The worker looks every 50 ms: in most rounds the message is there before.
  for (int round = 2; round < 12; ++round) {
    setTime(120.0 + 2.0 * round);
    say({cube("map", round, round)});
    ASSERT_TRUE(eventually(
        [&] { return monitor_->statistics().messages == static_cast<std::uint64_t>(round); }));
    ASSERT_TRUE(holds(std::to_string(round) + ":" + std::to_string(round) + " "));
  }
  EXPECT_EQ(monitor_->statistics().dropped_boxes, 10U);
}

TEST_F(SceneMonitorClock, LooksUpTransformsWhileTheClockStands) {
  setTime(200.0);
  listen();
  geometry_msgs::TransformStamped found;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_NE(monitor_->lookUpTransform("map", "absent", ros::Time(), 0.1, found), "");
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
  EXPECT_LT(waited.count(), 5.0);
}

TEST_F(SceneMonitorClock, GivesUpWaitingBoxesWhileTheClockStands) {
  setTime(300.0);
  parameters_.waiting_timeout = 0.1;
  start();
  say({cube("absent", 1, 1.0), cube("map", 2, 2.0)});
  EXPECT_TRUE(eventually([&] { return monitor_->statistics().given_up_boxes == 1; }));
  EXPECT_EQ(contents(*monitor_->currentScene()), "2:2 ");
}

TEST_F(SceneMonitorClock, ForgetsWhatItKnewWhenTimeGoesBack) {
  setTime(500.0);
  start();
  Talker<tf2_msgs::TFMessage> tf("/tf");
  ASSERT_TRUE(tf.isHeard());
  tf.say(transform("map", "back", ros::Time(499), 1.0));
  geometry_msgs::TransformStamped found;
  ASSERT_EQ(monitor_->lookUpTransform("map", "back", ros::Time(), 10.0, found), "");
  say({cube("map", 1, 1.0), cube("back", 2, 2.0)});
  ASSERT_TRUE(hasBoxes(*monitor_, 2));
  const std::uint64_t id = monitor_->currentScene()->id;

  setTime(50.0);
  const SnapshotPtr after = monitor_->currentScene();
  EXPECT_EQ(after->scene.size(), 0U);
  EXPECT_GT(after->id, id);
  EXPECT_FALSE(after->completeness(ros::Time::now()).complete);
  EXPECT_NE(monitor_->lookUpTransform("map", "back", ros::Time(), 0.0, found), "")
      << "a transform of the future";

  tf.say(transform("map", "back", ros::Time(50), 7.0));
  say({cube("back", 2, 2.0)});
  ASSERT_TRUE(hasBoxes(*monitor_, 1));
  EXPECT_EQ(boxOf(*monitor_->currentScene(), 0).center, Vector3(9.0, 0.0, 0.0));
  EXPECT_TRUE(completenessOf(*monitor_).complete);
}

TEST_F(SceneMonitorClock, NoticesThatTimeGoesBackWhileNobodyAsks) {
  setTime(600.0);
  start();
  Talker<tf2_msgs::TFMessage> tf("/tf");
  ASSERT_TRUE(tf.isHeard());
  Marker waiting = cube("slow", 2, 2.0);
  waiting.header.stamp = ros::Time(600);
  say({cube("map", 1, 1.0), waiting});
  ASSERT_TRUE(hasBoxes(*monitor_, 1));
  ASSERT_EQ(monitor_->currentScene()->topics[0].waiting, 1U);
  std::atomic<int> boxes{-1};
  monitor_->setChangedCallback(
      [&] { boxes = static_cast<int>(monitor_->currentScene()->scene.size()); });
  setTime(599.0);
  EXPECT_TRUE(eventually([&] { return boxes == 0; })) << "and then the clock stands";
  tf.say(transform("map", "slow", ros::Time(600), 1.0));
  say({cube("map", 3, 3.0)});
  EXPECT_TRUE(eventually([&] { return boxes == 1; }));
  EXPECT_EQ(contents(*monitor_->currentScene()), "3:3 ") << "what waited is forgotten too";
  EXPECT_TRUE(completenessOf(*monitor_).complete);
  monitor_->setChangedCallback(nullptr);
}

}  // namespace
}  // namespace box_query

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_scene_monitor_clock");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
