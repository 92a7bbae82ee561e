// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a message of any type that is understood: the first byte chooses it. It is decoded
// or refused, never more than half, and no box comes out that is not valid.
#include "fuzz/fuzz.h"
#include "ros/box_source.h"
#include "unit/foreign_messages.h"
#include "unit/marker_messages.h"

#include <algorithm>

namespace box_query::fuzz {
namespace {

/// A box takes 104 bytes on the wire at least, fewer than twice that in memory; what else is made
/// of an input, a sentence for instance, is small.
constexpr std::size_t kMemoryFactor = 16;
constexpr std::size_t kSmall = 1U << 16;
constexpr std::size_t kMaxBoxes = 1000;

const Limits& limits() {
  static const Limits some = [] {
    Limits l;
    l.boxes = kMaxBoxes;
    return l;
  }();
  return some;
}

template <typename Message>
void addSeed(const char* type, const Message& message, std::vector<Bytes>& all) {
  const std::vector<BoxSource>& sources = boxSources();
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (std::string_view(sources[i].type) == type) {
      Bytes seed = {static_cast<std::uint8_t>(i)};
      const test::Bytes bytes = test::wire(message);
      seed.insert(seed.end(), bytes.begin(), bytes.end());
      const DecodedMessage decoded =
          decodeMessage(sources[i], bytes.data(), bytes.size(), limits());
      require(decoded.problem.empty(), std::string("a seed is a good ") + type);
      all.push_back(seed);
      return;
    }
  }
  require(false, std::string("there is a source of ") + type);
}

}  // namespace

std::vector<Bytes> seeds() {
  std::vector<Bytes> all;
  const visualization_msgs::Marker list = test::cubeList();
  visualization_msgs::Marker gone = test::cube();
  gone.action = visualization_msgs::Marker::DELETEALL;
  visualization_msgs::MarkerArray markers;
  markers.markers = {test::cube(), list, gone, test::cube()};
  addSeed("visualization_msgs/MarkerArray", markers, all);
  addSeed("visualization_msgs/Marker", list, all);

  test::JskBoundingBoxArray jsk;
  jsk.boxes.resize(2);
  addSeed("jsk_recognition_msgs/BoundingBoxArray", jsk, all);
  test::VisionBoundingBox3DArray boxes;
  boxes.boxes.resize(2);
  addSeed("vision_msgs/BoundingBox3DArray", boxes, all);
  test::VisionDetection3DArray detections;
  detections.detections.resize(2);
  detections.detections[0].results.resize(2);
  addSeed("vision_msgs/Detection3DArray", detections, all);
  test::DerivedObjectArray objects;
  objects.objects.resize(2);
  objects.objects[0].shape.type = 1;
  objects.objects[0].shape.dimensions.assign(3, 1.0);
  addSeed("derived_object_msgs/ObjectArray", objects, all);
  test::AutowareObjectArray autoware;
  autoware.objects.resize(2);
  addSeed("autoware_msgs/DetectedObjectArray", autoware, all);
  test::CollisionObject object;
  object.id = "box";
  object.primitives.resize(2);
  object.primitives[0].type = 1;
  object.primitives[0].dimensions.assign(3, 1.0);
  object.primitive_poses.resize(2);
  addSeed("moveit_msgs/CollisionObject", object, all);
  test::PlanningScene scene;
  scene.collision_objects = {object, object};
  addSeed("moveit_msgs/PlanningScene", scene, all);
  return all;
}

void testOne(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return;
  }
  const std::vector<BoxSource>& sources = boxSources();
  const AllocationLimit limit(kMemoryFactor * size + kSmall);
  const DecodedMessage message =
      decodeMessage(sources[data[0] % sources.size()], data + 1, size - 1, limits());
  if (!message.problem.empty()) {
    require(message.changes.empty(), "what is refused changes nothing");
    return;
  }
  std::size_t boxes = 0;
  for (const BoxChange& change : message.changes) {
    boxes += change.boxes.size();
    for (const IdentifiedBox& each : change.boxes) {
      require(isValid(each.box), "a box that is decoded is valid");
      require(isWithin(limits().coordinate, each.box.center), "it is where it may be");
    }
    require(change.boxes.empty() || !isBadFrame(change.frame), "boxes have a frame that tf takes");
    require(std::max({change.ns.size(), change.label.size(), change.frame.size()}) <=
                limits().name_length,
            "names are no longer than allowed");
    require(change.rejected() == 0 || !change.problem().empty(), "a rejected box is explained");
  }
  require(boxes <= kMaxBoxes, "there are no more boxes than allowed");
}

}  // namespace box_query::fuzz
