// SPDX-License-Identifier: BSD-3-Clause
#include "load/messages.h"

#include "ros/box_source.h"
#include "ros/conversions.h"
#include "unit/foreign_messages.h"

#include <map>
#include <stdexcept>

#include <visualization_msgs/MarkerArray.h>

namespace box_query::load {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

geometry_msgs::Pose poseOf(const OrientedBox& box) {
  return toPose(box.center, box.orientation);
}

geometry_msgs::Vector3 sizeOf(const OrientedBox& box) {
  return toVector3(2 * box.half_extents);
}

geometry_msgs::Pose identity() {
  geometry_msgs::Pose pose;
  pose.orientation.w = 1.0;
  return pose;
}

template <class Message>
Message inFrame(const std::string& frame, const ros::Time& stamp) {
  Message message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  return message;
}

/// Makes the messages of one topic at one time.
struct Writer {
  std::string frame;
  ros::Time stamp;
  std::vector<KnownBox> boxes;

  template <class Message>
  Message start() const {
    return inFrame<Message>(frame, stamp);
  }

  Marker marker(const KnownBox& known, int type) const {
    auto one = start<Marker>();
    one.ns = one.text = known.label;
    one.id = static_cast<std::int32_t>(known.id);
    one.type = type;
    one.pose = poseOf(known.box);
    one.scale = sizeOf(known.box);
    return one;
  }

  MarkerArray cubes() const {
    MarkerArray array;
    for (const KnownBox& known : boxes) {
      array.markers.push_back(marker(known, Marker::CUBE));
    }
    return array;
  }

  MarkerArray cubeList() const {
    MarkerArray array;
    Marker list = marker(boxes.front(), Marker::CUBE_LIST);
    list.pose = identity();
    for (std::size_t i = 0; i + 1 < boxes.size(); ++i) {
      list.points.push_back(toPoint(boxes[i].box.center));
    }
    array.markers = {list, marker(boxes.back(), Marker::CUBE)};
    return array;
  }

  test::JskBoundingBoxArray jsk() const {
    auto array = start<test::JskBoundingBoxArray>();
    for (const KnownBox& known : boxes) {
      auto box = start<test::JskBoundingBox>();
      box.pose = poseOf(known.box);
      box.dimensions = sizeOf(known.box);
      box.label = static_cast<std::uint32_t>(std::stoul(known.ns));
      array.boxes.push_back(box);
    }
    return array;
  }

  test::VisionDetection3DArray detections() const {
    auto array = start<test::VisionDetection3DArray>();
    for (const KnownBox& known : boxes) {
      test::VisionDetection3D detection;
      detection.results.resize(1);
      detection.results[0].id = std::stol(known.ns);
      detection.bbox = {poseOf(known.box), sizeOf(known.box)};
      array.detections.push_back(detection);
    }
    return array;
  }

  test::DerivedObjectArray objects() const {
    static const std::map<std::string, std::uint8_t> classes = {
        {"CAR", 6}, {"TRUCK", 7}, {"BARRIER", 10}};
    auto array = start<test::DerivedObjectArray>();
    for (const KnownBox& known : boxes) {
      test::DerivedObject object;
      object.id = static_cast<std::uint32_t>(known.id);
      object.object_classified = 1;
      object.classification = classes.at(known.ns);
      object.pose = poseOf(known.box);
      const Vector3 size = 2 * known.box.half_extents;
      object.shape = {1, {size.x(), size.y(), size.z()}};
      array.objects.push_back(object);
    }
    return array;
  }

  test::AutowareObjectArray autoware() const {
    auto array = start<test::AutowareObjectArray>();
    for (const KnownBox& known : boxes) {
      test::AutowareObject object;
      object.id = static_cast<std::uint32_t>(known.id);
      object.label = known.label;
      object.valid = 1;
      object.pose = poseOf(known.box);
      object.dimensions = sizeOf(known.box);
      array.objects.push_back(object);
    }
    return array;
  }

  test::PlanningScene planningScene() const {
    std::map<std::string, test::CollisionObject> objects;
    for (const KnownBox& known : boxes) {
      test::CollisionObject& object = objects[known.ns];
      object.header.frame_id = frame;
      object.header.stamp = stamp;
      object.pose = identity();
      object.id = object.type_key = known.ns;
      const Vector3 size = 2 * known.box.half_extents;
      object.primitives.push_back({1, {size.x(), size.y(), size.z()}});
      object.primitive_poses.push_back(poseOf(known.box));
    }
    test::PlanningScene scene;
    for (const auto& entry : objects) {
      scene.collision_objects.push_back(entry.second);
    }
    return scene;
  }
};

}  // namespace

Bytes messageAt(std::size_t topic, Tick tick) {
  const TopicOfBoxes& known = topics().at(topic);
  const Writer writer = {known.frame, timeOf(tick), boxesAt(topic, tick)};
  switch (known.type) {
    case Type::kCubes:
      return bytesOf(writer.cubes());
    case Type::kCubeList:
      return bytesOf(writer.cubeList());
    case Type::kJsk:
      return bytesOf(writer.jsk());
    case Type::kDetections:
      return bytesOf(writer.detections());
    case Type::kObjects:
      return bytesOf(writer.objects());
    case Type::kAutoware:
      return bytesOf(writer.autoware());
    case Type::kPlanningScene:
      return bytesOf(writer.planningScene());
  }
  throw std::logic_error("a type without messages");
}

Bytes pileOf(std::uint32_t boxes, const ros::Time& stamp) {
  MarkerArray array;
  auto list = inFrame<Marker>(kFixedFrame, stamp);
  list.type = Marker::CUBE_LIST;
  list.pose = identity();
  list.scale.x = list.scale.y = list.scale.z = 0.25;
  for (std::uint32_t n = 0; n < boxes; ++n) {
    list.points.push_back(toPoint({1000.0 + n % 100, 0.5 * (n / 100 % 100), 0.5 * (n / 10000)}));
  }
  array.markers.push_back(std::move(list));
  return bytesOf(array);
}

const char* rosType(Type type) {
  switch (type) {
    case Type::kCubes:
    case Type::kCubeList:
      return "visualization_msgs/MarkerArray";
    case Type::kJsk:
      return "jsk_recognition_msgs/BoundingBoxArray";
    case Type::kDetections:
      return "vision_msgs/Detection3DArray";
    case Type::kObjects:
      return "derived_object_msgs/ObjectArray";
    case Type::kAutoware:
      return "autoware_msgs/DetectedObjectArray";
    case Type::kPlanningScene:
      return "moveit_msgs/PlanningScene";
  }
  throw std::logic_error("a type without a name");
}

ros::Publisher advertise(ros::NodeHandle& nh, const std::string& topic, const std::string& type,
                         std::uint32_t queue_size) {
  for (const BoxSource& source : boxSources()) {
    if (source.type == type) {
      ros::AdvertiseOptions options(topic, queue_size, source.md5, source.type, "# not looked at");
      return nh.advertise(options);
    }
  }
  throw std::invalid_argument("no source of type " + type);
}

}  // namespace box_query::load
