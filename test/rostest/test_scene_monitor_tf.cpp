// SPDX-License-Identifier: BSD-3-Clause
// Boxes in other frames than the fixed one: transforms that are there, late, missing, moving.
#include "rostest/monitor_fixture.h"

#include <cmath>

#include <ros/init.h>

namespace box_query {
namespace {

using visualization_msgs::Marker;

constexpr double kQuarterTurn = 1.5707963267948966;

/// A monitor with one topic, its publisher and tf, all connected.
class SceneMonitorTf : public MonitorOfOneTopic {
 protected:
  void start() {
    MonitorOfOneTopic::start();
    tf_ = std::make_unique<Talker<tf2_msgs::TFMessage>>("/tf");
    ASSERT_TRUE(tf_->isHeard());
  }

  /// Says it at that time, and waits until the monitor knows it.
  void move(const std::string& child, const ros::Time& stamp, double x, double yaw = 0.0) {
    tf_->say(transform("map", child, stamp, x, yaw));
    geometry_msgs::TransformStamped known;
    ASSERT_EQ(monitor_->lookUpTransform("map", child, stamp, 10.0, known), "");
  }

  bool isAt(std::size_t index, const Vector3& center) {
    return eventually([&] {
      const SnapshotPtr snapshot = monitor_->currentScene();
      return snapshot->scene.size() > index &&
             boxOf(*snapshot, index).center.isApprox(center, 1e-12);
    });
  }

  std::unique_ptr<Talker<tf2_msgs::TFMessage>> tf_;
};

Marker at(Marker marker, const ros::Time& stamp) {
  marker.header.stamp = stamp;
  return marker;
}

TEST_F(SceneMonitorTf, PlacesBoxesOfOtherFrames) {
  start();
  move("turned", ros::Time(10), 5.0, kQuarterTurn);
  Marker box = at(cube("/turned", 1, 1.0, 0.0, 2.0), ros::Time(10));
  box.scale.x = 4.0;
  say({box});
  ASSERT_TRUE(isAt(0, Vector3(5.0, 1.0, 2.0)));
  const SnapshotPtr snapshot = monitor_->scene();
  EXPECT_TRUE(snapshot->completeness(ros::Time::now()).complete);
  const OrientedBox& placed = boxOf(*snapshot, 0);
  EXPECT_TRUE((placed.orientation * Vector3::UnitX()).isApprox(Vector3::UnitY(), 1e-12));
  EXPECT_EQ(placed.half_extents, Vector3(2.0, 0.5, 0.5));
  EXPECT_EQ(monitor_->statistics().avoided_transforms, 0U);
}

TEST_F(SceneMonitorTf, WaitsForALateTransformAndSaysSo) {
  start();
  say({at(cube("late", 1, 1.0), ros::Time(10))});
  say({at(cube("late", 2, 2.0), ros::Time(10)), cube("map", 3, 3.0)});
  ASSERT_TRUE(hasBoxes(*monitor_, 1));
  const SnapshotPtr before = monitor_->currentScene();
  EXPECT_EQ(before->names[0].id, 3) << "boxes that can be placed are";
  EXPECT_EQ(before->topics[0].waiting, 2U);
  expectReason({"2 boxes", topic_, "'late'", "'map'", "10.000", "publish it"});
  move("late", ros::Time(9), 100.0);
  EXPECT_FALSE(completenessOf(*monitor_).complete) << "tf knows the frame, but not that time";
  move("late", ros::Time(11), 100.0);
  ASSERT_TRUE(hasBoxes(*monitor_, 3));
  EXPECT_TRUE(isAt(0, Vector3(101.0, 0.0, 0.0)));
  EXPECT_TRUE(isAt(1, Vector3(102.0, 0.0, 0.0)));
  EXPECT_TRUE(completenessOf(*monitor_).complete);
}

TEST_F(SceneMonitorTf, GivesUpWhatNeverComesAndNamesIt) {
  parameters_.waiting_timeout = 0.2;
  start();
  say({cube("never", 1, 1.0), cube("map", 2, 2.0)});
  ASSERT_TRUE(eventually([&] { return monitor_->statistics().given_up_boxes == 1; }));
  const SnapshotPtr snapshot = monitor_->currentScene();
  EXPECT_EQ(contents(*snapshot), "2:2 ");
  EXPECT_EQ(snapshot->topics[0].waiting, 0U);
  EXPECT_EQ(snapshot->topics[0].rejected, 1U);
  EXPECT_EQ(completenessOf(*monitor_).reason,
            "1 box of topic " + topic_ +
                " cannot be used: box 1 of namespace 'test' was given up: the "
                "transform from frame 'never' to 'map' has not come in time; publish that first. "
                "Publish the box again, correctly, or delete it.");
  say({withAction(cube("never", 1, 1.0), Marker::DELETE)});
  EXPECT_TRUE(becomes(true));
}

TEST_F(SceneMonitorTf, PlacesAtTheStampOfTheMessage) {
  start();
  for (int second = 10; second <= 14; ++second) {
    move("cart", ros::Time(second), second);
  }
  say({at(cube("cart", 1, 0.0), ros::Time(12)), at(cube("cart", 2, 0.0), ros::Time(10, 500000000)),
       cube("cart", 3, 0.0)});
  ASSERT_TRUE(hasBoxes(*monitor_, 3));
  EXPECT_TRUE(isAt(0, Vector3(12.0, 0.0, 0.0)));
  EXPECT_TRUE(isAt(1, Vector3(10.5, 0.0, 0.0)));
  EXPECT_TRUE(isAt(2, Vector3(14.0, 0.0, 0.0))) << "no stamp: the latest";
  move("cart", ros::Time(15), 15.0);
  EXPECT_TRUE(isAt(2, Vector3(14.0, 0.0, 0.0))) << "and there it stays";
}

TEST_F(SceneMonitorTf, FollowsFramesThatBoxesAreLockedTo) {
  start();
  Marker locked = at(cube("lift", 1, 1.0), ros::Time(5));
  locked.frame_locked = true;
  say({locked});
  ASSERT_TRUE(becomes(false));
  ASSERT_TRUE(eventually([&] { return monitor_->currentScene()->topics[0].waiting == 1; }));
  for (int second = 10; second < 15; ++second) {
    move("lift", ros::Time(second), second, 0.0);
    EXPECT_TRUE(isAt(0, Vector3(second + 1.0, 0.0, 0.0)));
  }
  EXPECT_TRUE(completenessOf(*monitor_).complete);
  const SnapshotPtr before = monitor_->currentScene();
  EXPECT_EQ(monitor_->currentScene(), before) << "nothing has moved";
  say({withAction(locked, Marker::DELETE)});
  EXPECT_TRUE(hasBoxes(*monitor_, 0));
}

TEST_F(SceneMonitorTf, PlacesBoxesOnEitherSideOfAJump) {
  start();
  const ros::Time before(10);
  const ros::Time after(10, 1000000);
  move("robot", before, 1.0, 0.0);
  Marker locked = at(cube("robot", 2, 0.0), before);
  locked.frame_locked = true;
  say({at(cube("robot", 1, 0.0), before), locked, at(cube("robot", 3, 0.0), after)});
  EXPECT_TRUE(isAt(0, Vector3(1.0, 0.0, 0.0)));
  EXPECT_TRUE(isAt(1, Vector3(1.0, 0.0, 0.0)));
  ASSERT_TRUE(becomes(false)) << "what is of the time behind the jump waits";
  move("robot", after, 100.0, 0.0);  // as where the robot learns at last where it is
  EXPECT_TRUE(becomes(true));
  EXPECT_TRUE(isAt(0, Vector3(1.0, 0.0, 0.0))) << "it was seen before";
  EXPECT_TRUE(isAt(1, Vector3(100.0, 0.0, 0.0))) << "it is locked to what jumped";
  EXPECT_TRUE(isAt(2, Vector3(100.0, 0.0, 0.0)));
}

TEST_F(SceneMonitorTf, RefitsListsThatAreLockedToFrames) {
  start();
  move("belt", ros::Time(5), 5.0);
  Marker list = at(cube("belt", 1, 0.25), ros::Time(5));
  list.type = Marker::CUBE_LIST;
  list.frame_locked = true;
  list.points.resize(2000);
  for (std::size_t n = 0; n < list.points.size(); ++n) {
    list.points[n].y = 2.0 * static_cast<double>(n);
  }
  say({list});
  ASSERT_TRUE(hasBoxes(*monitor_, 2000));
  const MonitorStatistics before = monitor_->statistics();
  for (int second = 10; second < 15; ++second) {
    move("belt", ros::Time(second), second, kQuarterTurn);
    EXPECT_TRUE(isAt(3, Vector3(second - 6.0, 0.25, 0.0)));
  }
  const MonitorStatistics after = monitor_->statistics();
  EXPECT_GE(after.builds, before.builds + 5);
  EXPECT_GE(after.refits - before.refits, after.builds - before.builds - 1)
      << "all but the quarter turn";
}

TEST_F(SceneMonitorTf, ShowsAnEarlierWordWhileEveryTransformIsLate) {
  start();
  for (int second = 10; second < 20; ++second) {
    say({at(cube("behind", 1, 0.0), ros::Time(second))});
    ASSERT_TRUE(eventually(
        [&] { return monitor_->statistics().messages == static_cast<std::uint64_t>(second - 9); }));
    move("behind", ros::Time(second - 1), second - 1.0);  // one message late
    if (second > 10) {
      EXPECT_TRUE(isAt(0, Vector3(second - 1.0, 0.0, 0.0))) << "its newest place";
    }
    EXPECT_FALSE(completenessOf(*monitor_).complete) << "there is news of it that waits";
  }
  move("behind", ros::Time(19), 19.0);
  EXPECT_TRUE(becomes(true));
  EXPECT_TRUE(isAt(0, Vector3(19.0, 0.0, 0.0)));
}

TEST_F(SceneMonitorTf, PlacesBoxesThatWaitedInTheOrderInWhichTheyWereSaid) {
  start();
  const ros::Time stamp(10);
  // Of the order of frames and stamps the last word is neither the first nor the last.
  say({at(cube("o_c", 1, 1.0), ros::Time(11)), at(cube("o_a", 1, 2.0), stamp),
       at(cube("o_b", 1, 3.0), stamp), at(cube("o_a", 2, 4.0), stamp),
       withAction(cube("", 2, 0.0), Marker::DELETE), at(cube("o_c", 3, 5.0), ros::Time(11))});
  ASSERT_TRUE(eventually([&] { return monitor_->currentScene()->topics[0].waiting == 2; }));
  tf2_msgs::TFMessage all;
  for (const char* frame : {"o_a", "o_b", "o_c"}) {
    for (const int second : {9, 12}) {
      all.transforms.push_back(
          transform("map", frame, ros::Time(second), 100.0).transforms.front());
    }
  }
  tf_->say(all);
  ASSERT_TRUE(holds("1:103 3:105 "));
  EXPECT_TRUE(becomes(true));

  say({at(cube("o_d", 1, 1.0), stamp), at(cube("o_e", 1, 2.0), stamp)});
  ASSERT_TRUE(becomes(false));
  move("o_e", stamp, 200.0);
  ASSERT_TRUE(holds("1:202 3:105 "));
  EXPECT_TRUE(becomes(true)) << "nothing later waits";
  move("o_d", stamp, 300.0);
  say({cube("map", 4, 4.0)});
  EXPECT_TRUE(holds("1:202 3:105 4:4 ")) << "the earlier word came too late";
}

TEST_F(SceneMonitorTf, DropsWaitingBoxesThatAreDeleted) {
  start();
  say({at(cube("slow", 1, 1.0), ros::Time(10))});
  ASSERT_TRUE(eventually([&] { return monitor_->currentScene()->topics[0].waiting == 1; }));
  say({withAction(cube("", 1, 0.0), Marker::DELETE)});
  ASSERT_TRUE(becomes(true));
  move("slow", ros::Time(10), 1.0);
  say({at(cube("slow", 2, 2.0), ros::Time(10))});
  ASSERT_TRUE(isAt(0, Vector3(3.0, 0.0, 0.0)));
  EXPECT_EQ(monitor_->currentScene()->scene.size(), 1U);
}

TEST_F(SceneMonitorTf, LetsOnlySoManyWait) {
  parameters_.max_waiting_boxes = 3;
  start();
  say({cube("far", 1, 0.0), cube("far", 2, 0.0), cube("far", 3, 0.0), cube("far", 4, 0.0),
       cube("map", 5, 0.0)});
  ASSERT_TRUE(hasBoxes(*monitor_, 1));
  const TopicState state = monitor_->currentScene()->topics[0];
  EXPECT_EQ(state.waiting, 3U);
  EXPECT_EQ(state.rejected, 1U);
  EXPECT_NE(state.problem.find("max_waiting_boxes"), std::string::npos) << state.problem;
  EXPECT_EQ(monitor_->statistics().overflowed_boxes, 1U);
  say({withAction(cube("", 0, 0.0), Marker::DELETEALL), cube("far", 6, 0.0)});
  ASSERT_TRUE(hasBoxes(*monitor_, 0));
  EXPECT_EQ(monitor_->currentScene()->topics[0].waiting, 1U) << "the deleted ones make room";
  EXPECT_EQ(monitor_->currentScene()->topics[0].rejected, 0U);
}

TEST_F(SceneMonitorTf, KnowsTransformsForItsTransformHistory) {
  parameters_.transform_history = 30.0;
  SceneMonitor patient(ros::NodeHandle(), parameters_);
  parameters_.transform_history = 2.0;
  start();
  geometry_msgs::TransformStamped found;
  for (const int second : {10, 20}) {
    move("cart", ros::Time(second), second);
    ASSERT_EQ(patient.lookUpTransform("map", "cart", ros::Time(second), 10.0, found), "");
  }
  EXPECT_EQ(patient.lookUpTransform("map", "cart", ros::Time(15), 0.0, found), "");
  EXPECT_EQ(found.transform.translation.x, 15.0);
  EXPECT_NE(monitor_->lookUpTransform("map", "cart", ros::Time(15), 0.0, found), "");
}

TEST_F(SceneMonitorTf, LooksUpTransformsThatComeInTime) {
  start();
  geometry_msgs::TransformStamped found;
  EXPECT_EQ(monitor_->lookUpTransform("map", "/map", ros::Time(3), 0.0, found), "");
  EXPECT_EQ(found.transform.rotation.w, 1.0);
  EXPECT_EQ(monitor_->lookUpTransform("nobody", "nobody", ros::Time(), 0.0, found), "");

  const auto start_time = std::chrono::steady_clock::now();
  const std::string problem = monitor_->lookUpTransform("map", "absent", ros::Time(7), 0.2, found);
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start_time;
  EXPECT_GE(waited.count(), 0.2);
  for (const char* word : {"'absent'", "'map'", "7.000", "0.2 s"}) {
    EXPECT_NE(problem.find(word), std::string::npos) << word << " in " << problem;
  }
  EXPECT_NE(monitor_->lookUpTransform("map", "", ros::Time(), 10.0, found), "");
  EXPECT_NE(monitor_->lookUpTransform("map", "//a", ros::Time(), 10.0, found), "");

  std::thread late([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    tf_->say(transform("map", "coming", ros::Time(7), 4.0));
  });
  EXPECT_EQ(monitor_->lookUpTransform("/map", "coming", ros::Time(7), 10.0, found), "");
  late.join();
  EXPECT_EQ(found.transform.translation.x, 4.0);
}

}  // namespace
}  // namespace box_query

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_scene_monitor_tf");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
