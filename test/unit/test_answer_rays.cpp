// SPDX-License-Identifier: BSD-3-Clause
#include "unit/answer_fixture.h"

#include <limits>

#include <gtest/gtest.h>

namespace box_query::test {
namespace {

CastRayRequest rayAlongX(double max_range = 0) {
  CastRayRequest request;
  request.direction = vector(1, 0, 0);
  request.max_range = max_range;
  return request;
}

TEST(CastRay, NamesTheFirstBoxAndItsScene) {
  const CastRayResponse response = ask(rayAlongX(), smallSnapshot());
  EXPECT_EQ(response.scene_id, 7U);
  EXPECT_EQ(response.scene_stamp, ros::Time(100));
  EXPECT_EQ(response.scene_age, 1.0);
  EXPECT_TRUE(response.complete) << response.reason;
  ASSERT_TRUE(response.hit);
  EXPECT_EQ(response.range, 1.5);
  EXPECT_EQ(response.exit_range, 2.5);
  EXPECT_FALSE(response.started_inside);
  EXPECT_EQ(response.point, point(1.5, 0, 0));
  EXPECT_EQ(response.normal, vector(-1, 0, 0));
  EXPECT_EQ(response.box_topic, "/a");
  EXPECT_EQ(response.box_namespace, "rack");
  EXPECT_EQ(response.box_id, 1);
  EXPECT_EQ(response.box_label, "first");
}

TEST(CastRay, MaxRangeIsInMetresAndInclusive) {
  CastRayRequest request = rayAlongX(1.5);
  request.direction = vector(0.25, 0, 0);
  EXPECT_TRUE(ask(request, smallSnapshot()).hit);
  request.max_range = std::nextafter(1.5, 0);
  const CastRayResponse miss = ask(request, smallSnapshot());
  EXPECT_FALSE(miss.hit);
  EXPECT_EQ(miss.range, kInf);
  EXPECT_TRUE(std::isnan(miss.exit_range));
  EXPECT_TRUE(std::isnan(miss.point.x));
  EXPECT_TRUE(std::isnan(miss.normal.z));
  EXPECT_EQ(miss.box_topic, "");
  for (const double unlimited : {0.0, kInf}) {
    request.max_range = unlimited;
    EXPECT_TRUE(ask(request, smallSnapshot()).hit);
  }
}

TEST(CastRay, AnswersInTheFrameOfTheRequest) {
  CastRayRequest request;
  // Map's ray from (0, 0, 0) along x, as the turned frame sees it.
  request.origin = point(-20, 10, 0);
  request.direction = vector(0, -2, 0);
  request.max_range = 1.6;
  const CastRayResponse response = ask(request, smallSnapshot(), quarterTurn());
  ASSERT_TRUE(response.hit);
  EXPECT_NEAR(response.range, 1.5, 1e-14);
  EXPECT_NEAR(response.point.x, -20, 1e-14);
  EXPECT_NEAR(response.point.y, 8.5, 1e-14);
  EXPECT_NEAR(response.normal.y, 1, 1e-15);
  request.max_range = 1.4;
  EXPECT_FALSE(ask(request, smallSnapshot(), quarterTurn()).hit);
}

CastRaysRequest randomRays(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> position(-12, 12);
  std::uniform_real_distribution<double> range(1, 15);
  CastRaysRequest request;
  for (std::size_t i = 0; i < count; ++i) {
    request.origins.push_back(point(position(random), position(random), position(random)));
    request.directions.push_back(vector(position(random), position(random), position(random)));
    request.max_ranges.push_back(i % 7 == 0 ? 0 : range(random));
  }
  return request;
}

TEST(CastRays, EqualSingleRaysToTheLastBit) {
  const Snapshot snapshot = randomSnapshot(60, 1);
  CastRaysRequest request = randomRays(500, 2);
  request.want_exits = request.want_points = request.want_normals = request.want_boxes = true;
  request.ignore_namespaces = {"", ""};
  request.ignore_ids = {3, 50};
  for (const FrameChange& frame : {FrameChange(), crookedFrame()}) {
    const CastRaysResponse batch = ask(request, snapshot, frame);
    int hits = 0;
    for (std::size_t i = 0; i < 500; ++i) {
      CastRayRequest one;
      one.origin = request.origins[i];
      one.direction = request.directions[i];
      one.max_range = request.max_ranges[i];
      one.ignore_namespaces = request.ignore_namespaces;
      one.ignore_ids = request.ignore_ids;
      const CastRayResponse single = ask(one, snapshot, frame);
      EXPECT_EQ(batch.hits[i], single.hit);
      EXPECT_EQ(batch.ranges[i], single.range);
      EXPECT_EQ(bytesOf(batch.points[i]), bytesOf(single.point));
      EXPECT_EQ(bytesOf(batch.normals[i]), bytesOf(single.normal));
      ASSERT_EQ(batch.boxes[i] >= 0, single.hit);
      if (single.hit) {
        ++hits;
        const auto box = static_cast<std::size_t>(batch.boxes[i]);
        EXPECT_EQ(batch.exit_ranges[i], single.exit_range);
        EXPECT_EQ(batch.box_ids.at(box), single.box_id);
        EXPECT_EQ(batch.box_labels.at(box), single.box_label);
      }
    }
    EXPECT_GT(hits, 100);
    EXPECT_LT(hits, 400);
    EXPECT_TRUE(std::is_sorted(batch.box_ids.begin(), batch.box_ids.end()));
    EXPECT_GT(batch.box_ids.size(), 20U);
  }
}

TEST(CastRays, AreTheSameOnManyThreads) {
  const Snapshot snapshot = randomSnapshot(60, 1);
  CastRaysRequest request = randomRays(3000, 2);
  request.want_exits = request.want_points = request.want_normals = request.want_boxes = true;
  for (const auto mode : {CastRaysRequest::CLOSEST, CastRaysRequest::ANY}) {
    request.mode = mode;
    const CastRaysResponse one = ask(request, snapshot, crookedFrame(), 1);
    EXPECT_GT(std::count(one.hits.begin(), one.hits.end(), 1), 600);
    EXPECT_EQ(bytesOf(one), bytesOf(ask(request, snapshot, crookedFrame(), 4)));
  }
}

TEST(CastRays, MayShareAnOriginAndARange) {
  const Snapshot snapshot = randomSnapshot(60, 1);
  CastRaysRequest each = randomRays(500, 2);
  each.origins.assign(500, each.origins[0]);
  each.max_ranges.assign(500, 7.0);
  CastRaysRequest shared = each;
  shared.origins.resize(1);
  shared.max_ranges.resize(1);
  for (const FrameChange& frame : {FrameChange(), crookedFrame()}) {
    const CastRaysResponse response = ask(each, snapshot, frame);
    EXPECT_GT(std::count(response.hits.begin(), response.hits.end(), 1), 30);
    EXPECT_EQ(bytesOf(response), bytesOf(ask(shared, snapshot, frame)));
  }
}

TEST(CastRays, NameTheFirstRayAtFaultOnManyThreads) {
  CastRaysRequest request = randomRays(3000, 2);
  for (std::size_t i = 1234; i < 3000; ++i) {
    request.origins[i].x = 1.7e308;
    request.origins[i].y = 1.7e308;
  }
  try {
    ask(request, smallSnapshot(), crookedFrame(), 4);
    FAIL() << "it was answered";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("directions[1234]"), std::string::npos)
        << error.what();
  }
}

TEST(CastRays, AnyHitsAreTheClosestHits) {
  const Snapshot snapshot = randomSnapshot(60, 1);
  CastRaysRequest request = randomRays(500, 2);
  const CastRaysResponse closest = ask(request, snapshot);
  request.mode = CastRaysRequest::ANY;
  request.want_points = request.want_boxes = true;
  const CastRaysResponse any = ask(request, snapshot);
  EXPECT_EQ(any.hits, closest.hits);
  EXPECT_EQ(any.hits.size(), 500U);
  EXPECT_TRUE(any.ranges.empty() && any.points.empty() && any.boxes.empty());
}

TEST(CastRays, FillOnlyWhatIsWanted) {
  CastRaysRequest request;
  request.origins = {point(0, 0, 0)};
  request.directions = {vector(1, 0, 0), vector(0, 1, 0), vector(2, 0, 0)};
  request.max_ranges = {1.5};
  const CastRaysResponse response = ask(request, smallSnapshot());
  EXPECT_EQ(response.hits, (std::vector<std::uint8_t>{1, 0, 1}));
  EXPECT_EQ(response.ranges, (std::vector<double>{1.5, kInf, 1.5}));
  EXPECT_TRUE(response.exit_ranges.empty());
  EXPECT_TRUE(response.points.empty());
  EXPECT_TRUE(response.normals.empty());
  EXPECT_TRUE(response.boxes.empty());
  EXPECT_TRUE(response.box_topics.empty());
  request.want_boxes = true;
  const CastRaysResponse named = ask(request, smallSnapshot());
  EXPECT_EQ(named.boxes, (std::vector<std::int32_t>{0, -1, 0}));
  EXPECT_EQ(named.box_topics, std::vector<std::string>{"/a"});
  EXPECT_TRUE(named.points.empty());
}

TEST(CastRays, OfNoRayIsAnEmptyAnswer) {
  EXPECT_TRUE(ask(CastRaysRequest(), smallSnapshot()).hits.empty());
}

TEST(Rays, AreRefusedWithASentence) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto with = [](auto change) {
    CastRayRequest request = rayAlongX();
    request.header.frame_id = "map";
    change(request);
    return refusal(request);
  };
  EXPECT_EQ(with([](auto&) {}), "");
  EXPECT_EQ(with([](auto& r) { r.header.frame_id = ""; }),
            "header.frame_id is empty: name the frame in which the geometry is given");
  EXPECT_EQ(with([nan](auto& r) { r.origin.y = nan; }),
            "origin is (0, nan, 0): give finite numbers");
  EXPECT_EQ(with([](auto& r) { r.direction.z = -kInf; }),
            "direction is (1, 0, -inf): give finite numbers");
  EXPECT_EQ(with([](auto& r) { r.direction.x = -0.0; }),
            "direction is zero: give a direction of any other length");
  EXPECT_EQ(with([](auto& r) { r.max_range = -1; }),
            "max_range is -1: give metres >= 0; 0 or +Inf is unlimited");
  EXPECT_EQ(with([nan](auto& r) { r.max_range = nan; }),
            "max_range is nan: give metres >= 0; 0 or +Inf is unlimited");
}

TEST(Rays, AreRefusedByTheIndexAtFault) {
  const auto with = [](auto change) {
    CastRaysRequest request;
    request.header.frame_id = "map";
    request.origins.resize(3);
    request.directions.assign(3, vector(1, 0, 0));
    request.max_ranges = {1, 2, 3};
    change(request);
    return refusal(request, 3);
  };
  EXPECT_EQ(with([](auto&) {}), "");
  EXPECT_EQ(with([](auto& r) { r.mode = 2; }), "mode is 2: give CLOSEST (0) or ANY (1)");
  EXPECT_EQ(with([](auto& r) { r.origins[2].x = kInf; }),
            "origins[2] is (inf, 0, 0): give finite numbers");
  EXPECT_EQ(with([](auto& r) { r.directions[1] = vector(0, 0, 0); }),
            "directions[1] is zero: give a direction of any other length");
  EXPECT_EQ(with([](auto& r) { r.max_ranges[0] = -2; }),
            "max_ranges[0] is -2: give metres >= 0; 0 or +Inf is unlimited");
  EXPECT_EQ(with([](auto& r) { r.origins.resize(2); }),
            "origins has 2 elements: give 3, or a single one for all");
  EXPECT_EQ(with([](auto& r) { r.origins.clear(); }),
            "origins has 0 elements: give 3, or a single one for all");
  EXPECT_EQ(with([](auto& r) { r.max_ranges.resize(4); }),
            "max_ranges has 4 elements: give 3, a single one for all, or none");
  EXPECT_EQ(with([](auto& r) { r.directions.resize(4, vector(1, 0, 0)); }),
            "the request has 4 rays, at most 3 are taken: split it, or raise "
            "~max_queries_per_call");
}

TEST(Rays, AtFaultAreFoundAmongMany) {
  CastRaysRequest request = randomRays(1000, 2);
  request.header.frame_id = "map";
  EXPECT_EQ(refusal(request), "");
  // Not alike in length, and with components of 0: each is a direction by itself.
  request.directions[3] = vector(0, 0, -1e-150);
  request.directions[4] = vector(1e250, 0, 1e200);
  EXPECT_EQ(refusal(request), "");
  const auto with = [&](const geometry_msgs::Vector3& direction,
                        const geometry_msgs::Point& origin) {
    CastRaysRequest changed = request;
    changed.directions[777] = direction;
    changed.origins[888] = origin;
    return refusal(changed);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const geometry_msgs::Vector3 along_x = vector(1, 0, 0);
  const geometry_msgs::Point zero = point(0, 0, 0);
  EXPECT_EQ(with(along_x, zero), "");
  EXPECT_EQ(with(vector(-0.0, 0, 0), zero),
            "directions[777] is zero: give a direction of any other length");
  EXPECT_EQ(with(vector(1, nan, 0), zero), "directions[777] is (1, nan, 0): give finite numbers");
  EXPECT_EQ(
      with(vector(1, 1e-61, 0), zero),
      "directions[777] is (1, 1e-61, 0): give 0 for what is less than 1e-60 times its longest "
      "component");
  EXPECT_EQ(with(along_x, point(0, kInf, 0)), "origins[888] is (0, inf, 0): give finite numbers");
  for (const double bad : {1.001e7, 9e-201}) {
    EXPECT_EQ(with(along_x, point(0, 0, bad)).substr(0, 19), "origins[888] is (0,");
  }
}

TEST(Rays, ThatAreZeroAreFoundAmongThoseThatAreNot) {
  CastRaysRequest request = randomRays(1000, 2);
  request.header.frame_id = "map";
  request.directions[999] = vector(0, 0, 0);
  EXPECT_EQ(refusal(request), "directions[999] is zero: give a direction of any other length");
}

TEST(Rays, ThatOverflowInTheFixedFrameAreRefused) {
  CastRayRequest request = rayAlongX();
  request.origin = point(1e308, 1.7e308, 1.7e308);
  EXPECT_NO_THROW(ask(request, smallSnapshot()));
  EXPECT_THROW(ask(request, smallSnapshot(), crookedFrame()), std::invalid_argument);
}

TEST(Rays, AreDrawnInTheFixedFrameUpToALimit) {
  const Snapshot snapshot = smallSnapshot();
  CastRaysRequest request;
  request.header.frame_id = "other";
  request.origins = {point(-20, 10, 0)};
  request.directions = {vector(0, -2, 0), vector(0, 2, 0), vector(0, 2, 0)};
  Context context = {snapshot, ros::Time(101), quarterTurn(), Drawing(2)};
  CastRaysResponse response;
  answer(request, context, response);
  const std::vector<DrawnQuery> drawn = context.drawing.take();
  ASSERT_EQ(drawn.size(), 2U);
  EXPECT_EQ(drawn[0].outcome, Outcome::kMet);
  EXPECT_TRUE(drawn[0].start.isApprox(Vector3(0, 0, 0)) || drawn[0].start.norm() < 1e-14);
  EXPECT_NEAR(drawn[0].end.x(), 1.5, 1e-14);
  EXPECT_EQ(drawn[0].normal, Vector3(-1, 0, 0));
  EXPECT_EQ(drawn[1].outcome, Outcome::kFree);
  EXPECT_NEAR(drawn[1].end.x(), -10, 1e-14);
}

}  // namespace
}  // namespace box_query::test
