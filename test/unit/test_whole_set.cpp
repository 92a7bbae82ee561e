// SPDX-License-Identifier: BSD-3-Clause
// Messages that carry the whole set of a topic, from the decoder into snapshots.
#include "ros/box_tracker.h"
#include "ros/whole_set.h"

#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <tf2/buffer_core.h>

namespace box_query {
namespace {

const BoxSource kSource{"test/WholeSet", "", nullptr};

struct Said {
  std::string class_name;
  double x;
  std::string frame = "map";
};

DecodedMessage wholeSet(const std::vector<Said>& boxes) {
  DecodedMessage message;
  WholeSet set(static_cast<std::uint32_t>(boxes.size()), Limits(), ros::Time(50), message);
  std::int64_t id = 0;
  for (const Said& box : boxes) {
    set.add({ros::Time(), box.frame}, box.class_name, id++, Vector3(box.x, 0.0, 0.0),
            Quaternion::Identity(), Vector3::Ones());
  }
  return message;
}

class WholeSets : public testing::Test {
 protected:
  WholeSets() : tracker_(parameters(), tf_) {}

  static Parameters parameters() {
    Parameters parameters;
    parameters.box_topics = {TopicParameters()};
    return parameters;
  }

  void say(DecodedMessage message) {
    tracker_.receive(0, &kSource, std::move(message), ros::Time(100));
  }
  void setTransform(const std::string& frame, double x) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = "map";
    transform.child_frame_id = frame;
    transform.transform.translation.x = x;
    transform.transform.rotation.w = 1.0;
    tf_.setTransform(transform, "test", true);
    tracker_.settle(BoxTracker::Clock::now());
  }

  /// "ns/id:x" of every box, in order.
  std::string contents() {
    const Draft draft = tracker_.draft();
    std::string text;
    for (std::size_t i = 0; i < draft.boxes.size(); ++i) {
      const BoxName& name = draft.snapshot.names[i];
      EXPECT_EQ(name.label, name.ns);
      text += name.ns + "/" + std::to_string(name.id) + ":" +
              std::to_string(std::lround(std::get<OrientedBox>(draft.boxes[i]).center.x())) + " ";
    }
    return text;
  }
  TopicState state() { return tracker_.draft().snapshot.topics.at(0); }

  tf2::BufferCore tf_;
  BoxTracker tracker_;
};

TEST_F(WholeSets, ReplaceWhatTheTopicSaidBefore) {
  say(wholeSet({{"car", 1}, {"bike", 2}, {"car", 3}}));
  EXPECT_EQ(contents(), "bike/1:2 car/0:1 car/2:3 ");
  say(wholeSet({{"car", 4}}));
  EXPECT_EQ(contents(), "car/0:4 ");
  say(wholeSet({}));
  EXPECT_EQ(contents(), "");
  EXPECT_EQ(tracker_.draft().snapshot.stamp, ros::Time(100)) << "that of the latest box";
}

TEST_F(WholeSets, TakeTheStampOfAnEmptyMessage) {
  say(wholeSet({}));
  EXPECT_EQ(tracker_.draft().snapshot.stamp, ros::Time(50));
}

TEST_F(WholeSets, AreNoChangeWhereTheySayTheSameAgain) {
  say(wholeSet({{"car", 1}, {"bike", 2}}));
  const std::uint64_t version = tracker_.boxesVersion();
  say(wholeSet({{"car", 1}, {"bike", 2}}));
  EXPECT_EQ(tracker_.boxesVersion(), version);
  EXPECT_EQ(contents(), "bike/1:2 car/0:1 ");
  say(wholeSet({{"car", 1}}));
  EXPECT_NE(tracker_.boxesVersion(), version);
}

TEST_F(WholeSets, StayWhileTheNextOneWaitsButForWhatIsNoLongerInIt) {
  setTransform("robot", 10);
  say(wholeSet({{"car", 1, "robot"}, {"bike", 2, "robot"}}));
  EXPECT_EQ(contents(), "bike/1:12 car/0:11 ");
  say(wholeSet({{"car", 3, "cart"}}));
  EXPECT_EQ(contents(), "car/0:11 ");
  EXPECT_EQ(state().waiting, 1U);
  setTransform("cart", 20);
  EXPECT_EQ(contents(), "car/0:23 ");
  EXPECT_EQ(state().waiting, 0U);
}

TEST_F(WholeSets, DropWaitingBoxesThatTheNextOneDoesNotHave) {
  say(wholeSet({{"car", 1, "cart"}}));
  EXPECT_EQ(state().waiting, 1U);
  say(wholeSet({{"bike", 2}}));
  EXPECT_EQ(state().waiting, 0U);
  setTransform("cart", 20);
  EXPECT_EQ(contents(), "bike/0:2 ");
}

TEST_F(WholeSets, ReplaceABoxByABadOne) {
  say(wholeSet({{"car", 1}}));
  EXPECT_EQ(contents(), "car/0:1 ");
  say(wholeSet({{"car", std::numeric_limits<double>::infinity()}}));
  EXPECT_EQ(contents(), "");
  EXPECT_EQ(state().rejected, 1U);
  say(wholeSet({}));
  EXPECT_EQ(state().rejected, 0U);
}

TEST_F(WholeSets, LoseOnlyTheBoxThatIsTooFarAway) {
  setTransform("robot", 9e6);
  say(wholeSet({{"car", 1, "robot"}, {"car", 2e6, "robot"}, {"car", 2, "robot"}}));
  EXPECT_EQ(tracker_.draft().boxes.size(), 2U);
  EXPECT_EQ(state().rejected, 1U);
  EXPECT_EQ(state().waiting, 0U);
  EXPECT_NE(state().problem.find("box 1 of namespace 'car' is too far away"), std::string::npos)
      << state().problem;
}

TEST_F(WholeSets, LeaveEqualIdsInTheirOrder) {
  DecodedMessage message;
  WholeSet set(40, Limits(), ros::Time(), message);
  for (int n = 0; n < 40; ++n) {
    set.add({ros::Time(), "map"}, "car", 7, Vector3(n, 0.0, 0.0), Quaternion::Identity(),
            Vector3::Ones());
  }
  say(std::move(message));
  const Draft draft = tracker_.draft();
  ASSERT_EQ(draft.boxes.size(), 40U);
  for (int n = 0; n < 40; ++n) {
    EXPECT_EQ(std::get<OrientedBox>(draft.boxes[static_cast<std::size_t>(n)]).center.x(), n);
  }
}

}  // namespace
}  // namespace box_query
