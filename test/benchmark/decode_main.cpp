// SPDX-License-Identifier: BSD-3-Clause
// Decoding of box messages beside roscpp's own decoding of the same bytes.
#include "benchmark/timing.h"
#include "ros/box_source.h"
#include "unit/foreign_messages.h"

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <ros/serialization.h>
#include <visualization_msgs/MarkerArray.h>

namespace box_query::benchmark {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Which boxes a message is filled with: longer names than a short string holds, as robots have.
constexpr const char* kFrame = "front_lidar_optical_frame";

geometry_msgs::Pose poseOf(int n) {
  geometry_msgs::Pose pose;
  pose.position.x = 0.1 * n;
  pose.orientation.z = 0.6;
  pose.orientation.w = 0.8;
  return pose;
}

geometry_msgs::Vector3 sizeOf(int n) {
  geometry_msgs::Vector3 size;
  size.x = size.y = size.z = 1.0 + n % 7;
  return size;
}

template <class Message>
Message inFrame() {
  Message message;
  message.header.frame_id = kFrame;
  message.header.stamp = ros::Time(1000, 1);
  return message;
}

visualization_msgs::MarkerArray markerArray(int boxes) {
  visualization_msgs::MarkerArray array;
  for (int n = 0; n < boxes; ++n) {
    auto marker = inFrame<visualization_msgs::Marker>();
    marker.ns = "pallets";
    marker.id = n;
    marker.type = visualization_msgs::Marker::CUBE;
    marker.pose = poseOf(n);
    marker.scale = sizeOf(n);
    marker.text = "pallet";
    array.markers.push_back(marker);
  }
  return array;
}

visualization_msgs::MarkerArray cubeList(int boxes) {
  visualization_msgs::MarkerArray array = markerArray(1);
  array.markers[0].type = visualization_msgs::Marker::CUBE_LIST;
  for (int n = 0; n < boxes; ++n) {
    array.markers[0].points.push_back(poseOf(n).position);
  }
  return array;
}

test::JskBoundingBoxArray jskArray(int boxes) {
  auto array = inFrame<test::JskBoundingBoxArray>();
  for (int n = 0; n < boxes; ++n) {
    auto box = inFrame<test::JskBoundingBox>();
    box.pose = poseOf(n);
    box.dimensions = sizeOf(n);
    box.label = static_cast<std::uint32_t>(n % 5);
    array.boxes.push_back(box);
  }
  return array;
}

test::VisionBoundingBox3DArray visionBoxes(int boxes) {
  auto array = inFrame<test::VisionBoundingBox3DArray>();
  for (int n = 0; n < boxes; ++n) {
    array.boxes.push_back({poseOf(n), sizeOf(n)});
  }
  return array;
}

test::VisionDetection3DArray visionDetections(int boxes) {
  auto array = inFrame<test::VisionDetection3DArray>();
  for (int n = 0; n < boxes; ++n) {
    auto detection = inFrame<test::VisionDetection3D>();
    detection.results.resize(2);
    detection.results[1].id = n % 5;
    detection.results[1].score = 0.5;
    detection.bbox = {poseOf(n), sizeOf(n)};
    array.detections.push_back(detection);
  }
  return array;
}

test::DerivedObjectArray derivedObjects(int boxes) {
  auto array = inFrame<test::DerivedObjectArray>();
  for (int n = 0; n < boxes; ++n) {
    auto object = inFrame<test::DerivedObject>();
    object.id = static_cast<std::uint32_t>(n);
    object.object_classified = 1;
    object.classification = static_cast<std::uint8_t>(n % 5);
    object.pose = poseOf(n);
    object.shape.type = 1;
    object.shape.dimensions = {1.0, 2.0, 3.0};
    array.objects.push_back(object);
  }
  return array;
}

test::AutowareObjectArray autowareObjects(int boxes) {
  auto array = inFrame<test::AutowareObjectArray>();
  for (int n = 0; n < boxes; ++n) {
    auto object = inFrame<test::AutowareObject>();
    object.id = static_cast<std::uint32_t>(n);
    object.label = n % 5 == 0 ? "truck" : "car";
    object.valid = 1;
    object.pose = poseOf(n);
    object.dimensions = sizeOf(n);
    array.objects.push_back(object);
  }
  return array;
}

test::CollisionObject collisionObject(int boxes) {
  auto object = inFrame<test::CollisionObject>();
  object.id = "shelf";
  object.pose = poseOf(0);
  for (int n = 0; n < boxes; ++n) {
    object.primitives.push_back({1, {1.0, 2.0, 3.0}});
    object.primitive_poses.push_back(poseOf(n));
  }
  return object;
}

std::size_t boxesOf(const DecodedMessage& message) {
  std::size_t boxes = 0;
  for (const BoxChange& change : message.changes) {
    boxes += change.boxes.size();
  }
  return boxes;
}

template <class Message>
void measure(const char* name, const char* type, Message (*make)(int), int boxes, int rounds) {
  namespace ser = ros::serialization;
  Bytes bytes;
  {
    const Message message = make(boxes);
    bytes.resize(ser::serializationLength(message));
    ser::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    ser::serialize(stream, message);
  }
  const BoxSource* source = nullptr;
  for (const BoxSource& each : boxSources()) {
    source = std::string(each.type) == type ? &each : source;
  }
  const Limits limits;  // the node has them from its start
  if (!source || boxesOf(decodeMessage(*source, bytes.data(), bytes.size(), limits)) !=
                     static_cast<std::size_t>(boxes)) {
    throw std::runtime_error(std::string(type) + " is not decoded as it should be");
  }
  const Pass roscpp = [&bytes] {
    Message message;
    ser::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    ser::deserialize(stream, message);
    return stream.getLength() + std::uint64_t{1};
  };
  const Pass ours = [&bytes, &limits, source] {
    const DecodedMessage message = decodeMessage(*source, bytes.data(), bytes.size(), limits);
    return message.problem.size() + 1;
  };
  const auto timing = timeSideBySide({roscpp, ours}, static_cast<std::size_t>(boxes), rounds, 0);
  std::printf("%-20s %7d %9.1f %9.1f %7.2f (%.2f to %.2f)\n", name, boxes, timing[0].ns.median,
              timing[1].ns.median, timing[1].ratio.median, timing[1].ratio.low,
              timing[1].ratio.high);
  std::fflush(stdout);
}

/// For both: else glibc hands the megabytes of large messages back to the system after some of
/// them, and what is measured is how it gets them again. The node keeps such as those of 10,000
/// boxes.
void keepMemory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 25);
  mallopt(M_TRIM_THRESHOLD, 1 << 29);
#endif
}

/// Of all types, or of the one with that name.
int run(int rounds, const std::string& only) {
  bool is_known = false;
  std::printf("%-20s %7s %9s %9s %7s\n", "ns a box", "boxes", "roscpp", "box_query", "ratio");
  for (const int boxes : {1, 10, 100, 1000, 10000, 100000}) {
    const auto one = [&](const char* name, const char* type, auto make) {
      if (only.empty() || only == name) {
        is_known = true;
        measure(name, type, make, boxes, rounds);
      }
    };
    one("MarkerArray", "visualization_msgs/MarkerArray", markerArray);
    one("CUBE_LIST", "visualization_msgs/MarkerArray", cubeList);
    one("jsk", "jsk_recognition_msgs/BoundingBoxArray", jskArray);
    one("BoundingBox3DArray", "vision_msgs/BoundingBox3DArray", visionBoxes);
    one("Detection3DArray", "vision_msgs/Detection3DArray", visionDetections);
    one("ObjectArray", "derived_object_msgs/ObjectArray", derivedObjects);
    one("DetectedObjectArray", "autoware_msgs/DetectedObjectArray", autowareObjects);
    one("CollisionObject", "moveit_msgs/CollisionObject", collisionObject);
  }
  return is_known ? 0 : 2;
}

}  // namespace
}  // namespace box_query::benchmark

int main(int argc, char** argv) {
  const std::string usage =
      "Decodes box messages beside roscpp's own decoding of the same bytes: nanoseconds a box, and "
      "the ratio\n"
      "of the two with its quartiles (below 1: box_query is faster).\n\n"
      "  --rounds N   of turns (default 51)\n"
      "  --only NAME  of the types, as the table names them, alone in the process\n";
  int rounds = 51;
  std::string only;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    rounds = option == "--rounds" ? std::atoi(argv[i + 1]) : rounds;
    only = option == "--only" ? argv[i + 1] : only;
    if (rounds <= 0 || (option != "--rounds" && option != "--only")) {
      std::fputs(usage.c_str(), stderr);
      return 2;
    }
  }
  if (argc % 2 == 0) {
    const bool asked = argc == 2 && std::string(argv[1]) == "--help";
    std::fputs(usage.c_str(), asked ? stdout : stderr);
    return asked ? 0 : 2;
  }
  box_query::benchmark::keepMemory();
  return box_query::benchmark::run(rounds, only);
}
