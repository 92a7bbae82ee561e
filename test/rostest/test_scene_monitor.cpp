// SPDX-License-Identifier: BSD-3-Clause
// What is said of boxes in the fixed frame, through the real master, and the snapshots that come of
// it.
#include "rostest/monitor_fixture.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include <ros/init.h>

namespace box_query {
namespace {

using visualization_msgs::Marker;

TEST_F(MonitorOfOneTopic, KnowsNothingBeforeTheFirstMessage) {
  listen();
  const SnapshotPtr snapshot = monitor_->currentScene();
  EXPECT_EQ(snapshot->scene.size(), 0U);
  expectReason({"No boxes have come on topic " + topic_});
  EXPECT_TRUE(std::isinf(snapshot->age(ros::Time::now())));
}

TEST_F(MonitorOfOneTopic, KeepsBoxesOfTheFixedFrameBitForBit) {
  start();
  Marker one = cube("map", 7, 0.1, 1e6 / 3.0, -0.0);
  one.pose.orientation.w = 0.7;  // within the tolerance, and neither normalised nor rounded
  one.pose.orientation.x = 0.71;
  one.scale.x = 0.3;
  one.text = "a crate";
  one.header.stamp = ros::Time(12, 34);
  say({cube("/map", 9, 5.0), one});
  ASSERT_TRUE(hasBoxes(*monitor_, 2));

  const SnapshotPtr snapshot = monitor_->scene();
  const OrientedBox& box = boxOf(*snapshot, 0);
  EXPECT_EQ(box.center, Vector3(0.1, 1e6 / 3.0, -0.0));
  EXPECT_TRUE(std::signbit(box.center.z()));
  EXPECT_EQ(box.orientation.coeffs(), Quaternion(0.7, 0.71, 0.0, 0.0).coeffs());
  EXPECT_EQ(box.half_extents, Vector3(0.15, 0.5, 0.5));
  EXPECT_EQ(snapshot->names[0].topic, topic_);
  EXPECT_EQ(snapshot->names[0].ns, "test");
  EXPECT_EQ(snapshot->names[0].id, 7);
  EXPECT_EQ(snapshot->names[0].label, "a crate");
  EXPECT_EQ(snapshot->stamps[0], ros::Time(12, 34));
  EXPECT_EQ(snapshot->names[1].id, 9);
  EXPECT_EQ(snapshot->frame, "map");
  EXPECT_TRUE(snapshot->completeness(ros::Time::now()).complete);
  EXPECT_EQ(monitor_->statistics().avoided_transforms, 2U);
  EXPECT_EQ(monitor_->sceneById(snapshot->id), snapshot);
  EXPECT_EQ(monitor_->sceneById(snapshot->id + 1), nullptr);
}

TEST_F(MonitorOfOneTopic, HearsSingleMarkersAndLists) {
  listen();
  Talker<Marker> talker(topic_);
  ASSERT_TRUE(talker.isHeard());
  Marker list = cube("map", 5, 10.0);
  list.type = Marker::CUBE_LIST;
  list.points.resize(2);
  list.points[1].x = 1.0;
  talker.say(list);
  talker.say(cube("map", 6, 3.0));
  EXPECT_TRUE(holds("5:10 6:3 4294967301:11 ")) << contents(*monitor_->currentScene());
  talker.say(withAction(list, Marker::DELETE));
  EXPECT_TRUE(holds("6:3 "));
}

TEST_F(MonitorOfOneTopic, DeletesOnOneTopicOnly) {
  parameters_ = listenTo({"b_topic", "a_topic"});
  listen();
  ArrayTalker a("a_topic");
  ArrayTalker b("b_topic");
  ASSERT_TRUE(a.isHeard() && b.isHeard());
  b.say(array({cube("map", 1, 1.0), cube("map", 2, 2.0)}));
  ASSERT_TRUE(hasBoxes(*monitor_, 2));
  EXPECT_FALSE(completenessOf(*monitor_).complete) << "a_topic was not heard";
  a.say(array({cube("map", 2, 4.0), cube("map", 1, 3.0)}));
  EXPECT_TRUE(holds("1:3 2:4 1:1 2:2 ")) << "ordered by topic, then id";
  EXPECT_EQ(monitor_->scene()->topics[0].parameters.topic, "/b_topic")
      << "in the parameter's order";
  EXPECT_TRUE(completenessOf(*monitor_).complete);
  b.say(array({withAction(cube("", 1, 0.0), Marker::DELETE)}));
  EXPECT_TRUE(holds("1:3 2:4 2:2 "));
  b.say(array({withAction(cube("", 0, 0.0), Marker::DELETEALL), cube("map", 9, 9.0)}));
  EXPECT_TRUE(holds("1:3 2:4 9:9 "));
  Marker sphere = cube("map", 2, 0.0);
  sphere.type = Marker::SPHERE;
  a.say(array({sphere}));
  EXPECT_TRUE(holds("1:3 9:9 "));
  EXPECT_EQ(monitor_->statistics().ignored_markers, 1U);
}

TEST_F(MonitorOfOneTopic, IsIncompleteWhileABoxIsRejected) {
  start();
  Marker bad = cube("map", 1, 1.0);
  bad.scale.y = std::numeric_limits<double>::quiet_NaN();
  say({bad, cube("map", 2, 2.0)});
  ASSERT_TRUE(holds("2:2 "));
  expectReason({"1 box", topic_, "box 1", "'test'", "not finite", "its size"});
  say({cube("map", 1, 1.0)});
  EXPECT_TRUE(becomes(true));
  say({cube("", 1, 5.0)});
  EXPECT_TRUE(becomes(false));
  EXPECT_EQ(contents(*monitor_->scene()), "1:1 2:2 ") << "the good word stays";
  say({withAction(cube("", 1, 0.0), Marker::DELETE)});
  EXPECT_TRUE(becomes(true));
  const MonitorStatistics counts = monitor_->statistics();
  EXPECT_EQ(counts.boxes, 4U);
  EXPECT_EQ(counts.rejected_boxes, 2U);
  EXPECT_EQ(counts.rejections.size(), 2U);
}

TEST_F(MonitorOfOneTopic, EndsLifetimes) {
  start();
  Marker mortal = cube("map", 1, 1.0);
  mortal.lifetime = ros::Duration(2.0);
  say({mortal, cube("map", 2, 2.0)});
  ASSERT_TRUE(hasBoxes(*monitor_, 2));
  EXPECT_TRUE(holds("2:2 "));
  EXPECT_EQ(monitor_->statistics().expired_boxes, 1U);
  EXPECT_TRUE(completenessOf(*monitor_).complete);
}

TEST_F(MonitorOfOneTopic, BuildsNothingThatNobodyAsksFor) {
  start();
  constexpr std::uint64_t kMessages = 20;
  for (std::uint64_t n = 0; n < kMessages; ++n) {
    say({cube("map", 1, static_cast<double>(n))});
  }
  ASSERT_TRUE(eventually([&] { return monitor_->statistics().messages == kMessages; }));
  EXPECT_EQ(monitor_->statistics().builds, 0U);
  EXPECT_EQ(monitor_->scene()->scene.size(), 0U) << "scene() does not build";
  EXPECT_EQ(contents(*monitor_->currentScene()), "1:19 ");
  EXPECT_EQ(monitor_->statistics().builds, 1U);
  EXPECT_EQ(monitor_->statistics().avoided_builds, kMessages - 1);
}

TEST_F(MonitorOfOneTopic, BuildsAheadWhileSomebodyAsks) {
  parameters_.build_ahead = 60.0;
  start();
  monitor_->currentScene();
  say({cube("map", 1, 1.0)});
  EXPECT_TRUE(eventually([&] { return contents(*monitor_->scene()) == "1:1 "; }));
}

TEST_F(MonitorOfOneTopic, SharesTheSceneOfBoxesThatAreSentAgain) {
  start();
  Marker box = cube("map", 1, 1.0);
  box.header.stamp = ros::Time(10);
  say({box});
  ASSERT_TRUE(hasBoxes(*monitor_, 1));
  const SnapshotPtr before = monitor_->currentScene();
  box.header.stamp = ros::Time(11);
  say({box});
  ASSERT_TRUE(eventually([&] { return monitor_->currentScene()->stamp == ros::Time(11); }));
  const SnapshotPtr after = monitor_->currentScene();
  EXPECT_EQ(&after->scene.boxes(), &before->scene.boxes());
  EXPECT_GT(after->id, before->id);
  EXPECT_EQ(before->stamps[0], ros::Time(10)) << "snapshots do not change";
  EXPECT_EQ(after->stamps[0], ros::Time(11));
  EXPECT_EQ(monitor_->statistics().builds, 1U);
  EXPECT_EQ(monitor_->currentScene(), after) << "nothing has happened";
}

TEST_F(MonitorOfOneTopic, RefitsWhereSomeOfManyBoxesMove) {
  start();
  std::vector<Marker> boxes;
  for (int id = 0; id < 2000; ++id) {
    boxes.push_back(cube("map", id, 2.0 * id));
  }
  say(boxes);
  ASSERT_TRUE(hasBoxes(*monitor_, 2000));
  EXPECT_EQ(monitor_->statistics().refits, 0U);
  say({withAction(cube("map", 3, 0.0), Marker::DELETE), cube("map", 7, 14.5),
       cube("map", 3000, 9.0)});
  ASSERT_TRUE(eventually([&] { return monitor_->statistics().messages == 2; }));
  const SnapshotPtr after = monitor_->currentScene();
  EXPECT_EQ(after->scene.update().moved, 1U);
  EXPECT_EQ(after->scene.update().added, 1U);
  EXPECT_EQ(after->scene.update().removed, 1U);
  EXPECT_EQ(monitor_->statistics().refits, 1U);
  const Hit hit = after->scene.cast({{14.5, -5.0, 0.0}, {0.0, 1.0, 0.0}});
  ASSERT_TRUE(hit.hit);
  EXPECT_EQ(after->names[hit.box].id, 7);
  EXPECT_EQ(hit.range, 4.5);
}

TEST_F(MonitorOfOneTopic, KeepsOnlyTheLastSnapshots) {
  parameters_.kept_scenes = 2;
  start();
  std::vector<std::uint64_t> ids;
  for (int id = 1; id <= 3; ++id) {
    say({cube("map", id, 1.0)});
    ASSERT_TRUE(eventually(
        [&] { return monitor_->statistics().messages == static_cast<std::uint64_t>(id); }));
    ids.push_back(monitor_->currentScene()->id);
  }
  EXPECT_EQ(monitor_->sceneById(ids[0]), nullptr);
  ASSERT_NE(monitor_->sceneById(ids[1]), nullptr);
  EXPECT_EQ(monitor_->sceneById(ids[1])->scene.size(), 2U);
  EXPECT_EQ(monitor_->sceneById(ids[2])->scene.size(), 3U);
}

TEST_F(MonitorOfOneTopic, KeepsOnlySoManyBoxesInSnapshots) {
  parameters_.max_kept_boxes = 5;
  start();
  std::vector<std::uint64_t> ids;
  for (int id = 1; id <= 6; ++id) {
    say({cube("map", id, 1.0)});
    ASSERT_TRUE(hasBoxes(*monitor_, static_cast<std::size_t>(id)));
    ids.push_back(monitor_->currentScene()->id);
    EXPECT_NE(monitor_->sceneById(ids.back()), nullptr) << "the latest stays, however large";
    if (id == 3) {
      EXPECT_EQ(monitor_->sceneById(ids[0]), nullptr);
      EXPECT_NE(monitor_->sceneById(ids[1]), nullptr) << "2 + 3 boxes fit";
    }
  }
  EXPECT_EQ(monitor_->sceneById(ids[4]), nullptr);
}

TEST_F(MonitorOfOneTopic, TellsOfChangesAndOfNothingElse) {
  start();
  std::atomic<int> calls{0};
  std::atomic<std::size_t> seen{0};
  monitor_->setChangedCallback([&] {
    ++calls;
    seen = monitor_->currentScene()->scene.size();
  });
  say({cube("map", 1, 1.0)});
  ASSERT_TRUE(eventually([&] { return seen == 1U; }));
  EXPECT_EQ(calls, 1);
  say({cube("map", 1, 1.0)});
  say({cube("map", 2, 2.0)});
  ASSERT_TRUE(eventually([&] { return seen == 2U; }));
  EXPECT_EQ(calls, 2) << "the same box again is no change";
  monitor_->setChangedCallback(nullptr);
  say({cube("map", 3, 3.0)});
  ASSERT_TRUE(hasBoxes(*monitor_, 3));
  EXPECT_EQ(calls, 2);
}

TEST_F(MonitorOfOneTopic, PromptSceneDoesNotWaitForTheWorker) {
  start();
  std::atomic<bool> released{false};
  std::atomic<bool> held{false};
  monitor_->setChangedCallback([&] {
    held = true;
    while (!released) {
      std::this_thread::yield();
    }
  });
  monitor_->scene();  // from now on scenes are built ahead
  say({cube("map", 1, 1.0)});
  ASSERT_TRUE(eventually([&] { return held.load(); }));
  say({cube("map", 2, 2.0)});
  ASSERT_TRUE(eventually([&] { return monitor_->statistics().boxes == 2U; }));
  EXPECT_EQ(contents(*monitor_->promptScene()), "1:1 ") << "nobody has built the second one";
  EXPECT_EQ(contents(*monitor_->currentScene()), "1:1 2:2 ");
  EXPECT_EQ(contents(*monitor_->promptScene()), "1:1 2:2 ");
  released = true;
  monitor_->setChangedCallback(nullptr);
  say({cube("map", 3, 3.0)});
  EXPECT_TRUE(eventually([&] { return contents(*monitor_->promptScene()) == "1:1 2:2 3:3 "; }));
}

TEST_F(MonitorOfOneTopic, PromptSceneIsTheNewestAfterASilence) {
  parameters_.build_ahead = 0.0;
  start();
  for (int id = 1; id <= 3; ++id) {
    say({cube("map", id, 1.0)});
    ASSERT_TRUE(eventually(
        [&] { return monitor_->statistics().messages == static_cast<std::uint64_t>(id); }));
    EXPECT_EQ(monitor_->promptScene()->scene.size(), static_cast<std::size_t>(id));
  }
}

TEST_F(MonitorOfOneTopic, ShowsEveryMessageWholeOrNotAtAll) {
  start();
  std::atomic<bool> stop{false};
  std::atomic<int> torn{0};
  std::atomic<int> looks{0};
  std::vector<std::thread> readers;
  for (int reader = 0; reader < 3; ++reader) {
    readers.emplace_back([&] {
      std::uint64_t last = 0;
      while (!stop) {
        const SnapshotPtr snapshot = monitor_->currentScene();
        torn += snapshot->id < last;
        last = snapshot->id;
        for (std::size_t i = 0; i < snapshot->scene.size(); ++i) {
          torn += boxOf(*snapshot, i).center.x() != boxOf(*snapshot, 0).center.x();
        }
        ++looks;
      }
    });
  }
  constexpr std::uint64_t kMessages = 200;
  for (std::uint64_t n = 1; n <= kMessages; ++n) {
    std::vector<Marker> markers;
    for (int id = 0; id < 20; ++id) {
      markers.push_back(cube("map", id, static_cast<double>(n)));
    }
    say(markers);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(eventually([&] { return monitor_->statistics().messages == kMessages; }));
  stop = true;
  for (std::thread& reader : readers) {
    reader.join();
  }
  EXPECT_EQ(torn, 0);
  EXPECT_GT(looks, 100);
  EXPECT_EQ(boxOf(*monitor_->currentScene(), 0).center.x(), static_cast<double>(kMessages));
}

}  // namespace
}  // namespace box_query

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_scene_monitor");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
