// SPDX-License-Identifier: BSD-3-Clause
#include "unit/answer_fixture.h"

#include <limits>

#include <gtest/gtest.h>

namespace box_query::test {
namespace {

using States = std::vector<std::uint8_t>;
constexpr std::uint8_t kClear = CheckSegmentsResponse::CLEAR;
constexpr std::uint8_t kBlocked = CheckSegmentsResponse::BLOCKED;
constexpr std::uint8_t kUnknown = CheckSegmentsResponse::UNKNOWN;
constexpr std::uint8_t kNotEvaluated = CheckSegmentsResponse::NOT_EVALUATED;

CheckSegmentRequest segment(const geometry_msgs::Point& start, const geometry_msgs::Point& end,
                            double radius) {
  CheckSegmentRequest request;
  request.start = start;
  request.end = end;
  request.radius = radius;
  return request;
}

Snapshot incompleteSnapshot() {
  Snapshot snapshot = smallSnapshot();
  snapshot.topics[1].heard = false;
  return snapshot;
}

TEST(CheckSegment, TellsTheNearestBoxFromTheOneThatBlocksFirst) {
  // Passes 0.75 m above the first box, and 0.25 m above the second.
  Snapshot snapshot = smallSnapshot();
  snapshot.scene = Scene(
      {cubeAt(2, 0, 0, 0.5), cubeAt(4, 0, 0.5, 0.5), cubeAt(60, 0, 0, 0.5), cubeAt(80, 0, 0, 0.5)});
  const CheckSegmentResponse response =
      ask(segment(point(0, 0, 1.25), point(8, 0, 1.25), 0.75), snapshot);
  EXPECT_TRUE(response.complete);
  EXPECT_FALSE(response.clear);
  EXPECT_TRUE(response.blocked);
  EXPECT_EQ(response.clearance, 0.25);
  EXPECT_EQ(response.nearest_at, 3.5 / 8);
  EXPECT_EQ(response.point_on_segment, point(3.5, 0, 1.25));
  EXPECT_EQ(response.point_on_box, point(3.5, 0, 1));
  EXPECT_EQ(response.nearest_id, 2);
  EXPECT_EQ(response.nearest_topic, "/a");
  EXPECT_EQ(response.nearest_namespace, "rack");
  EXPECT_EQ(response.blocked_at, 1.5 / 8);
  EXPECT_EQ(response.blocked_point, point(1.5, 0, 1.25));
  EXPECT_EQ(response.blocking_id, 1);
  EXPECT_EQ(response.blocking_label, "first");
}

TEST(CheckSegment, TouchingIsNotClear) {
  CheckSegmentRequest request = segment(point(0, 1, 0), point(9, 1, 0), 0.5);
  EXPECT_FALSE(ask(request, smallSnapshot()).clear);
  request.radius = std::nextafter(0.5, 0);
  const CheckSegmentResponse clear = ask(request, smallSnapshot());
  EXPECT_TRUE(clear.clear);
  EXPECT_FALSE(clear.blocked);
  EXPECT_EQ(clear.clearance, 0.5);
  EXPECT_EQ(clear.blocked_at, kInf);
  EXPECT_TRUE(std::isnan(clear.blocked_point.x));
  EXPECT_EQ(clear.blocking_topic, "");
}

TEST(CheckSegment, IsClearOnlyWhereTheSceneIsCompleteOrNeedNotBe) {
  CheckSegmentRequest request = segment(point(0, 5, 0), point(9, 5, 0), 1);
  const CheckSegmentResponse unknown = ask(request, incompleteSnapshot());
  EXPECT_FALSE(unknown.complete);
  EXPECT_NE(unknown.reason.find("/b"), std::string::npos) << unknown.reason;
  EXPECT_FALSE(unknown.clear);
  EXPECT_FALSE(unknown.blocked);
  EXPECT_EQ(unknown.clearance, 4.5);
  request.allow_incomplete = true;
  const CheckSegmentResponse allowed = ask(request, incompleteSnapshot());
  EXPECT_TRUE(allowed.clear);
  EXPECT_FALSE(allowed.complete);
  request.radius = 4.5;
  EXPECT_FALSE(ask(request, incompleteSnapshot()).clear);
  EXPECT_TRUE(ask(request, incompleteSnapshot()).blocked);
}

TEST(CheckSegment, AnswersInTheFrameOfTheRequest) {
  // Map's (0, 1, 0) - (9, 1, 0).
  const CheckSegmentResponse response =
      ask(segment(point(-19, 10, 0), point(-19, 1, 0), 0.25), smallSnapshot(), quarterTurn());
  EXPECT_TRUE(response.clear);
  EXPECT_NEAR(response.clearance, 0.5, 1e-14);
  EXPECT_NEAR(response.point_on_segment.x, -19, 1e-14);
  EXPECT_NEAR(response.point_on_box.x, -19.5, 1e-14);
}

TEST(CheckSegment, WithoutABoxIsClearAtInfinity) {
  CheckSegmentRequest request = segment(point(0, 0, 0), point(9, 0, 0), 1);
  request.namespaces = {"nobody"};
  const CheckSegmentResponse response = ask(request, smallSnapshot());
  EXPECT_TRUE(response.clear);
  EXPECT_EQ(response.clearance, kInf);
  EXPECT_TRUE(std::isnan(response.nearest_at));
  EXPECT_TRUE(std::isnan(response.point_on_box.x));
  EXPECT_EQ(response.nearest_topic, "");
}

CheckSegmentsRequest randomPath(std::size_t points, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> position(-14, 14);
  std::uniform_real_distribution<double> radius(0, 1);
  CheckSegmentsRequest request;
  request.shape = CheckSegmentsRequest::PATH;
  for (std::size_t i = 0; i < points; ++i) {
    request.points.push_back(point(position(random), position(random), position(random)));
  }
  for (std::size_t i = 0; i + 1 < points; ++i) {
    request.radii.push_back(i % 5 == 0 ? 0 : radius(random));
  }
  return request;
}

TEST(CheckSegments, EqualSingleSegmentsToTheLastBit) {
  const Snapshot snapshot = randomSnapshot(12, 3);
  CheckSegmentsRequest request = randomPath(301, 4);
  request.want_clearances = request.want_points = true;
  request.want_blocked_at = request.want_boxes = true;
  for (const FrameChange& frame : {FrameChange(), crookedFrame()}) {
    const CheckSegmentsResponse batch = ask(request, snapshot, frame);
    int blocked = 0;
    int first_blocked = -1;
    for (std::size_t i = 0; i < 300; ++i) {
      const CheckSegmentResponse single =
          ask(segment(request.points[i], request.points[i + 1], request.radii[i]), snapshot, frame);
      EXPECT_EQ(batch.states[i], single.clear ? kClear : kBlocked);
      EXPECT_EQ(batch.clearances[i], single.clearance);
      EXPECT_EQ(bytesOf(batch.points_on_segment[i]), bytesOf(single.point_on_segment));
      EXPECT_EQ(bytesOf(batch.points_on_box[i]), bytesOf(single.point_on_box));
      EXPECT_EQ(batch.blocked_at[i], single.blocked_at);
      EXPECT_EQ(batch.box_ids.at(static_cast<std::size_t>(batch.nearest_boxes[i])),
                single.nearest_id);
      ASSERT_EQ(batch.blocking_boxes[i] >= 0, single.blocked);
      if (single.blocked) {
        EXPECT_EQ(batch.box_ids.at(static_cast<std::size_t>(batch.blocking_boxes[i])),
                  single.blocking_id);
        first_blocked = blocked++ == 0 ? static_cast<int>(i) : first_blocked;
      }
    }
    EXPECT_GT(blocked, 60);
    EXPECT_LT(blocked, 240);
    EXPECT_EQ(batch.first_blocked, first_blocked);
    EXPECT_FALSE(batch.all_clear);
  }
}

TEST(CheckSegments, AreTheSameOnManyThreads) {
  const Snapshot snapshot = randomSnapshot(12, 3);
  CheckSegmentsRequest request = randomPath(3001, 4);
  for (const bool wanted : {false, true}) {
    request.want_clearances = request.want_points = wanted;
    request.want_blocked_at = request.want_boxes = wanted;
    const CheckSegmentsResponse one = ask(request, snapshot, crookedFrame(), 1);
    EXPECT_GT(std::count(one.states.begin(), one.states.end(), kBlocked), 300);
    EXPECT_GT(std::count(one.states.begin(), one.states.end(), kClear), 300);
    EXPECT_EQ(bytesOf(one), bytesOf(ask(request, snapshot, crookedFrame(), 4)));
  }
}

TEST(CheckSegments, StatesDoNotDependOnWhatIsWanted) {
  const Snapshot snapshot = randomSnapshot(12, 3);
  CheckSegmentsRequest request = randomPath(301, 4);
  const CheckSegmentsResponse bare = ask(request, snapshot);
  EXPECT_TRUE(bare.clearances.empty() && bare.points_on_segment.empty() &&
              bare.points_on_box.empty() && bare.blocked_at.empty() && bare.nearest_boxes.empty() &&
              bare.blocking_boxes.empty() && bare.box_ids.empty());
  EXPECT_GT(std::count(bare.states.begin(), bare.states.end(), kBlocked), 60);
  request.want_clearances = true;
  EXPECT_EQ(ask(request, snapshot).states, bare.states);
  EXPECT_EQ(ask(request, snapshot).clearances.size(), 300U);
  request.want_clearances = false;
  request.want_blocked_at = true;
  EXPECT_EQ(ask(request, snapshot).states, bare.states);
}

TEST(CheckSegments, MayShareARadius) {
  const Snapshot snapshot = randomSnapshot(12, 3);
  CheckSegmentsRequest each = randomPath(301, 4);
  for (const std::vector<double>& radii : {std::vector<double>{}, {0.0}, {0.5}}) {
    each.radii.assign(300, radii.empty() ? 0.0 : radii[0]);
    CheckSegmentsRequest shared = each;
    shared.radii = radii;
    for (const FrameChange& frame : {FrameChange(), crookedFrame()}) {
      const CheckSegmentsResponse response = ask(each, snapshot, frame);
      EXPECT_GT(std::count(response.states.begin(), response.states.end(), kBlocked), 30);
      EXPECT_GT(std::count(response.states.begin(), response.states.end(), kClear), 60);
      EXPECT_EQ(bytesOf(response), bytesOf(ask(shared, snapshot, frame)));
    }
  }
}

TEST(CheckSegments, AreDecidedExactlyWhereTheRadiusIsTheRoundedClearance) {
  const Snapshot snapshot = randomSnapshot(12, 3);
  CheckSegmentsRequest request = randomPath(301, 4);
  request.want_clearances = true;
  request.radii = ask(request, snapshot).clearances;
  const CheckSegmentsResponse decided = ask(request, snapshot);
  EXPECT_GT(std::count(decided.states.begin(), decided.states.end(), kBlocked), 60);
  EXPECT_GT(std::count(decided.states.begin(), decided.states.end(), kClear), 60);
  for (std::size_t i = 0; i < 300; ++i) {
    const Segment asked = {fromMessage(request.points[i]), fromMessage(request.points[i + 1])};
    EXPECT_EQ(decided.states[i] == kClear, snapshot.scene.isClear(asked, request.radii[i])) << i;
    EXPECT_EQ(
        ask(segment(request.points[i], request.points[i + 1], request.radii[i]), snapshot).clear,
        decided.states[i] == kClear)
        << i;
  }
  request.want_blocked_at = request.want_boxes = true;
  const CheckSegmentsResponse with_places = ask(request, snapshot);
  EXPECT_EQ(with_places.states, decided.states);
  for (std::size_t i = 0; i < 300; ++i) {
    EXPECT_EQ(with_places.blocked_at[i] == kInf, decided.states[i] == kClear) << i;
  }
}

TEST(CheckSegments, StopAtTheLowestIndexThatIsBlocked) {
  CheckSegmentsRequest request;
  request.shape = CheckSegmentsRequest::PATH;
  request.points = {point(0, 0, 0), point(0, 0, 2), point(2, 0, 2), point(2, 0, 0), point(0, 0, 0)};
  request.want_clearances = request.want_points = true;
  request.want_blocked_at = request.want_boxes = true;
  EXPECT_EQ(ask(request, smallSnapshot()).states, (States{kClear, kClear, kBlocked, kBlocked}));
  request.stop_at_blocked = true;
  const CheckSegmentsResponse response = ask(request, smallSnapshot());
  EXPECT_EQ(response.states, (States{kClear, kClear, kBlocked, kNotEvaluated}));
  EXPECT_EQ(response.first_blocked, 2);
  EXPECT_FALSE(response.all_clear);
  ASSERT_EQ(response.clearances.size(), 4U);
  EXPECT_EQ(response.clearances[2], 0.0);
  EXPECT_TRUE(std::isnan(response.clearances[3]));
  EXPECT_TRUE(std::isnan(response.points_on_box[3].x));
  EXPECT_TRUE(std::isnan(response.blocked_at[3]));
  EXPECT_EQ(response.nearest_boxes, (std::vector<std::int32_t>{0, 0, 0, -1}));
  EXPECT_EQ(response.blocking_boxes, (std::vector<std::int32_t>{-1, -1, 0, -1}));
}

TEST(CheckSegments, OfAnIncompleteSceneAreUnknownOrBlocked) {
  CheckSegmentsRequest request;
  request.points = {point(0, 0, 0), point(1, 0, 0), point(0, 0, 0), point(9, 0, 0)};
  const CheckSegmentsResponse unknown = ask(request, incompleteSnapshot());
  EXPECT_EQ(unknown.states, (States{kUnknown, kBlocked}));
  EXPECT_EQ(unknown.first_blocked, 1);
  request.points.resize(2);
  EXPECT_FALSE(ask(request, incompleteSnapshot()).all_clear);
  EXPECT_EQ(ask(request, incompleteSnapshot()).first_blocked, -1);
  request.allow_incomplete = true;
  EXPECT_TRUE(ask(request, incompleteSnapshot()).all_clear);
}

TEST(CheckSegments, APathOfOnePointIsAPointAndOfNoneIsNotClear) {
  CheckSegmentsRequest request;
  request.shape = CheckSegmentsRequest::PATH;
  EXPECT_FALSE(ask(request, smallSnapshot()).all_clear) << "nothing was checked";
  request.points = {point(2.5, 0, 0)};
  EXPECT_EQ(ask(request, smallSnapshot()).states, States{kBlocked});
  request.points = {point(2.75, 0, 0)};
  EXPECT_EQ(ask(request, smallSnapshot()).states, States{kClear});
  EXPECT_TRUE(ask(request, smallSnapshot()).all_clear);
}

TEST(Segments, AreRefusedWithASentence) {
  const auto with = [](auto change) {
    CheckSegmentRequest request = segment(point(0, 0, 0), point(1, 0, 0), 0);
    request.header.frame_id = "map";
    change(request);
    return refusal(request);
  };
  EXPECT_EQ(with([](auto&) {}), "");
  EXPECT_EQ(with([](auto& r) { r.start.x = kNan; }), "start is (nan, 0, 0): give finite numbers");
  EXPECT_EQ(with([](auto& r) { r.end.z = kInf; }), "end is (1, 0, inf): give finite numbers");
  EXPECT_EQ(with([](auto& r) { r.radius = -0.5; }), "radius is -0.5: give finite metres >= 0");
  EXPECT_EQ(with([](auto& r) { r.radius = kInf; }), "radius is inf: give finite metres >= 0");
  EXPECT_EQ(with([](auto& r) { r.radius = kNan; }), "radius is nan: give finite metres >= 0");
  EXPECT_NE(with([](auto& r) { r.header.frame_id = ""; }), "");
}

TEST(Segments, AreRefusedByTheIndexAtFault) {
  const auto with = [](auto change) {
    CheckSegmentsRequest request;
    request.header.frame_id = "map";
    request.points.resize(6);
    request.radii = {0, 1, 2};
    change(request);
    return refusal(request, 3);
  };
  EXPECT_EQ(with([](auto&) {}), "");
  EXPECT_EQ(with([](auto& r) { r.shape = 9; }), "shape is 9: give PAIRS (0) or PATH (1)");
  EXPECT_EQ(with([](auto& r) { r.points.resize(5); }),
            "points has 5 elements: PAIRS needs a start and an end for every segment");
  EXPECT_EQ(with([](auto& r) { r.points[5].y = kNan; }),
            "points[5] is (0, nan, 0): give finite numbers");
  EXPECT_EQ(with([](auto& r) { r.radii[1] = -1; }), "radii[1] is -1: give finite metres >= 0");
  EXPECT_EQ(with([](auto& r) { r.radii.resize(2); }),
            "radii has 2 elements: give 3, a single one for all, or none");
  EXPECT_EQ(with([](auto& r) { r.points.resize(8); }),
            "the request has 4 segments, at most 3 are taken: split it, or raise "
            "~max_queries_per_call");
}

TEST(Segments, ThatOverflowInTheFixedFrameAreRefused) {
  CheckSegmentsRequest request;
  request.points = {point(0, 0, 0), point(0, 0, 0), point(1e308, 1.7e308, 1.7e308), point(0, 0, 0)};
  try {
    ask(request, smallSnapshot(), crookedFrame());
    ADD_FAILURE() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()).find("points[2] "), 0U) << error.what();
  }
}

TEST(PointAt, KeepsTheEndsAndStaysBetweenThem) {
  const Segment s = {{0.1, -1e308, 0.3}, {0.7, 1e308, 0.3}};
  EXPECT_EQ(pointAt(s, 0), s.start);
  EXPECT_EQ(pointAt(s, 1), s.end);
  for (const double t : {0.1, 1.0 / 3, 0.7, 0.9999999}) {
    EXPECT_EQ(pointAt(s, t).z(), 0.3);
    EXPECT_TRUE(pointAt(s, t).allFinite());
  }
}

TEST(CheckSegments, AreDrawnUpToALimitAsFarAsTheyWereEvaluated) {
  const Snapshot snapshot = smallSnapshot();
  CheckSegmentsRequest request;
  request.header.frame_id = "map";
  request.shape = CheckSegmentsRequest::PATH;
  request.points = {point(0, 2, 0), point(0, 0, 0), point(3, 0, 0), point(3, 2, 0)};
  request.want_blocked_at = request.want_points = true;
  const auto drawn = [&](std::size_t limit) {
    Context context = {snapshot, ros::Time(101), FrameChange(), Drawing(limit)};
    CheckSegmentsResponse response;
    answer(request, context, response);
    return context.drawing.take();
  };
  const std::vector<DrawnQuery> all = drawn(9);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].outcome, Outcome::kFree);
  EXPECT_TRUE(std::isnan(all[0].hit.x()));
  EXPECT_EQ(all[0].on_box.x(), 1.5);
  EXPECT_EQ(all[1].outcome, Outcome::kMet);
  EXPECT_EQ(all[1].start, Vector3(0, 0, 0));
  EXPECT_EQ(all[1].end, Vector3(3, 0, 0));
  EXPECT_EQ(all[1].hit, Vector3(1.5, 0, 0));
  EXPECT_EQ(all[2].outcome, Outcome::kFree);
  EXPECT_EQ(drawn(2).size(), 2U);
  EXPECT_TRUE(drawn(0).empty());
  request.stop_at_blocked = true;
  EXPECT_EQ(drawn(9).size(), 2U);
}

}  // namespace
}  // namespace box_query::test
