// SPDX-License-Identifier: BSD-3-Clause
// The ROS clock goes back while boxes come, or stands.
#include "ros/box_tracker.h"

#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <tf2/buffer_core.h>

namespace box_query {
namespace {

using Clock = BoxTracker::Clock;

const ros::Time kBefore(500);
const ros::Time kNow(50);

BoxChange boxAt(std::int64_t id, double x, const ros::Time& stamp,
                const std::string& frame = "map") {
  BoxChange change;
  change.ns = "a";
  change.id = id;
  change.frame = frame;
  change.stamp = stamp;
  change.add(id, Vector3(x, 0.0, 0.0), Quaternion::Identity(), Vector3::Ones());
  return change;
}

class ClockThatGoesBack : public testing::Test {
 protected:
  void say(BoxChanges changes, const ros::Time& now = kBefore) {
    DecodedMessage message;
    message.changes = std::move(changes);
    tracker_.receive(0, &boxSources().front(), std::move(message), now);
  }

  void turnBack(Clock::duration after = Clock::duration::zero()) {
    tracker_.turnClockBack(kBefore, kNow, Clock::now() + after);
  }

  /// "id:x" of every box.
  std::string contents() {
    const Draft draft = tracker_.draft();
    std::string text;
    for (std::size_t i = 0; i < draft.boxes.size(); ++i) {
      text += std::to_string(draft.snapshot.names[i].id) + ":" +
              std::to_string(std::lround(std::get<OrientedBox>(draft.boxes[i]).center.x())) + " ";
    }
    return text;
  }

  void learn(const std::string& frame, const ros::Time& stamp, double x) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = "map";
    transform.header.stamp = stamp;
    transform.child_frame_id = frame;
    transform.transform.translation.x = x;
    transform.transform.rotation.w = 1.0;
    tf_.setTransform(transform, "test");
  }

  tf2::BufferCore tf_{ros::Duration(1000)};
  BoxTracker tracker_{Parameters(), tf_};
};

TEST_F(ClockThatGoesBack, LeavesOnlyWhatIsOfTheNewTime) {
  say({boxAt(1, 1, kBefore), boxAt(2, 2, ros::Time()), boxAt(3, 3, kNow),
       boxAt(4, 4, kNow + ros::Duration(0.1)), boxAt(5, 5, kBefore - ros::Duration(1))});
  ASSERT_EQ(contents(), "1:1 2:2 3:3 4:4 5:5 ");
  turnBack();
  EXPECT_EQ(contents(), "3:3 4:4 ");
  const Snapshot snapshot = tracker_.draft().snapshot;
  EXPECT_TRUE(snapshot.topics[0].heard);
  EXPECT_EQ(snapshot.topics[0].last_message, kNow);
  EXPECT_EQ(snapshot.stamp, kNow + ros::Duration(0.1));
}

TEST_F(ClockThatGoesBack, LeavesNothingThatCameLongBefore) {
  say({boxAt(1, 1, kNow)});
  ASSERT_EQ(contents(), "1:1 ");
  turnBack(std::chrono::milliseconds(500));
  EXPECT_EQ(contents(), "");
  EXPECT_FALSE(tracker_.draft().snapshot.topics[0].heard);
}

TEST_F(ClockThatGoesBack, LeavesNothingWithoutAStampAndCallsItNotHeard) {
  say({boxAt(1, 1, ros::Time())});
  ASSERT_EQ(contents(), "1:1 ");
  ASSERT_TRUE(tracker_.draft().snapshot.completeness(kBefore).complete);
  turnBack();
  EXPECT_EQ(contents(), "");
  EXPECT_EQ(tracker_.draft().snapshot.completeness(kNow).reason,
            "No boxes have come on topic boxes: start what publishes them, or correct "
            "~box_topics.");
}

TEST_F(ClockThatGoesBack, LetsLifetimesBeginThen) {
  BoxChange mortal = boxAt(1, 1, kNow);
  mortal.lifetime = 1500000000;
  say({mortal});
  turnBack();
  tracker_.expire(ros::Time(51, 499999999));
  EXPECT_EQ(contents(), "1:1 ");
  tracker_.expire(ros::Time(51, 500000000));
  EXPECT_EQ(contents(), "");
}

TEST_F(ClockThatGoesBack, ForgetsWhatWaitedAndWhereABoxWasBefore) {
  learn("cart", kBefore, 100.0);
  say({boxAt(1, 1, kBefore, "cart"), boxAt(2, 2, kBefore, "other")});
  ASSERT_EQ(contents(), "1:101 ");
  say({boxAt(1, 3, kNow, "cart")});
  tf_.clear();
  turnBack();
  EXPECT_EQ(contents(), "") << "its new word waits for the transform of the new time";
  EXPECT_EQ(tracker_.draft().snapshot.topics[0].waiting, 1U);
  learn("cart", kNow, 200.0);
  learn("other", kBefore, 300.0);
  tracker_.settle(Clock::now());
  EXPECT_EQ(contents(), "1:203 ");
}

TEST_F(ClockThatGoesBack, IsNotKnownOnceNobodyPublishesIt) {
  say({boxAt(1, 1, kBefore)});
  const std::uint64_t before = tracker_.changes();
  tracker_.setClockGone(false);
  EXPECT_EQ(tracker_.changes(), before);
  EXPECT_TRUE(tracker_.draft().snapshot.completeness(kBefore).complete);
  tracker_.setClockGone(true);
  EXPECT_GT(tracker_.changes(), before);
  EXPECT_EQ(tracker_.draft().snapshot.completeness(kBefore).reason,
            "Nobody publishes /clock any more, and the time stands at 500.000000000: start what "
            "publishes it.");
  EXPECT_EQ(contents(), "1:1 ");
  tracker_.setClockGone(false);
  EXPECT_TRUE(tracker_.draft().snapshot.completeness(kBefore).complete);
}

}  // namespace
}  // namespace box_query
