// SPDX-License-Identifier: BSD-3-Clause
// Markers serialised by roscpp, decoded by us.
#include "ros/box_source.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

namespace box_query {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr std::size_t kPlenty = 1000000;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

template <typename Message>
std::vector<std::uint8_t> wire(const Message& message) {
  namespace ser = ros::serialization;
  std::vector<std::uint8_t> bytes(ser::serializationLength(message));
  ser::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ser::serialize(stream, message);
  return bytes;
}

template <typename Message>
const BoxSource& sourceOf() {
  std::string problem;
  const BoxSource* source = findSource(ros::message_traits::datatype<Message>(),
                                       ros::message_traits::md5sum<Message>(), problem);
  EXPECT_NE(source, nullptr) << problem;
  return *source;
}

template <typename Message>
DecodedMessage decode(const Message& message, std::size_t max_boxes = kPlenty) {
  const auto bytes = wire(message);
  Limits limits;
  limits.boxes = max_boxes;
  return decodeMessage(sourceOf<Message>(), bytes.data(), bytes.size(), limits);
}

DecodedMessage decodeBytes(const std::vector<std::uint8_t>& bytes) {
  return decodeMessage(sourceOf<MarkerArray>(), bytes.data(), bytes.size(), Limits());
}

Marker cube() {
  Marker marker;
  marker.header.frame_id = "odom";
  marker.header.stamp = ros::Time(1234, 5678);
  marker.ns = "crates";
  marker.id = -3;
  marker.type = Marker::CUBE;
  marker.pose.position.x = 0.1;
  marker.pose.position.y = -0.2;
  marker.pose.position.z = 0.3;
  marker.pose.orientation.z = 0.6;
  marker.pose.orientation.w = 0.8;
  marker.scale.x = 1.0;
  marker.scale.y = 0.0;
  marker.scale.z = 3.0;
  marker.lifetime = ros::Duration(2, 500);
  marker.frame_locked = true;
  marker.text = "fragile";
  marker.colors.resize(2);
  marker.mesh_resource = "package://none";
  return marker;
}

Marker cubeList() {
  Marker marker = cube();
  marker.type = Marker::CUBE_LIST;
  marker.points.resize(3);
  marker.points[1].x = 1.0;
  marker.points[2].y = 2.0;
  return marker;
}

MarkerArray arrayOf(const std::vector<Marker>& markers) {
  MarkerArray message;
  message.markers = markers;
  return message;
}

std::size_t countOf(const BoxChange& change, Rejection why) {
  return change.rejections.at(static_cast<std::size_t>(why));
}

TEST(MarkerSource, DecodesEveryFieldOfACube) {
  const DecodedMessage message = decode(cube());
  ASSERT_EQ(message.problem, "");
  ASSERT_EQ(message.changes.size(), 1U);
  const BoxChange& change = message.changes[0];
  EXPECT_EQ(change.kind, BoxChange::Kind::kSet);
  EXPECT_EQ(change.ns, "crates");
  EXPECT_EQ(change.id, -3);
  EXPECT_EQ(change.label, "fragile");
  EXPECT_EQ(change.frame, "odom");
  EXPECT_EQ(change.stamp, ros::Time(1234, 5678));
  EXPECT_EQ(change.lifetime, 2000000500);
  EXPECT_TRUE(change.frame_locked);
  EXPECT_EQ(change.rejected(), 0U);
  ASSERT_EQ(change.boxes.size(), 1U);
  EXPECT_EQ(change.boxes[0].id, -3);
  EXPECT_EQ(change.boxes[0].box.center, Vector3(0.1, -0.2, 0.3));
  EXPECT_EQ(change.boxes[0].box.orientation.coeffs(), Eigen::Vector4d(0.0, 0.0, 0.6, 0.8));
  EXPECT_EQ(change.boxes[0].box.half_extents, Vector3(0.5, 0.0, 1.5));
}

TEST(MarkerSource, DecodesAnArrayAsItsMarkersInOrder) {
  Marker second = cube();
  second.id = 4;
  second.ns = "";
  const DecodedMessage message = decode(arrayOf({cube(), cubeList(), second}));
  ASSERT_EQ(message.problem, "");
  ASSERT_EQ(message.changes.size(), 3U);
  EXPECT_EQ(message.changes[0].id, -3);
  EXPECT_EQ(message.changes[1].boxes.size(), 3U);
  EXPECT_EQ(message.changes[2].id, 4);
  EXPECT_EQ(message.changes[2].ns, "");
  EXPECT_TRUE(decode(MarkerArray()).changes.empty());
}

TEST(MarkerSource, GivesEveryBoxOfAListItsOwnIdAndPlace) {
  Marker list = cubeList();
  list.pose.orientation.w = list.pose.orientation.z = std::sqrt(0.5);  // a quarter turn about z
  const DecodedMessage message = decode(list);
  ASSERT_EQ(message.changes.size(), 1U);
  const BoxList& boxes = message.changes[0].boxes;
  ASSERT_EQ(boxes.size(), 3U);
  EXPECT_EQ(message.changes[0].id, -3);
  EXPECT_EQ(boxes[0].id, -3);
  EXPECT_EQ(boxes[1].id, (1LL << 32) - 3);
  EXPECT_EQ(boxes[2].id, (2LL << 32) - 3);
  EXPECT_TRUE(boxes[0].box.center.isApprox(Vector3(0.1, -0.2, 0.3), 1e-15));
  EXPECT_TRUE(boxes[1].box.center.isApprox(Vector3(0.1, 0.8, 0.3), 1e-15));
  EXPECT_TRUE(boxes[2].box.center.isApprox(Vector3(-1.9, -0.2, 0.3), 1e-15));
  for (const IdentifiedBox& each : boxes) {
    EXPECT_EQ(each.box.orientation.w(), std::sqrt(0.5));
    EXPECT_EQ(each.box.half_extents, Vector3(0.5, 0.0, 1.5));
  }
}

TEST(MarkerSource, KeepsThePointsOfAnUnmovedListBitForBit) {
  Marker list = cubeList();
  list.pose = geometry_msgs::Pose();  // position and quaternion zero
  list.points[1].x = 1e6 / 3.0;
  const DecodedMessage message = decode(list);
  EXPECT_EQ(message.changes.at(0).boxes[1].box.center, Vector3(1e6 / 3.0, 0.0, 0.0));
}

TEST(MarkerSource, TakesAListWithoutPointsAsNoBoxes) {
  Marker list = cubeList();
  list.points.clear();
  const DecodedMessage message = decode(list);
  ASSERT_EQ(message.changes.size(), 1U);
  EXPECT_EQ(message.changes[0].kind, BoxChange::Kind::kSet);
  EXPECT_TRUE(message.changes[0].boxes.empty());
  EXPECT_EQ(message.changes[0].rejected(), 0U);
}

TEST(MarkerSource, TakesAZeroQuaternionAsIdentity) {
  Marker marker = cube();
  marker.pose.orientation = geometry_msgs::Quaternion();
  const DecodedMessage message = decode(marker);
  ASSERT_EQ(message.changes.at(0).boxes.size(), 1U);
  EXPECT_EQ(message.changes[0].boxes[0].box.orientation.coeffs(), Quaternion::Identity().coeffs());
}

TEST(MarkerSource, TakesLifetimesAsRvizDoes) {
  const auto lifetime = [](std::int32_t sec, std::int32_t nsec) {
    Marker marker = cube();
    marker.lifetime.sec = sec;
    marker.lifetime.nsec = nsec;
    return decode(marker).changes.at(0).lifetime;
  };
  EXPECT_EQ(lifetime(0, 0), 0);
  EXPECT_EQ(lifetime(0, 100000), 0) << "too short to mean anything";
  EXPECT_EQ(lifetime(0, 100001), 100001);
  EXPECT_EQ(lifetime(-5, 0), 0);
  EXPECT_EQ(lifetime(INT32_MAX, INT32_MAX), INT32_MAX * 1000000001LL);
}

TEST(MarkerSource, TellsActionsApart) {
  const auto kind = [](std::int32_t action) {
    Marker marker = cube();
    marker.action = action;
    marker.header.frame_id.clear();  // needed for boxes only
    marker.pose.position.x = kNan;
    return decode(marker).changes.at(0);
  };
  EXPECT_EQ(kind(Marker::DELETE).kind, BoxChange::Kind::kRemove);
  EXPECT_EQ(kind(Marker::DELETEALL).kind, BoxChange::Kind::kClear);
  EXPECT_EQ(kind(Marker::DELETE).rejected() + kind(Marker::DELETEALL).rejected(), 0U);
  for (const std::int32_t unknown : {1, 4, -1}) {
    EXPECT_EQ(kind(unknown).kind, BoxChange::Kind::kSet);
    EXPECT_EQ(countOf(kind(unknown), Rejection::kAction), 1U);
    EXPECT_TRUE(kind(unknown).boxes.empty());
  }
}

TEST(MarkerSource, CountsOtherTypesAndLetsThemReplaceABox) {
  for (const std::int32_t type : {Marker::ARROW + 0, Marker::SPHERE + 0, Marker::POINTS + 0, 77}) {
    Marker other = cubeList();
    other.type = type;
    const DecodedMessage message = decode(arrayOf({other, cube()}));
    ASSERT_EQ(message.changes.size(), 2U);
    EXPECT_EQ(message.ignored, 1U);
    EXPECT_EQ(message.changes[0].kind, BoxChange::Kind::kRemove);
    EXPECT_EQ(message.changes[0].id, -3);
    EXPECT_EQ(message.changes[1].boxes.size(), 1U);
  }
}

TEST(MarkerSource, RejectsNumbersThatAreNotFiniteAndKeepsTheRest) {
  using Field = double& (*)(Marker&);
  const Field fields[] = {
      [](Marker& m) -> double& { return m.pose.position.x; },
      [](Marker& m) -> double& { return m.pose.position.y; },
      [](Marker& m) -> double& { return m.pose.position.z; },
      [](Marker& m) -> double& { return m.pose.orientation.x; },
      [](Marker& m) -> double& { return m.pose.orientation.y; },
      [](Marker& m) -> double& { return m.pose.orientation.z; },
      [](Marker& m) -> double& { return m.pose.orientation.w; },
      [](Marker& m) -> double& { return m.scale.x; },
      [](Marker& m) -> double& { return m.scale.y; },
      [](Marker& m) -> double& { return m.scale.z; },
  };
  for (const Field field : fields) {
    for (const double bad : {kNan, kInf, -kInf}) {
      for (Marker marker : {cube(), cubeList()}) {
        const std::size_t boxes = marker.type == Marker::CUBE ? 1 : 3;
        field(marker) = bad;
        const DecodedMessage message = decode(arrayOf({marker, cube()}));
        ASSERT_EQ(message.problem, "");
        ASSERT_EQ(message.changes.size(), 2U);
        EXPECT_TRUE(message.changes[0].boxes.empty());
        EXPECT_EQ(countOf(message.changes[0], Rejection::kNotFinite), boxes);
        EXPECT_NE(message.changes[0].problem.find("box -3 of namespace 'crates'"),
                  std::string::npos)
            << message.changes[0].problem;
        EXPECT_EQ(message.changes[1].boxes.size(), 1U);
      }
    }
  }
}

TEST(MarkerSource, RejectsOnlyTheBadPointsOfAList) {
  Marker list = cubeList();
  list.points.resize(7);  // 21 numbers
  using Field = double& (*)(geometry_msgs::Point&);
  for (const Field field : {Field([](geometry_msgs::Point& p) -> double& { return p.x; }),
                            Field([](geometry_msgs::Point& p) -> double& { return p.y; }),
                            Field([](geometry_msgs::Point& p) -> double& { return p.z; })}) {
    for (std::size_t n = 0; n < list.points.size(); ++n) {
      for (const double bad : {kNan, kInf, -kInf, 3e7, -1e300}) {
        Marker damaged = list;
        field(damaged.points[n]) = bad;
        const BoxChange change = decode(damaged).changes.at(0);
        ASSERT_EQ(change.boxes.size(), 6U) << n;
        EXPECT_EQ(change.boxes[5].id, ((n < 6 ? 6LL : 5LL) << 32) - 3)
            << "identities do not move up";
        const Rejection why =
            std::abs(bad) < kInf ? Rejection::kOutOfBounds : Rejection::kNotFinite;
        EXPECT_EQ(countOf(change, why), 1U) << bad << " at " << n;
      }
    }
  }
}

TEST(MarkerSource, BoundsPlacesOfListsAndNotTheirPoints) {
  const double largest = Limits().coordinate;
  Marker list = cubeList();
  list.pose = geometry_msgs::Pose();
  const BoxChange close = decode(list).changes.at(0);
  list.points[2].x = largest;
  const BoxChange far_away = decode(list).changes.at(0);
  ASSERT_EQ(far_away.boxes.size(), 3U);
  EXPECT_EQ(far_away.boxes[2].box.center.x(), largest);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(far_away.boxes[n].id, close.boxes[n].id);
    EXPECT_EQ(far_away.boxes[n].box.center, close.boxes[n].box.center);
    EXPECT_EQ(far_away.boxes[n].box.half_extents, close.boxes[n].box.half_extents);
  }
  for (const double center : {0.0, 0.9 * largest, largest}) {
    for (const double point : {0.101 * largest, 2.0 * largest, 1e-210}) {
      list.pose.position.x = center;
      list.points = {geometry_msgs::Point(), geometry_msgs::Point()};
      list.points[1].x = point;
      const double place = center + point;
      const bool is_good = place <= largest && place >= kSmallestCoordinate;
      const BoxChange change = decode(list).changes.at(0);
      EXPECT_EQ(change.boxes.size(), is_good ? 2U : 1U) << center << " " << point;
      EXPECT_EQ(countOf(change, Rejection::kOutOfBounds), is_good ? 0U : 1U);
    }
  }
}

TEST(MarkerSource, RejectsNegativeSizesOrientationsOffUnitLengthAndBadFrames) {
  Marker negative = cube();
  negative.scale.y = -1e-300;
  EXPECT_EQ(countOf(decode(negative).changes.at(0), Rejection::kNegativeSize), 1U);
  negative.scale.y = -1e-9;
  const std::string problem = decode(negative).changes.at(0).problem;
  EXPECT_NE(problem.find("(-1e-09 m)"), std::string::npos) << problem;

  for (const double norm : {0.5, 0.98, 1.02, 1e-200, 1e200}) {
    Marker marker = cube();
    marker.pose.orientation.z = 0.6 * norm;
    marker.pose.orientation.w = 0.8 * norm;
    EXPECT_EQ(countOf(decode(marker).changes.at(0), Rejection::kOrientation), 1U) << norm;
  }
  for (const double norm : {0.9901, 1.0099}) {
    Marker marker = cube();
    marker.pose.orientation.z = 0.6 * norm;
    marker.pose.orientation.w = 0.8 * norm;
    ASSERT_EQ(decode(marker).changes.at(0).boxes.size(), 1U) << norm;
    EXPECT_EQ(decode(marker).changes.at(0).boxes[0].box.orientation.w(), 0.8 * norm);
  }
  for (const char* frame : {"", "/", "//map"}) {
    Marker list = cubeList();
    list.header.frame_id = frame;
    list.points[0].x = kNan;
    const DecodedMessage message = decode(list);
    EXPECT_TRUE(message.changes.at(0).boxes.empty());
    EXPECT_EQ(countOf(message.changes[0], Rejection::kFrame), 2U) << frame;
    EXPECT_EQ(message.changes[0].rejected(), 3U) << frame;
  }
}

TEST(MarkerSource, HalvesSidesExactly) {
  Marker marker = cube();
  marker.scale.x = 1e-200;
  marker.scale.y = std::nextafter(1e-200, 1);
  marker.scale.z = 1e7;
  const DecodedMessage message = decode(marker);
  ASSERT_EQ(message.changes.at(0).boxes.size(), 1U);
  const Vector3 half = message.changes[0].boxes[0].box.half_extents;
  EXPECT_EQ(2 * half, Vector3(marker.scale.x, marker.scale.y, marker.scale.z));
}

TEST(MarkerSource, RefusesMessagesWithTooManyBoxes) {
  EXPECT_EQ(decode(arrayOf({cube(), cubeList()}), 4).changes.size(), 2U);
  const DecodedMessage message = decode(arrayOf({cube(), cubeList()}), 3);
  EXPECT_TRUE(message.changes.empty());
  EXPECT_NE(message.problem.find("max_boxes_per_message"), std::string::npos) << message.problem;
  Marker other = cubeList();
  other.type = Marker::POINTS;
  EXPECT_EQ(decode(other, 0).problem, "") << "points of other markers are no boxes";
}

TEST(MarkerSource, RefusesMessagesCutOffAnywhereOrTooLong) {
  const std::vector<std::uint8_t> whole = wire(arrayOf({cube(), cubeList()}));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::uint8_t> cut(whole.begin(),
                                        whole.begin() + static_cast<std::ptrdiff_t>(size));
    const DecodedMessage message = decodeBytes(cut);
    ASSERT_NE(message.problem, "") << size;
    ASSERT_TRUE(message.changes.empty()) << size;
  }
  std::vector<std::uint8_t> longer = whole;
  longer.push_back(0);
  EXPECT_NE(decodeBytes(longer).problem, "");
  EXPECT_EQ(decodeBytes(whole).problem, "");
}

TEST(MarkerSource, RefusesClaimsOfMoreThanTheMessageHolds) {
  // Whatever four bytes claim 4e9 elements, characters or nanoseconds.
  const std::vector<std::uint8_t> whole = wire(arrayOf({cube(), cubeList()}));
  std::size_t refused = 0;
  for (std::size_t at = 0; at + 4 <= whole.size(); ++at) {
    std::vector<std::uint8_t> bytes = whole;
    const std::uint32_t huge = 4000000000U;
    std::memcpy(&bytes[at], &huge, sizeof huge);
    const DecodedMessage message = decodeBytes(bytes);
    refused += message.problem.empty() ? 0U : 1U;
    ASSERT_LE(message.changes.size(), 2U);
  }
  EXPECT_GE(refused, 4 * 13U) << "13 lengths, each overlapped by 4 bytes or more, and stamps";
}

TEST(MarkerSource, SurvivesAnyBytes) {
  const std::vector<std::uint8_t> whole = wire(arrayOf({cube(), cubeList(), cube()}));
  std::mt19937 random(20180301);
  std::size_t accepted = 0;
  for (int round = 0; round < 20000; ++round) {
    std::vector<std::uint8_t> bytes = whole;
    for (unsigned flips = random() % 8 + 1; flips > 0; --flips) {
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    }
    const DecodedMessage message = decodeBytes(bytes);
    accepted += message.problem.empty() ? 1U : 0U;
    for (const BoxChange& change : message.changes) {
      for (const IdentifiedBox& each : change.boxes) {
        ASSERT_TRUE(isValid(each.box));
      }
    }
  }
  EXPECT_GT(accepted, 1000U);
  EXPECT_LT(accepted, 19000U);
}

TEST(MarkerSource, KnowsTheSmallestMarker) {
  // The bound on array lengths: too large would refuse real messages.
  EXPECT_EQ(wire(Marker()).size(), 154U);
  EXPECT_EQ(decode(arrayOf(std::vector<Marker>(5))).changes.size(), 5U);
}

TEST(BoxSources, NameUnknownTypesAndTheKnownOnes) {
  std::string problem;
  EXPECT_EQ(findSource("visualization_msgs/MarkerArray", "0123", problem), nullptr);
  EXPECT_NE(problem.find("0123"), std::string::npos) << problem;
  EXPECT_NE(problem.find("d155b9ce5188fbaf89745847fd5882d7"), std::string::npos) << problem;
  EXPECT_EQ(findSource("std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1", problem), nullptr);
  EXPECT_NE(problem.find("std_msgs/String"), std::string::npos) << problem;
}

}  // namespace
}  // namespace box_query
