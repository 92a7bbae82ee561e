// SPDX-License-Identifier: BSD-3-Clause
#include "ros/marker_shapes.h"
#include "unit/answer_fixture.h"

#include <map>

#include <gtest/gtest.h>

namespace box_query::test {
namespace {

using visualization_msgs::Marker;

const ros::Time kNow(101);

std::map<std::string, Marker> byNamespace(const std::vector<Marker>& markers) {
  std::map<std::string, Marker> result;
  for (const Marker& marker : markers) {
    EXPECT_TRUE(result.emplace(marker.ns, marker).second) << marker.ns << " twice";
    EXPECT_EQ(marker.header.frame_id, "map");
  }
  return result;
}

TEST(BoxMarkers, AreTwoListsATopicAndNotAMarkerABox) {
  const auto markers = byNamespace(boxMarkers(smallSnapshot(), kNow, 0));
  ASSERT_EQ(markers.size(), 4U);
  const Marker& faces = markers.at("boxes//a");
  const Marker& edges = markers.at("edges//a");
  EXPECT_EQ(faces.type, Marker::TRIANGLE_LIST);
  EXPECT_EQ(faces.points.size(), 3U * 36);
  EXPECT_EQ(edges.type, Marker::LINE_LIST);
  EXPECT_EQ(edges.points.size(), 3U * 24);
  EXPECT_EQ(markers.at("boxes//b").points.size(), 36U);
  EXPECT_EQ(faces.lifetime, ros::Duration(0));
}

TEST(BoxMarkers, TrianglesCloseTheSolidAndFaceOutward) {
  Snapshot snapshot = randomSnapshot(20, 6);
  const auto markers = byNamespace(boxMarkers(snapshot, kNow, 0));
  const auto& points = markers.at("boxes//a").points;
  ASSERT_EQ(points.size(), 20U * 36);
  for (std::size_t b = 0; b < 20; ++b) {
    const auto& box = std::get<OrientedBox>(snapshot.scene.boxes()[b]);
    double volume = 0;  // by the divergence theorem: negative where triangles face inward
    for (std::size_t i = 36 * b; i < 36 * (b + 1); i += 3) {
      const Vector3 p = fromMessage(points[i]) - box.center;
      const Vector3 q = fromMessage(points[i + 1]) - box.center;
      const Vector3 r = fromMessage(points[i + 2]) - box.center;
      EXPECT_GE(p.dot(q.cross(r)), -1e-12);
      volume += p.dot(q.cross(r)) / 6;
    }
    EXPECT_NEAR(volume, 8 * box.half_extents.prod(), 1e-10);
  }
}

TEST(BoxMarkers, APointAndAFlatBoxHaveEdgesThatAreSeen) {
  Snapshot snapshot = smallSnapshot();
  snapshot.scene = Scene({cubeAt(1, 2, 3, 0), AlignedBox{{0, 0, 1}, {4, 4, 1}},
                          cubeAt(0, 0, 0, 1e-9), cubeAt(0, 0, 0, 1)});
  const auto markers = byNamespace(boxMarkers(snapshot, kNow, 0));
  const auto& edges = markers.at("edges//a").points;
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    EXPECT_GE((fromMessage(edges[i]) - fromMessage(edges[i + 1])).norm(), 0.009);
  }
}

TEST(BoxMarkers, ThatAreNoMoreAreDeleted) {
  const auto before = boxMarkers(smallSnapshot(), kNow, 4);
  Snapshot now = smallSnapshot();
  now.names.resize(3);
  now.scene = Scene({cubeAt(2, 0, 0, 0.5), cubeAt(4, 0, 0, 0.5), cubeAt(6, 0, 0, 0.5)});
  const auto markers = boxMarkers(now, kNow, 3);
  const auto deleted = byNamespace(deletions(namesOf(before), markers, "map"));
  ASSERT_EQ(deleted.size(), 3U);
  for (const char* ns : {"boxes//b", "edges//b", "labels//b"}) {
    EXPECT_EQ(deleted.at(ns).action, Marker::DELETE);
    EXPECT_EQ(deleted.at(ns).id, 0);
  }
  EXPECT_TRUE(deletions(namesOf(markers), markers, "map").empty());
}

TEST(BoxMarkers, ThatWaitLookDifferent) {
  Snapshot snapshot = smallSnapshot();
  snapshot.outdated = {1};
  snapshot.topics[0].waiting = 1;
  std::map<std::string, std::vector<Marker>> markers;
  for (const Marker& marker : boxMarkers(snapshot, kNow, 0)) {
    markers[marker.ns].push_back(marker);
  }
  EXPECT_EQ(markers["boxes//a"].at(0).points.size(), 2U * 36);
  ASSERT_EQ(markers["waiting//a"].size(), 2U) << "faces and edges";
  EXPECT_EQ(markers["waiting//a"][0].points.size(), 36U);
  EXPECT_EQ(markers["waiting//a"][0].points[0], boxMarkers(smallSnapshot(), kNow, 0)[0].points[36]);
  EXPECT_NE(markers["waiting//a"][0].id, markers["waiting//a"][1].id);
  EXPECT_NE(markers["waiting//a"][1].color, markers["edges//a"].at(0).color);
  EXPECT_EQ(markers.count("waiting//b"), 0U);
  ASSERT_EQ(markers["status"].size(), 1U);
  EXPECT_EQ(markers["status"][0].text, snapshot.topics[0].parameters.topic + ": 1 waiting for tf");
}

TEST(BoxMarkers, OfAStaleTopicLookDifferent) {
  Snapshot snapshot = smallSnapshot();
  snapshot.topics[0].heard = true;
  snapshot.topics[0].last_message = ros::Time(99);
  snapshot.topics[0].parameters.timeout = 2;
  const auto fresh = byNamespace(boxMarkers(snapshot, kNow, 0));
  EXPECT_EQ(fresh.count("boxes//a"), 1U);
  EXPECT_EQ(fresh.count("status"), 0U);
  std::map<std::string, Marker> stale;
  for (const Marker& marker : boxMarkers(snapshot, kNow + ros::Duration(0, 1), 0)) {
    stale.emplace(marker.ns, marker);
  }
  EXPECT_EQ(stale.count("boxes//a") + stale.count("edges//a"), 0U);
  ASSERT_EQ(stale.count("stale//a"), 1U);
  EXPECT_LT(stale["stale//a"].color.a, fresh.at("boxes//a").color.a);
  EXPECT_EQ(stale["stale//a"].points.size(), 3U * 36);
  EXPECT_EQ(stale.count("boxes//b"), 1U);
  EXPECT_EQ(stale["status"].text, "/a: stale");
}

TEST(BoxMarkers, HaveTheirLabelsAboveThemWhereThatIsAskedFor) {
  Snapshot snapshot = smallSnapshot();
  snapshot.names[0].label = "a crate";
  snapshot.names[1].label = "";
  std::vector<Marker> labels;
  for (const Marker& marker : boxMarkers(snapshot, kNow, 2)) {
    if (marker.ns == "labels//a") {
      labels.push_back(marker);
    }
  }
  ASSERT_EQ(labels.size(), 2U);
  EXPECT_EQ(labels[0].type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(labels[0].text, "a crate");
  EXPECT_EQ(labels[0].pose.position.x, 2);
  EXPECT_GT(labels[0].pose.position.z, 0.5);
  EXPECT_EQ(labels[1].text, snapshot.names[1].ns + "/" + std::to_string(snapshot.names[1].id));
  EXPECT_NE(labels[0].id, labels[1].id);
}

TEST(QueryMarkers, AreColouredByOutcomeAndLeaveOutWhatIsUndefined) {
  DrawnQuery hit;
  hit.outcome = Outcome::kMet;
  hit.start = Vector3(0, 0, 0);
  hit.end = hit.hit = Vector3(1, 0, 0);
  hit.normal = Vector3(-1, 0, 0);
  DrawnQuery miss;
  miss.outcome = Outcome::kFree;
  miss.start = Vector3(0, 0, 0);
  miss.end = Vector3(0, 10, 0);
  DrawnQuery segment = miss;
  segment.kind = DrawnQuery::Kind::kSegment;
  segment.outcome = Outcome::kUnknown;
  segment.on_segment = Vector3(0, 1, 0);
  segment.on_box = Vector3(0, 1, 1);
  DrawnQuery overflown = miss;
  overflown.end.x() = kInf;
  const auto markers = byNamespace(queryMarkers({hit, miss, segment, overflown}, "map", 5.0, 3));
  ASSERT_EQ(markers.size(), 5U);
  for (const auto& [ns, marker] : markers) {
    EXPECT_EQ(marker.lifetime, ros::Duration(5.0)) << ns;
    EXPECT_EQ(marker.id, 3) << ns;
  }
  const Marker& rays = markers.at("rays");
  ASSERT_EQ(rays.points.size(), 4U);
  ASSERT_EQ(rays.colors.size(), 4U);
  EXPECT_GT(rays.colors[0].r, rays.colors[0].g);
  EXPECT_GT(rays.colors[2].g, rays.colors[2].r);
  EXPECT_EQ(markers.at("segments").points.size(), 2U);
  EXPECT_EQ(markers.at("hits").points.size(), 1U);
  EXPECT_EQ(markers.at("normals").points.size(), 2U);
  EXPECT_EQ(markers.at("closest_points").points.size(), 2U);
  EXPECT_TRUE(queryMarkers({}, "map", 5.0, 4).empty());
}

}  // namespace
}  // namespace box_query::test
