// SPDX-License-Identifier: BSD-3-Clause
#include "ros/marker_shapes.h"
#include "unit/answer_fixture.h"

#include <map>

#include <gtest/gtest.h>

namespace box_query::test {
namespace {

using visualization_msgs::Marker;

std::map<std::string, Marker> byNamespace(const std::vector<Marker>& markers) {
  std::map<std::string, Marker> result;
  for (const Marker& marker : markers) {
    EXPECT_TRUE(result.emplace(marker.ns, marker).second) << marker.ns << " twice";
    EXPECT_EQ(marker.header.frame_id, "map");
  }
  return result;
}

TEST(BoxMarkers, AreTwoListsATopicAndNotAMarkerABox) {
  const auto markers = byNamespace(boxMarkers(smallSnapshot()));
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
  const auto markers = byNamespace(boxMarkers(snapshot));
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
  const auto markers = byNamespace(boxMarkers(snapshot));
  const auto& edges = markers.at("edges//a").points;
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    EXPECT_GE((fromMessage(edges[i]) - fromMessage(edges[i + 1])).norm(), 0.009);
  }
}

TEST(BoxMarkers, OfTopicsThatHaveVanishedAreDeleted) {
  const Snapshot before = smallSnapshot();
  Snapshot now = smallSnapshot();
  now.names.resize(3);
  now.scene = Scene({cubeAt(2, 0, 0, 0.5), cubeAt(4, 0, 0, 0.5), cubeAt(6, 0, 0, 0.5)});
  const auto deleted = byNamespace(deletedBoxMarkers(before, now));
  ASSERT_EQ(deleted.size(), 2U);
  EXPECT_EQ(deleted.at("boxes//b").action, Marker::DELETE);
  EXPECT_EQ(deleted.at("edges//b").action, Marker::DELETE);
  EXPECT_EQ(deleted.at("edges//b").id, boxMarkers(before).back().id);
  EXPECT_TRUE(deletedBoxMarkers(now, now).empty());
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
