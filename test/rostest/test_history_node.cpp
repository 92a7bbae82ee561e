// SPDX-License-Identifier: BSD-3-Clause
// Questions about the past through the services of the real node. The test is the clock.
#include "rostest/server_fixture.h"

#include <ros/init.h>
#include <rosgraph_msgs/Clock.h>

namespace box_query::test {
namespace {

using visualization_msgs::Marker;

CastRayRequest rayAt(double scene_time) {
  CastRayRequest request = ray("map", point(0, 0, 0), vector(1, 0, 0));
  request.scene_time = ros::Time(scene_time);
  return request;
}

class Past : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    clock_ = new Talker<rosgraph_msgs::Clock>("/clock");
    talker_ = new ArrayTalker("boxes");
    ASSERT_TRUE(talker_->isHeard());
  }
  static void TearDownTestSuite() {
    delete talker_;
    delete clock_;
  }

  /// The ROS time of the node is then known to be this.
  static void setTime(double seconds) {
    rosgraph_msgs::Clock message;
    message.clock = ros::Time(seconds);
    const std::string now = std::to_string(message.clock.sec) + ".";
    ASSERT_TRUE(eventually([&] {
      clock_->say(message);
      const std::string known = cast(rayAt(1e9)).message;
      return known.find(" to " + now) != std::string::npos;
    }));
  }

  /// A box whose near side is at `range` on the ray.
  static Marker boxAt(double range) { return cube("map", 1, range + 0.5); }
  static void say(const Marker& marker) { talker_->say(array({marker})); }
  static bool sees(double range) {
    return eventually([&] { return cast(rayAt(0)).range == range; });
  }
  static double rangeAt(double scene_time) {
    const CastRayResponse response = cast(rayAt(scene_time));
    EXPECT_TRUE(response.success) << response.message;
    return response.range;
  }

  static Talker<rosgraph_msgs::Clock>* clock_;
  static ArrayTalker* talker_;
};
Talker<rosgraph_msgs::Clock>* Past::clock_ = nullptr;
ArrayTalker* Past::talker_ = nullptr;

/// Runs first: a clock cannot be unset again.
TEST_F(Past, IsNotKnownBeforeTheClockHasStarted) {
  const CastRayResponse response = cast(rayAt(5));
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.message,
            "scene_time is 5.000000000, but the ROS clock has not started: publish /clock");
}

TEST_F(Past, IsAnsweredAsItWas) {
  setTime(100);
  say(boxAt(2));
  ASSERT_TRUE(sees(2));
  const CastRayResponse then = cast(rayAt(0));
  setTime(101);
  say(boxAt(4));
  ASSERT_TRUE(sees(4));
  setTime(107);
  const CastRayResponse stale = cast(rayAt(0));
  EXPECT_FALSE(stale.complete);
  EXPECT_EQ(stale.scene_age, 6);

  EXPECT_EQ(rangeAt(100), 2);
  EXPECT_EQ(rangeAt(100.999999), 2);
  EXPECT_EQ(rangeAt(101), 4);
  EXPECT_EQ(rangeAt(107), 4);
  const CastRayResponse past = cast(rayAt(100.5));
  EXPECT_EQ(past.scene_id, then.scene_id);
  EXPECT_EQ(past.scene_stamp, ros::Time(100));
  EXPECT_EQ(past.scene_age, 0.5);
  EXPECT_TRUE(past.complete) << "the topic was not stale then: " << past.reason;
  EXPECT_FALSE(cast(rayAt(106.5)).complete) << "but it was here";
  EXPECT_EQ(cast(rayAt(106)).scene_age, 5);
  EXPECT_TRUE(cast(rayAt(106)).complete);
  EXPECT_EQ(scene(then.scene_id).poses.at(0).position.x, 2.5);
}

TEST_F(Past, IsAnsweredByEveryService) {
  setTime(200);
  say(boxAt(2));
  ASSERT_TRUE(sees(2));
  setTime(201);
  say(boxAt(4));
  ASSERT_TRUE(sees(4));
  const auto at200 = [](auto request) {
    request.header.frame_id = "map";
    request.scene_time = ros::Time(200.25);
    return request;
  };
  auto rays = at200(CastRaysRequest());
  rays.origins = {point(0, 0, 0)};
  rays.directions = {vector(1, 0, 0)};
  EXPECT_EQ(call<CastRays>("cast_rays", rays).ranges, std::vector<double>{2});
  auto segment = at200(CheckSegmentRequest());
  EXPECT_EQ(checkSegment(segment).clearance, 2);
  EXPECT_TRUE(checkSegment(segment).clear);
  auto segments = at200(CheckSegmentsRequest());
  segments.points = {point(0, 0, 0), point(1, 0, 0)};
  segments.want_clearances = true;
  EXPECT_EQ(call<CheckSegments>("check_segments", segments).clearances, std::vector<double>{1});
  auto find = at200(FindIntersectionsRequest());
  find.direction = vector(1, 0, 0);
  EXPECT_EQ(call<FindIntersections>("find_intersections", find).t_enter, std::vector<double>{2});
  GetSceneRequest get;
  get.scene_time = ros::Time(200.25);
  const auto past = call<GetScene>("get_scene", get);
  EXPECT_EQ(past.poses.at(0).position.x, 2.5);
  EXPECT_EQ(past.scene_age, 0.25);
  get.scene_id = past.scene_id;
  EXPECT_EQ(call<GetScene>("get_scene", get).message,
            "scene_id and scene_time are both given: give one of them");
  get.scene_time = ros::Time();
  EXPECT_EQ(call<GetScene>("get_scene", get).scene_age, 1);
}

TEST_F(Past, EndsLifetimesToTheNanosecond) {
  setTime(300);
  Marker mortal = boxAt(3);
  mortal.lifetime = ros::Duration(1.5);
  say(mortal);
  ASSERT_TRUE(sees(3));
  setTime(305);  // nobody looked in between
  CastRayRequest request = rayAt(0);
  request.scene_time = ros::Time(301, 499999999);
  EXPECT_EQ(cast(request).range, 3);
  EXPECT_EQ(rangeAt(301.5), kInf);
}

TEST_F(Past, DropsStaleBoxesToTheNanosecond) {
  setTime(350);
  ArrayTalker talker("dropped");
  ASSERT_TRUE(talker.isHeard());
  talker.say(array({boxAt(0.25)}));
  ASSERT_TRUE(sees(0.25));
  setTime(355);
  CastRayRequest request = rayAt(351.5);
  EXPECT_EQ(cast(request).range, 0.25);
  request.scene_time.nsec += 1;
  EXPECT_NE(cast(request).range, 0.25);
}

TEST_F(Past, IsRefusedWhereItIsNotKnown) {
  setTime(400);
  say(boxAt(1));
  ASSERT_TRUE(sees(1));
  setTime(405);
  say(boxAt(2));
  ASSERT_TRUE(sees(2));
  setTime(420);
  say(boxAt(3));
  ASSERT_TRUE(sees(3));
  EXPECT_EQ(rangeAt(410), 2) << "the scene of ten seconds ago";
  const CastRayResponse early = cast(rayAt(404.5));
  EXPECT_FALSE(early.success);
  EXPECT_EQ(early.message,
            "scene_time is 404.500000000, but scenes are known from 405.000000000 to "
            "420.000000000, now: ask for one of these, for 0 (now), or raise ~history, "
            "~max_past_scenes or ~max_history_memory");
  EXPECT_TRUE(std::isnan(early.range));
  EXPECT_NE(cast(rayAt(420.000000001)).message.find("from 405.000000000 to"), std::string::npos);
  CastRayRequest garbage = rayAt(0);
  garbage.scene_time.sec = 4294967295U;
  garbage.scene_time.nsec = 4294967295U;
  EXPECT_FALSE(cast(garbage).success);
  garbage.scene_time.sec = 416;
  garbage.scene_time.nsec = 1000000000U;
  EXPECT_FALSE(cast(garbage).success) << "no second has so many nanoseconds";
  garbage.scene_time.nsec = 999999999U;
  EXPECT_EQ(cast(garbage).range, 2);
}

TEST_F(Past, HasAtMostSoManyScenes) {
  for (int i = 0; i < 9; ++i) {
    setTime(500 + i);
    say(boxAt(1 + i));
    ASSERT_TRUE(sees(1 + i));
  }
  EXPECT_EQ(rangeAt(503), 4);
  EXPECT_EQ(rangeAt(508), 9);
  EXPECT_NE(cast(rayAt(502)).message.find("from 503.000000000 to 508.000000000"),
            std::string::npos);
}

TEST_F(Past, IsForgottenWhenTimeGoesBack) {
  setTime(600);
  say(boxAt(1));
  ASSERT_TRUE(sees(1));
  setTime(50);
  EXPECT_NE(cast(rayAt(49)).message.find("from 50.000000000 to 50.000000000"), std::string::npos);
  EXPECT_EQ(rangeAt(50), kInf);
  EXPECT_FALSE(cast(rayAt(50)).complete);
  EXPECT_FALSE(cast(rayAt(600)).success);
}

}  // namespace
}  // namespace box_query::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_history_node");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
