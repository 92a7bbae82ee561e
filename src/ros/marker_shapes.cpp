// SPDX-License-Identifier: BSD-3-Clause
#include "ros/marker_shapes.h"

#include "ros/conversions.h"

#include <array>
#include <limits>
#include <set>
#include <utility>

namespace box_query {
namespace {

using visualization_msgs::Marker;

constexpr double kEdgeWidth = 0.01;    // [m]
constexpr double kQueryWidth = 0.015;  // [m]
constexpr double kPointSize = 0.06;    // [m]
constexpr double kNormalLength = 0.3;  // [m]
constexpr double kTextHeight = 0.15;   // [m]
constexpr double kStatusHeight = 1.0;  // [m] above the origin

std_msgs::ColorRGBA color(float r, float g, float b, float a) {
  std_msgs::ColorRGBA rgba;
  rgba.r = r;
  rgba.g = g;
  rgba.b = b;
  rgba.a = a;
  return rgba;
}

/// Told apart by most eyes, and none of them a colour of an outcome.
std_msgs::ColorRGBA topicColor(std::size_t topic, float alpha) {
  switch (topic % 4) {
    case 0:
      return color(0.35F, 0.55F, 0.85F, alpha);
    case 1:
      return color(0.75F, 0.55F, 0.35F, alpha);
    case 2:
      return color(0.60F, 0.45F, 0.75F, alpha);
    default:
      return color(0.60F, 0.60F, 0.60F, alpha);
  }
}

std_msgs::ColorRGBA outcomeColor(Outcome outcome) {
  switch (outcome) {
    case Outcome::kFree:
      return color(0.1F, 0.8F, 0.2F, 1);
    case Outcome::kMet:
      return color(0.9F, 0.1F, 0.1F, 1);
    default:
      return color(0.95F, 0.8F, 0.1F, 1);
  }
}

/// Without a stamp: rviz places it by the latest transform.
Marker marker(const std::string& frame, const MarkerName& name, int type) {
  Marker m;
  m.header.frame_id = frame;
  m.ns = name.ns;
  m.id = name.id;
  m.type = type;
  m.pose.orientation.w = 1;
  m.scale.x = m.scale.y = m.scale.z = 1;
  return m;
}

/// Corner `c`: bit i is set on the positive side of axis i.
using Corners = std::array<geometry_msgs::Point, 8>;

template <class ToWorld>
Corners cornersOf(const Vector3& min, const Vector3& max, const ToWorld& toWorld) {
  Corners corners;
  for (unsigned c = 0; c < 8; ++c) {
    const Vector3 corner((c & 1U) != 0 ? max.x() : min.x(), (c & 2U) != 0 ? max.y() : min.y(),
                         (c & 4U) != 0 ? max.z() : min.z());
    corners[c] = toPoint(toWorld(corner));
  }
  return corners;
}

/// The corners of a box grown, where need be, to half extents of at least `least`.
Corners cornersOf(const AlignedBox& box, double least) {
  const Vector3 center = 0.5 * box.min + 0.5 * box.max;
  return cornersOf(box.min.cwiseMin(Vector3(center.array() - least)),
                   box.max.cwiseMax(Vector3(center.array() + least)),
                   [](const Vector3& corner) { return corner; });
}

Corners cornersOf(const OrientedBox& box, double least) {
  const Vector3 half = box.half_extents.cwiseMax(least);
  const Eigen::Matrix3d rotation = box.orientation.normalized().toRotationMatrix();
  return cornersOf(-half, half,
                   [&](const Vector3& corner) { return Vector3(box.center + rotation * corner); });
}

Corners cornersOf(const Box& box, double least) {
  return std::visit([least](const auto& solid) { return cornersOf(solid, least); }, box);
}

void appendTriangles(const Corners& corners, std::vector<geometry_msgs::Point>& points) {
  // Four corners a face, counter-clockwise from outside.
  constexpr unsigned kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& face : kFaces) {
    for (const unsigned corner : {0, 1, 2, 0, 2, 3}) {
      points.push_back(corners[face[corner]]);
    }
  }
}

void appendEdges(const Corners& corners, std::vector<geometry_msgs::Point>& points) {
  for (unsigned c = 0; c < 8; ++c) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if ((c & axis) == 0) {
        points.push_back(corners[c]);
        points.push_back(corners[c | axis]);
      }
    }
  }
}

/// Faces and edges of boxes, as two lists.
struct Solids {
  Solids(const std::string& frame, const MarkerName& faces_name, const MarkerName& edges_name)
      : faces(marker(frame, faces_name, Marker::TRIANGLE_LIST)),
        edges(marker(frame, edges_name, Marker::LINE_LIST)) {
    edges.scale.x = kEdgeWidth;
  }
  void reserve(std::size_t boxes) {
    faces.points.reserve(36 * boxes);
    edges.points.reserve(24 * boxes);
  }
  void add(const Box& box) {
    appendTriangles(cornersOf(box, 0), faces.points);
    appendEdges(cornersOf(box, kEdgeWidth / 2), edges.points);
  }
  void moveTo(std::vector<Marker>& markers) {
    if (!faces.points.empty()) {
      markers.push_back(std::move(faces));
      markers.push_back(std::move(edges));
    }
  }

  Marker faces;
  Marker edges;
};

/// The label of a box, above it.
Marker labelOf(const Snapshot& snapshot, std::size_t box, std::int32_t id) {
  const BoxName& name = snapshot.names[box];
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = -low;
  for (const geometry_msgs::Point& corner : cornersOf(snapshot.scene.boxes()[box], 0)) {
    low = low.cwiseMin(fromMessage(corner));
    high = high.cwiseMax(fromMessage(corner));
  }
  Vector3 at = 0.5 * low + 0.5 * high;
  at.z() = high.z() + kTextHeight;
  return textMarker(snapshot.frame, {"labels/" + name.topic, id},
                    name.label.empty() ? name.ns + "/" + std::to_string(name.id) : name.label, at);
}

/// Calls `visit(topic, begin, end)` for the range of boxes of every topic that has some.
template <class Visit>
void forEachTopic(const Snapshot& snapshot, const Visit& visit) {
  const std::vector<BoxName>& names = snapshot.names;
  for (std::size_t begin = 0, end = 0; begin < names.size(); begin = end) {
    while (end < names.size() && names[end].topic == names[begin].topic) {
      ++end;
    }
    visit(names[begin].topic, begin, end);
  }
}

std::size_t indexOfTopic(const Snapshot& snapshot, const std::string& topic) {
  std::size_t index = 0;
  while (index < snapshot.topics.size() && snapshot.topics[index].parameters.topic != topic) {
    ++index;
  }
  return index;
}

}  // namespace

Marker textMarker(const std::string& frame, const MarkerName& name, const std::string& words,
                  const Vector3& at) {
  Marker m = marker(frame, name, Marker::TEXT_VIEW_FACING);
  m.text = words;
  m.pose.position = toPoint(at);
  m.scale.z = kTextHeight;
  m.color = color(1, 1, 1, 1);
  return m;
}

std::string statusText(const Snapshot& snapshot, const ros::Time& now) {
  std::string text;
  for (const TopicState& topic : snapshot.topics) {
    std::string line;
    const auto add = [&](const std::string& what) { line += (line.empty() ? "" : ", ") + what; };
    if (!topic.heard && topic.parameters.required) {
      add("not heard");
    }
    if (topic.isStale(now)) {
      add("stale");
    }
    if (topic.waiting > 0) {
      add(std::to_string(topic.waiting) + " waiting for tf");
    }
    if (topic.rejected > 0) {
      add(std::to_string(topic.rejected) + " rejected");
    }
    if (line.empty()) {
      add(topic.problem);
    }
    if (!line.empty()) {
      text += (text.empty() ? "" : "\n") + topic.parameters.topic + ": " + line;
    }
  }
  return text;
}

std::vector<Marker> boxMarkers(const Snapshot& snapshot, const ros::Time& now,
                               std::size_t max_labels) {
  std::vector<Marker> markers;
  const std::vector<Box>& boxes = snapshot.scene.boxes();
  auto outdated = snapshot.outdated.begin();
  forEachTopic(snapshot, [&](const std::string& topic, std::size_t begin, std::size_t end) {
    const std::size_t index = indexOfTopic(snapshot, topic);
    const bool is_stale = index < snapshot.topics.size() && snapshot.topics[index].isStale(now);
    Solids current = is_stale
                         ? Solids(snapshot.frame, {"stale/" + topic, 0}, {"stale/" + topic, 1})
                         : Solids(snapshot.frame, {"boxes/" + topic, 0}, {"edges/" + topic, 0});
    current.faces.color = topicColor(index, is_stale ? 0.1F : 0.5F);
    current.edges.color = topicColor(index, is_stale ? 0.4F : 1.0F);
    Solids waiting(snapshot.frame, {"waiting/" + topic, 0}, {"waiting/" + topic, 1});
    waiting.faces.color = topicColor(index, 0.2F);
    waiting.edges.color = outcomeColor(Outcome::kUnknown);
    current.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      const bool waits = outdated != snapshot.outdated.end() && *outdated == i;
      outdated += waits ? 1 : 0;
      (waits ? waiting : current).add(boxes[i]);
      if (i < max_labels) {
        markers.push_back(labelOf(snapshot, i, static_cast<std::int32_t>(i - begin)));
      }
    }
    current.moveTo(markers);
    waiting.moveTo(markers);
  });
  const std::string status = statusText(snapshot, now);
  if (!status.empty()) {
    markers.push_back(
        textMarker(snapshot.frame, {"status", 0}, status, Vector3(0, 0, kStatusHeight)));
    markers.back().color = outcomeColor(Outcome::kUnknown);
  }
  return markers;
}

std::vector<MarkerName> namesOf(const std::vector<Marker>& markers) {
  std::vector<MarkerName> names;
  names.reserve(markers.size());
  for (const Marker& m : markers) {
    names.push_back({m.ns, m.id});
  }
  return names;
}

std::vector<Marker> deletions(const std::vector<MarkerName>& before,
                              const std::vector<Marker>& markers, const std::string& frame) {
  std::set<std::pair<std::string, std::int32_t>> there;
  for (const Marker& m : markers) {
    there.emplace(m.ns, m.id);
  }
  std::vector<Marker> gone;
  for (const MarkerName& name : before) {
    if (there.count({name.ns, name.id}) == 0) {
      gone.push_back(marker(frame, name, Marker::CUBE));
      gone.back().action = Marker::DELETE;
    }
  }
  return gone;
}

std::vector<Marker> queryMarkers(const std::vector<DrawnQuery>& queries, const std::string& frame,
                                 double lifetime, std::int32_t id) {
  Marker rays = marker(frame, {"rays", id}, Marker::LINE_LIST);
  Marker segments = marker(frame, {"segments", id}, Marker::LINE_LIST);
  Marker hits = marker(frame, {"hits", id}, Marker::SPHERE_LIST);
  Marker normals = marker(frame, {"normals", id}, Marker::LINE_LIST);
  Marker closest = marker(frame, {"closest_points", id}, Marker::LINE_LIST);
  rays.scale.x = segments.scale.x = normals.scale.x = closest.scale.x = kQueryWidth;
  hits.scale.x = hits.scale.y = hits.scale.z = kPointSize;
  rays.color = segments.color = color(1, 1, 1, 1);
  hits.color = color(0.9F, 0.1F, 0.1F, 1);
  normals.color = color(0.2F, 0.3F, 1, 1);
  closest.color = color(1, 1, 1, 1);

  const auto append = [](const Vector3& from, const Vector3& to, Marker& lines) {
    const bool finite = from.allFinite() && to.allFinite();
    if (finite) {
      lines.points.push_back(toPoint(from));
      lines.points.push_back(toPoint(to));
    }
    return finite;
  };
  for (const DrawnQuery& query : queries) {
    Marker& lines = query.kind == DrawnQuery::Kind::kRay ? rays : segments;
    if (append(query.start, query.end, lines)) {
      lines.colors.insert(lines.colors.end(), 2, outcomeColor(query.outcome));
    }
    if (query.hit.allFinite()) {
      hits.points.push_back(toPoint(query.hit));
    }
    append(query.hit, query.hit + kNormalLength * query.normal, normals);
    append(query.on_segment, query.on_box, closest);
  }
  std::vector<Marker> markers;
  for (Marker* m : {&rays, &segments, &hits, &normals, &closest}) {
    if (!m->points.empty()) {
      m->lifetime = ros::Duration(lifetime);
      markers.push_back(std::move(*m));
    }
  }
  return markers;
}

}  // namespace box_query
