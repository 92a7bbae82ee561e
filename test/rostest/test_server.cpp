// SPDX-License-Identifier: BSD-3-Clause
// The services of the real node through the real master, with its boxes from a publisher here.
#include "rostest/server_fixture.h"

#include <future>
#include <limits>

#include <ros/init.h>
#include <tf2_msgs/TFMessage.h>

namespace box_query::test {
namespace {

using visualization_msgs::Marker;

constexpr unsigned kSeed = 11;

/// The boxes that every test here asks about.
class Server : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    talker_ = new ArrayTalker("boxes");
    ASSERT_TRUE(talker_->isHeard());
  }
  static void TearDownTestSuite() { delete talker_; }

  void SetUp() override {
    if (scene().poses.size() != 40) {
      talker_->say(randomBoxes(kSeed));
    }
    ASSERT_TRUE(nodeHas(40));
    ASSERT_TRUE(scene().complete) << scene().reason;
  }

  static ArrayTalker* talker_;
};
ArrayTalker* Server::talker_ = nullptr;

/// Runs first.
TEST(ServerWithoutBoxes, AnswersButCannotCallAnythingClear) {
  auto request = requestIn<CheckSegmentRequest>("map");
  request.end.x = 1;
  const CheckSegmentResponse unknown = checkSegment(request);
  EXPECT_TRUE(unknown.success) << unknown.message;
  EXPECT_FALSE(unknown.complete);
  EXPECT_NE(unknown.reason.find("/boxes"), std::string::npos) << unknown.reason;
  EXPECT_EQ(unknown.reason.find("/extra"), std::string::npos) << "is not required";
  EXPECT_FALSE(unknown.clear);
  EXPECT_FALSE(unknown.blocked);
  EXPECT_EQ(unknown.clearance, kInf);
  EXPECT_EQ(unknown.scene_age, kInf);
  request.allow_incomplete = true;
  EXPECT_TRUE(checkSegment(request).clear);
}

TEST_F(Server, GivesItsSceneInFullDoubles) {
  const visualization_msgs::MarkerArray sent = randomBoxes(kSeed);
  const GetSceneResponse response = scene();
  EXPECT_EQ(response.header.frame_id, "map");
  ASSERT_EQ(response.poses.size(), 40U);
  for (std::size_t i = 0; i < 40; ++i) {
    // In the order of (topic, ns, id): the even ones first.
    const std::size_t k = i < 20 ? 2 * i : 2 * (i - 20) + 1;
    EXPECT_EQ(response.box_topics[i], "/boxes");
    EXPECT_EQ(response.box_namespaces[i], k % 2 == 0 ? "even" : "odd");
    EXPECT_EQ(response.box_ids[i], static_cast<std::int64_t>(k));
    EXPECT_EQ(bytesOf(response.poses[i]), bytesOf(sent.markers[k].pose));
    EXPECT_EQ(bytesOf(response.sizes[i]), bytesOf(sent.markers[k].scale));
  }
}

/// The scene of the node, rebuilt from what ~get_scene says.
Snapshot rebuilt(const GetSceneResponse& response) {
  Snapshot snapshot = smallSnapshot();
  snapshot.names.clear();
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < response.poses.size(); ++i) {
    const geometry_msgs::Pose& pose = response.poses[i];
    boxes.emplace_back(OrientedBox{
        fromMessage(pose.position),
        Quaternion(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z),
        0.5 * fromMessage(response.sizes[i])});
    snapshot.names.push_back({response.box_topics[i], response.box_namespaces[i],
                              response.box_ids[i], response.box_labels[i]});
  }
  snapshot.scene = Scene(std::move(boxes));
  return snapshot;
}

TEST_F(Server, CastsRaysAsTheLibraryDoesToTheLastBit) {
  const Snapshot snapshot = rebuilt(scene());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> position(-12, 12);
  auto request = requestIn<CastRaysRequest>("map");
  request.want_exits = request.want_points = request.want_normals = request.want_boxes = true;
  for (int i = 0; i < 400; ++i) {
    request.origins.push_back(point(position(random), position(random), position(random)));
    request.directions.push_back(vector(position(random), position(random), position(random)));
  }
  request.max_ranges = {10};
  const CastRaysResponse response = call<CastRays>("cast_rays", request);
  ASSERT_TRUE(response.success) << response.message;
  const CastRaysResponse expected = ask(request, snapshot);
  EXPECT_EQ(response.hits, expected.hits);
  EXPECT_EQ(response.ranges, expected.ranges);
  EXPECT_EQ(response.boxes, expected.boxes);
  EXPECT_EQ(response.box_ids, expected.box_ids);
  EXPECT_EQ(response.box_namespaces, expected.box_namespaces);
  for (std::size_t i = 0; i < 400; ++i) {
    EXPECT_EQ(bytesOf(response.points[i]), bytesOf(expected.points[i]));
    EXPECT_EQ(bytesOf(response.normals[i]), bytesOf(expected.normals[i]));
  }
  const auto hits = std::count(response.hits.begin(), response.hits.end(), 1);
  EXPECT_GT(hits, 100);
  EXPECT_LT(hits, 390);

  CastRayRequest one = ray("map", request.origins[0], request.directions[0]);
  one.max_range = 10;
  const CastRayResponse single = cast(one);
  EXPECT_TRUE(single.success);
  EXPECT_EQ(single.hit, response.hits[0]);
  EXPECT_EQ(single.range, response.ranges[0]);
  EXPECT_EQ(single.scene_id, response.scene_id);
}

TEST_F(Server, ChecksSegmentsAsTheLibraryDoesToTheLastBit) {
  const Snapshot snapshot = rebuilt(scene());
  std::mt19937 random(6);
  std::uniform_real_distribution<double> position(-14, 14);
  auto request = requestIn<CheckSegmentsRequest>("map");
  request.shape = CheckSegmentsRequest::PATH;
  request.want_clearances = request.want_points = true;
  request.want_blocked_at = request.want_boxes = true;
  for (int i = 0; i < 200; ++i) {
    // Short ones and long ones.
    const geometry_msgs::Point last = i % 2 == 0 ? point(0, 0, 0) : request.points.back();
    const double scale = i % 2 == 0 ? 1 : 0.1;
    request.points.push_back(point(last.x + scale * position(random),
                                   last.y + scale * position(random),
                                   last.z + scale * position(random)));
  }
  request.radii = {0.125};
  const CheckSegmentsResponse response = call<CheckSegments>("check_segments", request);
  ASSERT_TRUE(response.success) << response.message;
  const CheckSegmentsResponse expected = ask(request, snapshot);
  EXPECT_EQ(response.states, expected.states);
  EXPECT_EQ(response.clearances, expected.clearances);
  EXPECT_EQ(response.blocked_at, expected.blocked_at);
  EXPECT_EQ(response.blocking_boxes, expected.blocking_boxes);
  EXPECT_EQ(response.first_blocked, expected.first_blocked);
  const auto blocked = std::count(response.states.begin(), response.states.end(),
                                  std::uint8_t{CheckSegmentsResponse::BLOCKED});
  EXPECT_GT(blocked, 50);
  EXPECT_LT(blocked, 190);
  request.stop_at_blocked = true;
  const CheckSegmentsResponse stopped = call<CheckSegments>("check_segments", request);
  EXPECT_EQ(stopped.first_blocked, response.first_blocked);
  EXPECT_EQ(stopped.states.back(), CheckSegmentsResponse::NOT_EVALUATED);
}

/// From afar through the centers of two of the odd boxes.
CastRayRequest rayThroughTwo(const GetSceneResponse& boxes) {
  const Vector3 first = fromMessage(boxes.poses[20].position);
  const Vector3 second = fromMessage(boxes.poses[21].position);
  return ray("map", toPoint(first - 8 * (second - first)), toVector3(second - first));
}

TEST_F(Server, FindsEveryIntersection) {
  const Snapshot snapshot = rebuilt(scene());
  const CastRayRequest through = rayThroughTwo(scene());
  auto request = requestIn<FindIntersectionsRequest>("map");
  request.component = FindIntersectionsRequest::LINE;
  request.origin = through.origin;
  request.direction = through.direction;
  const auto response = call<FindIntersections>("find_intersections", request);
  ASSERT_TRUE(response.success) << response.message;
  const auto expected = ask(request, snapshot);
  ASSERT_GT(response.box_ids.size(), 1U);
  EXPECT_EQ(response.box_ids, expected.box_ids);
  EXPECT_EQ(response.t_enter, expected.t_enter);
  EXPECT_EQ(response.distance_enter, expected.distance_enter);
  EXPECT_EQ(response.faces_left, expected.faces_left);
}

TEST_F(Server, Filters) {
  CastRayRequest request = rayThroughTwo(scene());
  std::vector<std::int64_t> met;
  for (CastRayResponse response = cast(request); response.hit; response = cast(request)) {
    met.push_back(response.box_id);
    request.ignore_topics.push_back(response.box_topic);
    request.ignore_namespaces.push_back(response.box_namespace);
    request.ignore_ids.push_back(response.box_id);
    ASSERT_LE(met.size(), 40U);
  }
  EXPECT_GT(met.size(), 1U);
  request = rayThroughTwo(scene());
  request.namespaces = {"odd"};
  EXPECT_EQ(cast(request).box_id % 2, 1);
  request.namespaces = {"even"};
  EXPECT_NE(cast(request).box_id % 2, 1);
  EXPECT_EQ(cast(request).message, "");
  request.namespaces = {"odd"};
  request.topics = {"boxes"};
  EXPECT_TRUE(cast(request).hit);
  request.ignore_namespaces = {"odd"};
  EXPECT_FALSE(cast(request).hit);
  request.ignore_namespaces.clear();
  request.topics = {"extra"};
  EXPECT_FALSE(cast(request).hit);
  EXPECT_EQ(cast(request).message, "") << "it has no boxes, but is listened to";
}

TEST_F(Server, GivesSomeOfItsScene) {
  GetSceneRequest request;
  request.namespaces = {"odd"};
  request.ignore_namespaces = {"odd", "odd"};
  request.ignore_ids = {1, 2};
  const auto response = call<GetScene>("get_scene", request);
  EXPECT_EQ(response.box_ids.size(), 19U);
  EXPECT_EQ(response.poses.size(), 19U);
  EXPECT_EQ(response.message, "There is no box to ignore of namespace 'odd', id 2.");
}

TEST_F(Server, WarnsOfANamespaceThatNoBoxHas) {
  auto request = requestIn<CheckSegmentRequest>("map");
  request.namespaces = {"evn"};
  const CheckSegmentResponse response = call<CheckSegment>("check_segment", request);
  EXPECT_TRUE(response.success && response.clear) << "there may be no such box now";
  EXPECT_NE(response.message.find("'evn': there are 'even', 'odd'."), std::string::npos)
      << response.message;
}

TEST_F(Server, AnswersInAFrameOfStaticTf) {
  ros::NodeHandle nh;
  ros::Publisher tf = nh.advertise<tf2_msgs::TFMessage>("/tf_static", 10, true);
  tf.publish(transform("map", "shelf", ros::Time(), 3.0));
  const CastRayResponse in_map = cast(ray("map", point(-30, 0, 0), vector(1, 0, 0)));
  ASSERT_TRUE(in_map.hit);
  CastRayResponse response;
  EXPECT_TRUE(eventually([&] {
    response = cast(ray("shelf", point(-33, 0, 0), vector(1, 0, 0)));
    return response.success;
  })) << response.message;
  EXPECT_NEAR(response.range, in_map.range, 1e-12);
  EXPECT_NEAR(response.point.x, in_map.point.x - 3, 1e-12);
  EXPECT_EQ(response.box_id, in_map.box_id);
}

TEST_F(Server, PlacesARequestAtItsStamp) {
  ros::NodeHandle nh;
  ros::Publisher tf = nh.advertise<tf2_msgs::TFMessage>("/tf", 10);
  ASSERT_TRUE(eventually([&] { return tf.getNumSubscribers() > 0; }));
  const ros::Time now = ros::Time::now();
  tf.publish(transform("map", "cart", now - ros::Duration(2), 0.0));
  tf.publish(transform("map", "cart", now, 2.0));
  const double in_map = cast(ray("map", point(-30, 0, 0), vector(1, 0, 0))).range;
  for (const double ago : {2.0, 1.0, 0.0}) {
    CastRayRequest request = ray("cart", point(-30, 0, 0), vector(1, 0, 0));
    request.header.stamp = now - ros::Duration(ago);
    const CastRayResponse response = cast(request);
    ASSERT_TRUE(response.success) << response.message;
    EXPECT_NEAR(response.range, in_map - (2 - ago), 1e-9) << ago;
  }
}

TEST_F(Server, SaysWhatTransformIsMissingWithinItsTimeout) {
  const ros::WallTime start = ros::WallTime::now();
  const CastRayResponse response = cast(ray("nowhere", point(0, 0, 0), vector(1, 0, 0)));
  const double waited = (ros::WallTime::now() - start).toSec();
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("nowhere"), std::string::npos) << response.message;
  EXPECT_FALSE(response.hit);
  EXPECT_TRUE(std::isnan(response.range));
  EXPECT_NE(response.scene_id, 0U) << "even a refusal says what is known";
  EXPECT_GE(waited, 0.3);
  EXPECT_LT(waited, 5.0);
}

TEST_F(Server, RefusesBadRequestsWithASentence) {
  EXPECT_EQ(cast(ray("", point(0, 0, 0), vector(1, 0, 0))).message,
            "header.frame_id is empty: name the frame in which the geometry is given");
  EXPECT_EQ(cast(ray("map", point(0, 0, 0), vector(0, 0, 0))).message,
            "direction is zero: give a direction of any other length");
  auto segment = requestIn<CheckSegmentRequest>("map");
  segment.radius = -1;
  EXPECT_EQ(checkSegment(segment).message, "radius is -1: give finite metres >= 0");
  EXPECT_TRUE(std::isnan(checkSegment(segment).clearance));
  auto find = requestIn<FindIntersectionsRequest>("map");
  find.component = 9;
  const auto found = call<FindIntersections>("find_intersections", find);
  EXPECT_FALSE(found.success);
  EXPECT_EQ(found.message, "component is 9: give LINE (0), RAY (1) or SEGMENT (2)");
  auto rays = requestIn<CastRaysRequest>("map");
  rays.origins.resize(1);
  rays.directions.assign(3, vector(0, 1, 0));
  rays.directions[2].y = kNan;
  const auto refused = call<CastRays>("cast_rays", rays);
  EXPECT_FALSE(refused.success);
  EXPECT_EQ(refused.message, "directions[2] is (0, nan, 0): give finite numbers");
  EXPECT_TRUE(refused.hits.empty() && refused.ranges.empty());
  rays.directions.assign(2001, vector(0, 1, 0));
  EXPECT_EQ(call<CastRays>("cast_rays", rays).message,
            "the request has 2001 rays, at most 2000 are taken: split it, or raise "
            "~max_queries_per_call");
  rays.directions.assign(4001, vector(0, 1, 0));
  EXPECT_EQ(call<CastRays>("cast_rays", rays).message,
            "too large a request: an array of 4001 elements, at most 4000 are taken; split it, or "
            "raise ~max_queries_per_call");
  auto segments = requestIn<CheckSegmentsRequest>("map");
  segments.points.resize(3);
  const auto odd = call<CheckSegments>("check_segments", segments);
  EXPECT_EQ(odd.message, "points has 3 elements: PAIRS needs a start and an end for every segment");
  EXPECT_EQ(odd.first_blocked, -1);
}

TEST_F(Server, RefusesBytesThatAreNoRequestAtOnce) {
  auto request = requestIn<CastRaysRequest>("map");
  const auto answered = [](std::vector<std::uint8_t> bytes) {
    RawRequest raw = {std::move(bytes)};
    CastRaysResponse response;
    bool called = false;
    for (int attempt = 0; attempt < 5 && !called; ++attempt) {
      called = ros::service::call("/box_query/cast_rays", raw, response);
    }
    EXPECT_TRUE(called);
    return response;
  };
  EXPECT_TRUE(answered(bytesOf(request)).success);
  const ros::WallTime start = ros::WallTime::now();
  std::vector<std::uint8_t> huge = bytesOf(request);
  // The count of origins, after the header and the mode: 4e9 of them would be 96 GB.
  const std::uint32_t count = 4000000000U;
  std::copy_n(reinterpret_cast<const std::uint8_t*>(&count), 4, &huge[4 + 8 + 4 + 3 + 1]);
  const CastRaysResponse too_many = answered(huge);
  EXPECT_FALSE(too_many.success);
  EXPECT_NE(too_many.message.find("an array of 4000000000 elements"), std::string::npos)
      << too_many.message;
  std::vector<std::uint8_t> cut = bytesOf(request);
  cut.resize(cut.size() / 2);
  EXPECT_NE(answered(cut).message.find("malformed request"), std::string::npos);
  std::vector<std::uint8_t> longer = bytesOf(request);
  longer.resize(longer.size() + 3);
  EXPECT_NE(answered(longer).message.find("3 bytes are left over"), std::string::npos);
  EXPECT_NE(answered({}).message.find("malformed request"), std::string::npos);
  EXPECT_LT((ros::WallTime::now() - start).toSec(), 10.0);
}

TEST_F(Server, AnswersSeveralClientsAtOnce) {
  CastRayRequest request = ray("map", point(-30, 0, 0), vector(1, 0, 0));
  const CastRayResponse expected = cast(request);
  ASSERT_TRUE(expected.hit);
  const auto client = [&] {
    int equal = 0;
    for (int i = 0; i < 50; ++i) {
      equal += cast(request).range == expected.range ? 1 : 0;
    }
    return equal;
  };
  std::vector<std::future<int>> clients;
  for (int i = 0; i < 4; ++i) {
    clients.push_back(std::async(std::launch::async, client));
  }
  for (auto& equal : clients) {
    EXPECT_EQ(equal.get(), 50);
  }
}

TEST_F(Server, KeepsTheScenesThatWereAskedLast) {
  const std::uint64_t first = cast(ray("map", point(0, 0, 0), vector(1, 0, 0))).scene_id;
  std::uint64_t last = first;
  for (int i = 0; i < 5; ++i) {
    const GetSceneResponse kept = scene(first);
    ASSERT_TRUE(kept.success) << kept.message;
    EXPECT_EQ(kept.scene_id, first);
    EXPECT_EQ(kept.poses.size(), 40U);
    talker_->say(array({cube("map", 100 + i, 50)}));
    ASSERT_TRUE(nodeHas(41 + static_cast<std::size_t>(i)));
    EXPECT_GT(scene().scene_id, last);
    last = scene().scene_id;
  }
  const GetSceneResponse gone = scene(first);
  EXPECT_FALSE(gone.success);
  EXPECT_NE(gone.message.find("scene " + std::to_string(first) + " is not kept"), std::string::npos)
      << gone.message;
  EXPECT_FALSE(scene(last + 1000).success);
  talker_->say(array({withAction(cube("map", 0, 0), Marker::DELETEALL)}));
  ASSERT_TRUE(nodeHas(0));
}

}  // namespace
}  // namespace box_query::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_server");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
