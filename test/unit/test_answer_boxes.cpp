// SPDX-License-Identifier: BSD-3-Clause
#include "unit/answer_fixture.h"

#include <gtest/gtest.h>

namespace box_query::test {
namespace {

using Doubles = std::vector<double>;
using Bytes = std::vector<std::uint8_t>;

FindIntersectionsRequest componentAlongX(std::uint8_t component) {
  FindIntersectionsRequest request;
  request.component = component;
  request.origin = point(4, 0, 0.5);
  request.direction = vector(2, 0, 0);
  request.end = point(8, 0, 0.5);
  return request;
}

TEST(FindIntersections, OfALineAreSortedByEntryWithSignedDistances) {
  const auto response = ask(componentAlongX(FindIntersectionsRequest::LINE), smallSnapshot());
  EXPECT_EQ(response.box_ids, (std::vector<std::int64_t>{1, 2, -1, 1}));
  EXPECT_EQ(response.box_topics.back(), "/b");
  EXPECT_EQ(response.box_labels.back(), "other");
  EXPECT_EQ(response.box_namespaces[2], "robot");
  EXPECT_EQ(response.num_points, (Bytes{2, 2, 2, 2}));
  EXPECT_EQ(response.t_enter, (Doubles{-1.25, -0.25, 0.75, 1.75}));
  EXPECT_EQ(response.t_exit, (Doubles{-0.75, 0.25, 1.25, 2.25}));
  EXPECT_EQ(response.distance_enter, (Doubles{-2.5, -0.5, 1.5, 3.5}));
  EXPECT_EQ(response.distance_exit, (Doubles{-1.5, 0.5, 2.5, 4.5}));
  EXPECT_EQ(response.started_inside, (Bytes{0, 0, 0, 0}));
  EXPECT_EQ(response.points_enter[2], point(5.5, 0, 0.5));
  EXPECT_EQ(response.points_exit[2], point(6.5, 0, 0.5));
  EXPECT_EQ(response.faces_entered[2], 1U << 0);
  EXPECT_EQ(response.faces_left[2], 1U << 1);
}

TEST(FindIntersections, OfARayAndASegmentStartAtTheirOrigin) {
  const auto ray = ask(componentAlongX(FindIntersectionsRequest::RAY), smallSnapshot());
  EXPECT_EQ(ray.t_enter, (Doubles{0, 0.75, 1.75}));
  EXPECT_EQ(ray.started_inside, (Bytes{1, 0, 0}));
  EXPECT_EQ(ray.faces_entered[0], 0U);
  const auto segment = ask(componentAlongX(FindIntersectionsRequest::SEGMENT), smallSnapshot());
  EXPECT_EQ(segment.t_enter, (Doubles{0, 0.375, 0.875}));
  EXPECT_EQ(segment.t_exit, (Doubles{0.125, 0.625, 1}));
  EXPECT_EQ(segment.distance_exit, (Doubles{0.5, 2.5, 4}));
  FindIntersectionsRequest edge = componentAlongX(FindIntersectionsRequest::SEGMENT);
  edge.origin = point(1, 0, 1);
  edge.end = point(2, 0, 0);
  edge.end.y = 1;
  edge.origin.y = 0;
  const auto touching = ask(edge, smallSnapshot());
  ASSERT_EQ(touching.num_points, Bytes{1});
  EXPECT_EQ(touching.points_enter[0], point(1.5, 0.5, 0.5));
  EXPECT_EQ(touching.t_enter, Doubles{0.5});
}

TEST(FindIntersections, DistancesAreRoundedOnceAndNotFromTheParameters) {
  // Along (1, 1, 1) the distance is an irrational multiple of the parameter.
  const Snapshot snapshot = randomSnapshot(200, 8);
  FindIntersectionsRequest request;
  request.component = FindIntersectionsRequest::RAY;
  request.origin = point(-11, -10, -9);
  request.direction = vector(1, 1, 1);
  const auto response = ask(request, snapshot);
  ASSERT_GT(response.t_enter.size(), 5U);
  CastRayRequest cast;
  cast.origin = request.origin;
  cast.direction = request.direction;
  const CastRayResponse first = ask(cast, snapshot);
  EXPECT_EQ(response.distance_enter[0], first.range);
  EXPECT_EQ(response.distance_exit[0], first.exit_range);
  EXPECT_EQ(response.box_ids[0], first.box_id);
  for (std::size_t i = 0; i < response.t_enter.size(); ++i) {
    EXPECT_NEAR(response.distance_enter[i], response.t_enter[i] * std::sqrt(3.0), 1e-13);
  }
}

TEST(FindIntersections, AnswerInTheFrameOfTheRequestAndFilter) {
  FindIntersectionsRequest request;
  request.component = FindIntersectionsRequest::LINE;
  request.origin = point(-20, 10, 0);
  request.direction = vector(0, -1, 0);
  request.namespaces = {"rack"};
  const auto response = ask(request, smallSnapshot(), quarterTurn());
  ASSERT_EQ(response.box_ids, (std::vector<std::int64_t>{1, 2, 1}));
  EXPECT_NEAR(response.points_enter[1].y, 6.5, 1e-14);
  EXPECT_NEAR(response.distance_exit[1], 4.5, 1e-14);
}

TEST(FindIntersections, AreRefusedWithASentence) {
  const auto with = [](auto change) {
    FindIntersectionsRequest request = componentAlongX(FindIntersectionsRequest::SEGMENT);
    request.header.frame_id = "map";
    request.direction = vector(0, 0, 0);
    change(request);
    return refusal(request);
  };
  EXPECT_EQ(with([](auto&) {}), "") << "a segment has no direction";
  EXPECT_EQ(with([](auto& r) { r.end.x = kNan; }), "end is (nan, 0, 0.5): give finite numbers");
  EXPECT_EQ(with([](auto& r) { r.component = FindIntersectionsRequest::LINE; }),
            "direction is zero: give a direction of any other length");
  EXPECT_EQ(with([](auto& r) { r.component = 3; }),
            "component is 3: give LINE (0), RAY (1) or SEGMENT (2)");
  EXPECT_EQ(with([](auto& r) { r.origin.x = kInf; }),
            "origin is (inf, 0, 0.5): give finite numbers");
  EXPECT_NE(with([](auto& r) { r.header.frame_id = ""; }), "");
}

TEST(FindIntersections, ThatOverflowInTheFixedFrameAreRefused) {
  for (const std::uint8_t component :
       {FindIntersectionsRequest::LINE, FindIntersectionsRequest::RAY,
        FindIntersectionsRequest::SEGMENT}) {
    FindIntersectionsRequest request = componentAlongX(component);
    request.origin = point(1e308, 1.7e308, 1.7e308);
    EXPECT_THROW(ask(request, smallSnapshot(), crookedFrame()), std::invalid_argument);
  }
}

TEST(GetScene, GivesEveryBoxInFullDoubles) {
  const Snapshot snapshot = randomSnapshot(50, 5);
  GetSceneResponse response;
  answer(GetSceneRequest(), snapshot, ros::Time(103), response);
  EXPECT_EQ(response.scene_id, 7U);
  EXPECT_EQ(response.header.frame_id, "map");
  EXPECT_EQ(response.header.stamp, ros::Time(100));
  EXPECT_EQ(response.scene_age, 3.0);
  EXPECT_TRUE(response.complete);
  ASSERT_EQ(response.poses.size(), 50U);
  for (std::size_t i = 0; i < 50; ++i) {
    const auto& box = std::get<OrientedBox>(snapshot.scene.boxes()[i]);
    const auto& q = response.poses[i].orientation;
    EXPECT_EQ(fromMessage(response.poses[i].position), box.center);
    EXPECT_EQ(Quaternion(q.w, q.x, q.y, q.z).coeffs(), box.orientation.coeffs());
    EXPECT_EQ(fromMessage(response.sizes[i]), 2 * box.half_extents);
    EXPECT_EQ(response.stamps[i], ros::Time(100));
    EXPECT_EQ(response.box_ids[i], static_cast<std::int64_t>(i));
    EXPECT_EQ(response.box_labels[i], "box " + std::to_string(i));
    EXPECT_EQ(response.box_topics[i], "/a");
  }
}

TEST(GetScene, GivesTheBoxesThatPass) {
  GetSceneRequest request;
  request.namespaces = {"rack"};
  request.ignore_topics = {"/b"};
  GetSceneResponse response;
  answer(request, smallSnapshot(), ros::Time(103), response);
  EXPECT_EQ(response.box_ids, (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(response.poses.size(), 2U);
  EXPECT_EQ(response.poses.back().position, point(4, 0, 0));
  request.ignore_ids = {1};
  EXPECT_THROW(check(request, Limits()), std::invalid_argument);
}

TEST(NoAnswer, HasNoNumberThatCouldBeTakenForOne) {
  EXPECT_TRUE(std::isnan(nothing<CastRayResponse>().range));
  EXPECT_TRUE(std::isnan(nothing<CastRayResponse>().point.x));
  EXPECT_TRUE(std::isnan(nothing<CheckSegmentResponse>().clearance));
  EXPECT_TRUE(std::isnan(nothing<CheckSegmentResponse>().blocked_at));
  EXPECT_FALSE(nothing<CheckSegmentResponse>().clear);
  EXPECT_EQ(nothing<CheckSegmentsResponse>().first_blocked, -1);
}

}  // namespace
}  // namespace box_query::test
