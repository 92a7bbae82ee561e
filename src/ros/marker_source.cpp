// SPDX-License-Identifier: BSD-3-Clause
// visualization_msgs/Marker and MarkerArray with the meaning that rviz 1.14 gives them: a message
// is a list of changes, keyed by (ns, id). What differs, on purpose: colours do not matter here; a
// CUBE_LIST without points is an empty list, where rviz shows an error and the previous list.
#include "ros/box_source.h"

#include <visualization_msgs/Marker.h>

namespace box_query {
namespace {

using visualization_msgs::Marker;

/// Bytes of a marker whose strings and arrays are empty, of a point, and of a colour.
constexpr std::size_t kMarkerSize = 154;
constexpr std::size_t kPointSize = 24;
constexpr std::size_t kColorSize = 16;
/// From its id to whether it is locked to its frame.
constexpr std::size_t kBlockSize = 117;

/// Lifetimes up to this are forever, as in rviz. [ns]
constexpr std::int64_t kShortestLifetime = 100000;

/// Appends one marker. `boxes` counts those of the message so far.
void readMarker(WireReader& reader, const Limits& limits, std::size_t& boxes,
                DecodedMessage& message) {
  const WireHeader header = reader.header();
  const std::string_view ns = reader.name("namespace");
  BoxChange& change = message.changes.emplace_back(limits.coordinate, ns, stripSlash(header.frame));
  change.stamp = header.stamp;
  WireBlock block = reader.block<kBlockSize>();
  change.id = block.number<std::int32_t>();
  const auto type = block.number<std::int32_t>();
  const auto action = block.number<std::int32_t>();
  WireBox shape = block.box();  // of all its boxes
  if (shape.orientation.coeffs() == Eigen::Vector4d::Zero()) {
    shape.orientation.setIdentity();
  }
  block.skip(kColorSize);
  const std::int64_t lifetime = block.duration();
  change.frame_locked = block.number<std::uint8_t>() != 0;
  change.lifetime = lifetime > kShortestLifetime ? lifetime : 0;

  const WireArray points = reader.array(kPointSize);
  const bool adds = action == Marker::ADD && (type == Marker::CUBE || type == Marker::CUBE_LIST);
  if (adds) {
    boxes += type == Marker::CUBE ? 1 : points.count;
    if (boxes > limits.boxes) {
      message.problem = tooManyBoxes(limits.boxes);
      return;
    }
  }
  if (adds && type == Marker::CUBE_LIST) {
    change.addPoints(shape, points);
  }
  if (adds && type == Marker::CUBE) {
    change.add(change.id, shape.center, shape.orientation, shape.size);
  }
  reader.skip(std::uint64_t{reader.count(kColorSize)} * kColorSize);
  change.label = adds ? reader.name("text") : reader.string();
  reader.string();  // mesh_resource
  reader.skip(1);   // mesh_use_embedded_materials

  if (adds && isBadFrame(change.frame)) {
    const std::size_t good = change.boxes.size();
    change.boxes.clear();
    change.reject(Rejection::kFrame, good, "'" + std::string(header.frame) + "'", change.id);
  } else if (action == Marker::DELETEALL) {
    change.kind = BoxChange::Kind::kClear;  // whatever its ns is
  } else if (action == Marker::DELETE) {
    change.kind = BoxChange::Kind::kRemove;
  } else if (action != Marker::ADD) {
    change.reject(Rejection::kAction, 1, std::to_string(action), change.id);
  } else if (!adds) {
    change.kind = BoxChange::Kind::kRemove;  // what is no box replaces what was one
    ++message.ignored;
  }
}

}  // namespace

void decodeMarker(WireReader& reader, const Limits& limits, DecodedMessage& message) {
  std::size_t boxes = 0;
  readMarker(reader, limits, boxes, message);
}

void decodeMarkerArray(WireReader& reader, const Limits& limits, DecodedMessage& message) {
  const std::uint32_t markers = reader.count(kMarkerSize);
  message.changes.reserve(markers);
  std::size_t boxes = 0;
  for (std::uint32_t n = 0; n < markers && reader.ok() && message.problem.empty(); ++n) {
    readMarker(reader, limits, boxes, message);
  }
}

}  // namespace box_query
