// SPDX-License-Identifier: BSD-3-Clause
// Markers serialised by roscpp, decoded by us.
#include "unit/marker_messages.h"

#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace box_query::test {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

MarkerArray arrayOf(const std::vector<Marker>& markers) {
  MarkerArray message;
  message.markers = markers;
  return message;
}

DecodedMessage decodeBytes(const Bytes& bytes) {
  return test::decodeBytes("visualization_msgs/MarkerArray", bytes);
}

TEST(MarkerSource, AChangeTakesNoMoreMemoryThanAMarker) {
  EXPECT_LE(sizeof(BoxChange), sizeof(Marker));
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
        EXPECT_NE(message.changes[0].problem().find("box -3 of namespace 'crates'"),
                  std::string::npos)
            << message.changes[0].problem();
        EXPECT_EQ(message.changes[1].boxes.size(), 1U);
      }
    }
  }
}

TEST(MarkerSource, RejectsNegativeSizesOrientationsOffUnitLengthAndBadFrames) {
  Marker negative = cube();
  negative.scale.y = -1e-300;
  EXPECT_EQ(countOf(decode(negative).changes.at(0), Rejection::kNegativeSize), 1U);
  negative.scale.y = -1e-9;
  const std::string problem = decode(negative).changes.at(0).problem();
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
  const Bytes whole = wire(arrayOf({cube(), cubeList()}));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    const DecodedMessage message = decodeBytes(cut);
    ASSERT_NE(message.problem, "") << size;
    ASSERT_TRUE(message.changes.empty()) << size;
  }
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_NE(decodeBytes(longer).problem, "");
  EXPECT_EQ(decodeBytes(whole).problem, "");
}

TEST(MarkerSource, RefusesClaimsOfMoreThanTheMessageHolds) {
  // Whatever four bytes claim 4e9 elements, characters or nanoseconds.
  const Bytes whole = wire(arrayOf({cube(), cubeList()}));
  std::size_t refused = 0;
  for (std::size_t at = 0; at + 4 <= whole.size(); ++at) {
    Bytes bytes = whole;
    const std::uint32_t huge = 4000000000U;
    std::memcpy(&bytes[at], &huge, sizeof huge);
    const DecodedMessage message = decodeBytes(bytes);
    refused += message.problem.empty() ? 0U : 1U;
    ASSERT_LE(message.changes.size(), 2U);
  }
  EXPECT_GE(refused, 4 * 13U) << "13 lengths, each overlapped by 4 bytes or more, and stamps";
}

TEST(MarkerSource, SurvivesAnyBytes) {
  const Bytes whole = wire(arrayOf({cube(), cubeList(), cube()}));
  std::mt19937 random(20180301);
  std::size_t accepted = 0;
  for (int round = 0; round < 20000; ++round) {
    Bytes bytes = whole;
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
}  // namespace box_query::test
