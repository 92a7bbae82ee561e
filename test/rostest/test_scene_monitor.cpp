// SPDX-License-Identifier: BSD-3-Clause
// Boxes in the fixed frame, from publishers through the real master into snapshots.
#include "rostest/monitor_fixture.h"
#include "rostest/raw_message.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>

#include <ros/init.h>
#include <ros/master.h>
#include <std_msgs/String.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace box_query {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

/// "id:x" of every box, in order.
std::string contents(const Snapshot& snapshot) {
  std::string text;
  for (std::size_t i = 0; i < snapshot.names.size(); ++i) {
    text += std::to_string(snapshot.names[i].id) + ":" +
            std::to_string(std::lround(boxOf(snapshot, i).center.x())) + " ";
  }
  return text;
}

bool holds(SceneMonitor& monitor, const std::string& expected) {
  return eventually([&] { return contents(*monitor.currentScene()) == expected; });
}

/// Calls the master in the name of another node, with its own name, a topic and so on.
void tellMaster(const std::string& method, const std::vector<std::string>& arguments) {
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue payload;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    request[static_cast<int>(i)] = arguments[i];
  }
  EXPECT_TRUE(ros::master::execute(method, request, response, payload, false)) << method;
}

bool becomes(SceneMonitor& monitor, bool complete) {
  return eventually([&] { return completenessOf(monitor).complete == complete; });
}

TEST(SceneMonitor, KnowsNothingBeforeTheFirstMessage) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"silent"}));
  const SnapshotPtr snapshot = monitor.currentScene();
  EXPECT_EQ(snapshot->scene.size(), 0U);
  const Completeness known = snapshot->completeness(ros::Time::now());
  EXPECT_FALSE(known.complete);
  EXPECT_NE(known.reason.find("/silent"), std::string::npos) << known.reason;
  EXPECT_TRUE(std::isinf(snapshot->age(ros::Time::now())));
}

TEST(SceneMonitor, NeedsNoWordFromTopicsThatAreNotRequired) {
  Parameters parameters = listenTo({"optional"});
  parameters.box_topics[0].required = false;
  SceneMonitor monitor(ros::NodeHandle(), parameters);
  EXPECT_TRUE(completenessOf(monitor).complete);
}

TEST(SceneMonitor, RefusesToListenTwiceToATopic) {
  EXPECT_THROW(SceneMonitor(ros::NodeHandle(), listenTo({"twice", "/twice"})),
               std::invalid_argument);
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

TEST(SceneMonitor, HearsSingleMarkersAndLists) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"single"}));
  Talker<Marker> talker("single");
  ASSERT_TRUE(talker.isHeard());
  Marker list = cube("map", 5, 10.0);
  list.type = Marker::CUBE_LIST;
  list.points.resize(2);
  list.points[1].x = 1.0;
  talker.say(list);
  talker.say(cube("map", 6, 3.0));
  EXPECT_TRUE(holds(monitor, "5:10 6:3 4294967301:11 ")) << contents(*monitor.currentScene());
  talker.say(withAction(list, Marker::DELETE));
  EXPECT_TRUE(holds(monitor, "6:3 "));
}

TEST(SceneMonitor, DeletesOnOneTopicOnly) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"b_topic", "a_topic"}));
  ArrayTalker a("a_topic");
  ArrayTalker b("b_topic");
  ASSERT_TRUE(a.isHeard() && b.isHeard());
  b.say(array({cube("map", 1, 1.0), cube("map", 2, 2.0)}));
  ASSERT_TRUE(hasBoxes(monitor, 2));
  EXPECT_FALSE(completenessOf(monitor).complete) << "a_topic was not heard";
  a.say(array({cube("map", 2, 4.0), cube("map", 1, 3.0)}));
  EXPECT_TRUE(holds(monitor, "1:3 2:4 1:1 2:2 ")) << "ordered by topic, then id";
  EXPECT_EQ(monitor.scene()->topics[0].parameters.topic, "/b_topic") << "in the parameter's order";
  EXPECT_TRUE(completenessOf(monitor).complete);
  b.say(array({withAction(cube("", 1, 0.0), Marker::DELETE)}));
  EXPECT_TRUE(holds(monitor, "1:3 2:4 2:2 "));
  b.say(array({withAction(cube("", 0, 0.0), Marker::DELETEALL), cube("map", 9, 9.0)}));
  EXPECT_TRUE(holds(monitor, "1:3 2:4 9:9 "));
  Marker sphere = cube("map", 2, 0.0);
  sphere.type = Marker::SPHERE;
  a.say(array({sphere}));
  EXPECT_TRUE(holds(monitor, "1:3 9:9 "));
  EXPECT_EQ(monitor.statistics().ignored_markers, 1U);
}

TEST(SceneMonitor, IsIncompleteWhileABoxIsRejected) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"rejected"}));
  ArrayTalker talker("rejected");
  ASSERT_TRUE(talker.isHeard());
  Marker bad = cube("map", 1, 1.0);
  bad.scale.y = std::numeric_limits<double>::quiet_NaN();
  talker.say(array({bad, cube("map", 2, 2.0)}));
  ASSERT_TRUE(holds(monitor, "2:2 "));
  const Completeness known = completenessOf(monitor);
  EXPECT_FALSE(known.complete);
  for (const char* word : {"1 box", "/rejected", "box 1", "'test'", "not finite", "its size"}) {
    EXPECT_NE(known.reason.find(word), std::string::npos) << word << " in " << known.reason;
  }
  talker.say(array({cube("map", 1, 1.0)}));
  EXPECT_TRUE(becomes(monitor, true));
  talker.say(array({cube("", 1, 5.0)}));
  EXPECT_TRUE(becomes(monitor, false));
  EXPECT_EQ(contents(*monitor.scene()), "1:1 2:2 ") << "the good word stays";
  talker.say(array({withAction(cube("", 1, 0.0), Marker::DELETE)}));
  EXPECT_TRUE(becomes(monitor, true));
  const MonitorStatistics counts = monitor.statistics();
  EXPECT_EQ(counts.boxes, 4U);
  EXPECT_EQ(counts.rejected_boxes, 2U);
  EXPECT_EQ(counts.rejections.size(), 2U);
}

TEST(SceneMonitor, EndsLifetimes) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"lifetime"}));
  ArrayTalker talker("lifetime");
  ASSERT_TRUE(talker.isHeard());
  Marker mortal = cube("map", 1, 1.0);
  mortal.lifetime = ros::Duration(2.0);
  talker.say(array({mortal, cube("map", 2, 2.0)}));
  ASSERT_TRUE(hasBoxes(monitor, 2));
  EXPECT_TRUE(holds(monitor, "2:2 "));
  EXPECT_EQ(monitor.statistics().expired_boxes, 1U);
  EXPECT_TRUE(completenessOf(monitor).complete);
}

TEST(SceneMonitor, GoesStaleAndRecovers) {
  Parameters parameters = listenTo({"stale"});
  parameters.box_topics[0].timeout = 1.0;
  SceneMonitor monitor(ros::NodeHandle(), parameters);
  ArrayTalker talker("stale");
  ASSERT_TRUE(talker.isHeard());
  talker.say(array({cube("map", 1, 1.0)}));
  ASSERT_TRUE(becomes(monitor, true));
  ASSERT_TRUE(becomes(monitor, false));
  EXPECT_NE(completenessOf(monitor).reason.find("/stale is stale"), std::string::npos);
  talker.say(array({}));
  EXPECT_TRUE(becomes(monitor, true)) << "an empty message is a sign of life";
  EXPECT_EQ(contents(*monitor.currentScene()), "1:1 ");
}

TEST(SceneMonitor, HearsARestartedPublisher) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"restarted"}));
  for (const double x : {1.0, 2.0}) {
    ArrayTalker talker("restarted");
    ASSERT_TRUE(talker.isHeard());
    talker.say(array({cube("map", 1, x)}));
    ASSERT_TRUE(holds(monitor, "1:" + std::to_string(std::lround(x)) + " "));
  }
}

TEST(SceneMonitor, NamesATypeThatItDoesNotKnowAndHearsTheNextPublisher) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"typed"}));
  {
    Talker<std_msgs::String> talker("typed");
    ASSERT_TRUE(talker.isHeard());
    talker.say(std_msgs::String());
    ASSERT_TRUE(eventually([&] { return monitor.statistics().unknown_type_messages == 1; }));
    const std::string reason = completenessOf(monitor).reason;
    for (const char* word : {"/typed", "std_msgs/String", "visualization_msgs/MarkerArray"}) {
      EXPECT_NE(reason.find(word), std::string::npos) << word << " in " << reason;
    }
  }
  Talker<MarkerArray> talker("typed");
  ASSERT_TRUE(talker.isHeard()) << "the subscription must not stay pinned to the first type";
  talker.say(array({cube("map", 1, 1.0)}));
  EXPECT_TRUE(holds(monitor, "1:1 "));
  EXPECT_TRUE(completenessOf(monitor).complete);
}

TEST(SceneMonitor, IsIncompleteWhileAPublisherOfAnotherTypeCannotBeHeard) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"two_types"}));
  ArrayTalker talker("two_types");
  ASSERT_TRUE(talker.isHeard());
  talker.say(array({cube("map", 1, 1.0)}));
  ASSERT_TRUE(becomes(monitor, true));
  // This process may not advertise a second type itself. The master tells only the type of whoever
  // came last, here that of the one that is heard.
  tellMaster("registerPublisher",
             {"/second", "/two_types", "std_msgs/String", "http://127.0.0.1:1/"});
  ASSERT_TRUE(becomes(monitor, false));
  EXPECT_NE(completenessOf(monitor).reason.find("std_msgs/String"), std::string::npos)
      << completenessOf(monitor).reason;
  tellMaster("registerPublisher",
             {"/third", "/two_types", "visualization_msgs/MarkerArray", "http://127.0.0.1:2/"});
  EXPECT_TRUE(eventually([&] {
    return completenessOf(monitor).reason.find("2 of the publishers of topic /two_types") == 0;
  })) << completenessOf(monitor).reason;
  tellMaster("unregisterPublisher", {"/second", "/two_types", "http://127.0.0.1:1/"});
  tellMaster("unregisterPublisher", {"/third", "/two_types", "http://127.0.0.1:2/"});
  EXPECT_TRUE(becomes(monitor, true));
}

TEST(SceneMonitor, RefusesMalformedMessagesWhole) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"malformed"}));
  Talker<RawMarkerArray> talker("malformed");
  ASSERT_TRUE(talker.isHeard());
  const std::vector<std::uint8_t> good = RawMarkerArray::of(array({cube("map", 1, 1.0)})).bytes;
  RawMarkerArray claims;
  claims.bytes = {0x00, 0x28, 0x6b, 0xee};  // 4,000,000,000 markers
  RawMarkerArray cut;
  cut.bytes.assign(good.begin(), good.end() - 1);
  RawMarkerArray empty;
  std::uint64_t refused = 0;
  for (const RawMarkerArray& bad : {claims, cut, empty}) {
    talker.say(bad);
    ++refused;
    ASSERT_TRUE(eventually([&] { return monitor.statistics().malformed_messages == refused; }));
    const std::string reason = completenessOf(monitor).reason;
    EXPECT_NE(reason.find("/malformed was refused"), std::string::npos) << reason;
  }
  EXPECT_EQ(monitor.statistics().boxes, 0U);
  talker.say(RawMarkerArray::of(array({cube("map", 1, 1.0)})));
  EXPECT_TRUE(holds(monitor, "1:1 "));
  EXPECT_TRUE(completenessOf(monitor).complete);
}

TEST(SceneMonitor, RefusesMessagesWithTooManyBoxesWhole) {
  Parameters parameters = listenTo({"many"});
  parameters.max_boxes_per_message = 2;
  SceneMonitor monitor(ros::NodeHandle(), parameters);
  ArrayTalker talker("many");
  ASSERT_TRUE(talker.isHeard());
  talker.say(array({cube("map", 1, 1.0), cube("map", 2, 2.0)}));
  ASSERT_TRUE(hasBoxes(monitor, 2));
  talker.say(array({cube("map", 3, 1.0), cube("map", 4, 2.0), cube("map", 5, 3.0)}));
  ASSERT_TRUE(becomes(monitor, false));
  EXPECT_EQ(contents(*monitor.currentScene()), "1:1 2:2 ");
}

TEST(SceneMonitor, BuildsNothingThatNobodyAsksFor) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"lazy"}));
  ArrayTalker talker("lazy");
  ASSERT_TRUE(talker.isHeard());
  constexpr std::uint64_t kMessages = 20;
  for (std::uint64_t n = 0; n < kMessages; ++n) {
    talker.say(array({cube("map", 1, static_cast<double>(n))}));
  }
  ASSERT_TRUE(eventually([&] { return monitor.statistics().messages == kMessages; }));
  EXPECT_EQ(monitor.statistics().builds, 0U);
  EXPECT_EQ(monitor.scene()->scene.size(), 0U) << "scene() does not build";
  EXPECT_EQ(contents(*monitor.currentScene()), "1:19 ");
  EXPECT_EQ(monitor.statistics().builds, 1U);
  EXPECT_EQ(monitor.statistics().avoided_builds, kMessages - 1);
}

TEST(SceneMonitor, BuildsAheadWhileSomebodyAsks) {
  Parameters parameters = listenTo({"ahead"});
  parameters.build_ahead = 60.0;
  SceneMonitor monitor(ros::NodeHandle(), parameters);
  ArrayTalker talker("ahead");
  ASSERT_TRUE(talker.isHeard());
  monitor.currentScene();
  talker.say(array({cube("map", 1, 1.0)}));
  EXPECT_TRUE(eventually([&] { return contents(*monitor.scene()) == "1:1 "; }));
}

TEST(SceneMonitor, SharesTheSceneOfBoxesThatAreSentAgain) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"again"}));
  ArrayTalker talker("again");
  ASSERT_TRUE(talker.isHeard());
  Marker box = cube("map", 1, 1.0);
  box.header.stamp = ros::Time(10);
  talker.say(array({box}));
  ASSERT_TRUE(hasBoxes(monitor, 1));
  const SnapshotPtr before = monitor.currentScene();
  box.header.stamp = ros::Time(11);
  talker.say(array({box}));
  ASSERT_TRUE(eventually([&] { return monitor.currentScene()->stamp == ros::Time(11); }));
  const SnapshotPtr after = monitor.currentScene();
  EXPECT_EQ(&after->scene.boxes(), &before->scene.boxes());
  EXPECT_GT(after->id, before->id);
  EXPECT_EQ(before->stamps[0], ros::Time(10)) << "snapshots do not change";
  EXPECT_EQ(after->stamps[0], ros::Time(11));
  EXPECT_EQ(monitor.statistics().builds, 1U);
  EXPECT_EQ(monitor.currentScene(), after) << "nothing has happened";
}

TEST(SceneMonitor, KeepsOnlyTheLastSnapshots) {
  Parameters parameters = listenTo({"kept"});
  parameters.kept_scenes = 2;
  SceneMonitor monitor(ros::NodeHandle(), parameters);
  ArrayTalker talker("kept");
  ASSERT_TRUE(talker.isHeard());
  std::vector<std::uint64_t> ids;
  for (int id = 1; id <= 3; ++id) {
    talker.say(array({cube("map", id, 1.0)}));
    ASSERT_TRUE(eventually(
        [&] { return monitor.statistics().messages == static_cast<std::uint64_t>(id); }));
    ids.push_back(monitor.currentScene()->id);
  }
  EXPECT_EQ(monitor.sceneById(ids[0]), nullptr);
  ASSERT_NE(monitor.sceneById(ids[1]), nullptr);
  EXPECT_EQ(monitor.sceneById(ids[1])->scene.size(), 2U);
  EXPECT_EQ(monitor.sceneById(ids[2])->scene.size(), 3U);
}

TEST(SceneMonitor, KeepsOnlySoManyBoxesInSnapshots) {
  Parameters parameters = listenTo({"kept_boxes"});
  parameters.max_kept_boxes = 5;
  SceneMonitor monitor(ros::NodeHandle(), parameters);
  ArrayTalker talker("kept_boxes");
  ASSERT_TRUE(talker.isHeard());
  std::vector<std::uint64_t> ids;
  for (int id = 1; id <= 6; ++id) {
    talker.say(array({cube("map", id, 1.0)}));
    ASSERT_TRUE(hasBoxes(monitor, static_cast<std::size_t>(id)));
    ids.push_back(monitor.currentScene()->id);
    EXPECT_NE(monitor.sceneById(ids.back()), nullptr) << "the latest stays, however large";
    if (id == 3) {
      EXPECT_EQ(monitor.sceneById(ids[0]), nullptr);
      EXPECT_NE(monitor.sceneById(ids[1]), nullptr) << "2 + 3 boxes fit";
    }
  }
  EXPECT_EQ(monitor.sceneById(ids[4]), nullptr);
}

TEST(SceneMonitor, TellsOfChangesAndOfNothingElse) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"told"}));
  ArrayTalker talker("told");
  ASSERT_TRUE(talker.isHeard());
  std::atomic<int> calls{0};
  std::atomic<std::size_t> seen{0};
  monitor.setChangedCallback([&] {
    ++calls;
    seen = monitor.currentScene()->scene.size();
  });
  talker.say(array({cube("map", 1, 1.0)}));
  ASSERT_TRUE(eventually([&] { return seen == 1U; }));
  EXPECT_EQ(calls, 1);
  talker.say(array({cube("map", 1, 1.0)}));
  talker.say(array({cube("map", 2, 2.0)}));
  ASSERT_TRUE(eventually([&] { return seen == 2U; }));
  EXPECT_EQ(calls, 2) << "the same box again is no change";
  monitor.setChangedCallback(nullptr);
  talker.say(array({cube("map", 3, 3.0)}));
  ASSERT_TRUE(hasBoxes(monitor, 3));
  EXPECT_EQ(calls, 2);
}

TEST(SceneMonitor, ShowsEveryMessageWholeOrNotAtAll) {
  SceneMonitor monitor(ros::NodeHandle(), listenTo({"whole"}));
  ArrayTalker talker("whole");
  ASSERT_TRUE(talker.isHeard());
  std::atomic<bool> stop{false};
  std::atomic<int> torn{0};
  std::atomic<int> looks{0};
  std::vector<std::thread> readers;
  for (int reader = 0; reader < 3; ++reader) {
    readers.emplace_back([&] {
      std::uint64_t last = 0;
      while (!stop) {
        const SnapshotPtr snapshot = monitor.currentScene();
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
    talker.say(array(markers));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(eventually([&] { return monitor.statistics().messages == kMessages; }));
  stop = true;
  for (std::thread& reader : readers) {
    reader.join();
  }
  EXPECT_EQ(torn, 0);
  EXPECT_GT(looks, 100);
  EXPECT_EQ(boxOf(*monitor.currentScene(), 0).center.x(), static_cast<double>(kMessages));
}

TEST(SceneMonitor, DiesAtAnyMoment) {
  ArrayTalker talker("dying");
  Talker<tf2_msgs::TFMessage> tf("/tf");
  std::atomic<bool> stop{false};
  std::thread chatter([&] {
    for (int n = 0; !stop; ++n) {
      talker.say(array({cube("map", n % 50, 1.0), cube("nowhere", 60 + n % 50, 1.0)}));
      tf.say(transform("map", "dying_frame", ros::Time(10 + n, 0), 1.0));
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
  });
  for (int round = 0; round < 12; ++round) {
    SceneMonitor monitor(ros::NodeHandle(), listenTo({"dying"}));
    monitor.setChangedCallback([&monitor] { monitor.currentScene(); });
    if (round % 3 != 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(7 * round));
    }
    if (round % 3 == 2) {
      EXPECT_TRUE(eventually([&] { return monitor.scene()->scene.size() > 0; }));
    }
  }
  stop = true;
  chatter.join();
}

}  // namespace
}  // namespace box_query

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_scene_monitor");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
