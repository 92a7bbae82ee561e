// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Messages of packages that Debian does not have, as gencpp makes them of their definitions.
/// That these are the public ones is proved elsewhere, by the checksums of genpy.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <boost/array.hpp>
#include <geometry_msgs/Accel.h>
#include <geometry_msgs/PolygonStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovariance.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/Vector3.h>
#include <geometry_msgs/Wrench.h>
#include <ros/serialization.h>
#include <std_msgs/ColorRGBA.h>
#include <std_msgs/Header.h>

/// A serialiser that roscpp uses for the fields named, in their order.
#define BQ_SERIALIZED(Type, ...)                                                    \
  namespace ros::serialization {                                                    \
  template <>                                                                       \
  struct Serializer<box_query::test::Type> {                                        \
    template <typename Stream, typename T>                                          \
    static void allInOne(Stream& stream, T message) {                               \
      auto& m = message;                                                            \
      const auto next = [&stream](auto&... fields) { (stream.next(fields), ...); }; \
      next(__VA_ARGS__);                                                            \
    }                                                                               \
    ROS_DECLARE_ALLINONE_SERIALIZER                                                 \
  };                                                                                \
  }

namespace box_query::test {

struct JskBoundingBox {
  std_msgs::Header header;
  geometry_msgs::Pose pose;
  geometry_msgs::Vector3 dimensions;
  float value = 0;
  std::uint32_t label = 0;
};

struct JskBoundingBoxArray {
  std_msgs::Header header;
  std::vector<JskBoundingBox> boxes;
};

struct PointField {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 0;
};

struct PointCloud2 {
  std_msgs::Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::vector<PointField> fields;
  std::uint8_t is_bigendian = 0;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::vector<std::uint8_t> data;
  std::uint8_t is_dense = 0;
};

struct VisionBoundingBox3D {
  geometry_msgs::Pose center;
  geometry_msgs::Vector3 size;
};

struct VisionBoundingBox3DArray {
  std_msgs::Header header;
  std::vector<VisionBoundingBox3D> boxes;
};

struct VisionHypothesis {
  std::int64_t id = 0;
  double score = 0;
  geometry_msgs::PoseWithCovariance pose;
};

struct VisionDetection3D {
  std_msgs::Header header;
  std::vector<VisionHypothesis> results;
  VisionBoundingBox3D bbox;
  PointCloud2 source_cloud;
};

struct VisionDetection3DArray {
  std_msgs::Header header;
  std::vector<VisionDetection3D> detections;
};

struct SolidPrimitive {
  std::uint8_t type = 0;
  std::vector<double> dimensions;
};

struct DerivedObject {
  std_msgs::Header header;
  std::uint32_t id = 0;
  std::uint8_t detection_level = 0;
  std::uint8_t object_classified = 0;
  geometry_msgs::Pose pose;
  geometry_msgs::Twist twist;
  geometry_msgs::Accel accel;
  geometry_msgs::Polygon polygon;
  SolidPrimitive shape;
  std::uint8_t classification = 0;
  std::uint8_t classification_certainty = 0;
  std::uint32_t classification_age = 0;
};

struct DerivedObjectArray {
  std_msgs::Header header;
  std::vector<DerivedObject> objects;
};

struct AutowareWaypoint {
  std::int32_t gid = 0;
  std::int32_t lid = 0;
  geometry_msgs::PoseStamped pose;
  geometry_msgs::TwistStamped twist;
  boost::array<double, 8> dtlane{};
  std::int32_t change_flag = 0;
  std::int32_t aid = 0;
  boost::array<std::uint8_t, 5> states{};
  boost::array<std::uint32_t, 4> lanes{};
  float cost = 0;
  float time_cost = 0;
  std::uint32_t direction = 0;
};

struct AutowareLane {
  std_msgs::Header header;
  std::int32_t increment = 0;
  std::int32_t lane_id = 0;
  std::vector<AutowareWaypoint> waypoints;
  std::uint32_t lane_index = 0;
  float cost = 0;
  float closest_object_distance = 0;
  float closest_object_velocity = 0;
  std::uint8_t is_blocked = 0;
};

struct Image {
  std_msgs::Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding;
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;
  std::vector<std::uint8_t> data;
};

struct AutowareObject {
  std_msgs::Header header;
  std::uint32_t id = 0;
  std::string label;
  float score = 0;
  std_msgs::ColorRGBA color;
  std::uint8_t valid = 0;
  std::string space_frame;
  geometry_msgs::Pose pose;
  geometry_msgs::Vector3 dimensions;
  geometry_msgs::Vector3 variance;
  geometry_msgs::Twist velocity;
  geometry_msgs::Twist acceleration;
  PointCloud2 pointcloud;
  geometry_msgs::PolygonStamped convex_hull;
  std::int32_t lanes_id = 0;
  std::vector<AutowareLane> lanes;
  std::uint8_t pose_reliable = 0;
  std::uint8_t velocity_reliable = 0;
  std::uint8_t acceleration_reliable = 0;
  std::string image_frame;
  boost::array<std::int32_t, 4> rectangle{};
  float angle = 0;
  Image roi_image;
  std::uint8_t indicator_state = 0;
  std::uint8_t behavior_state = 0;
  std::vector<std::string> user_defined_info;
};

struct AutowareObjectArray {
  std_msgs::Header header;
  std::vector<AutowareObject> objects;
};

struct MeshTriangle {
  boost::array<std::uint32_t, 3> vertex_indices{};
};

struct Plane {
  boost::array<double, 4> coef{};
};

struct Mesh {
  std::vector<MeshTriangle> triangles;
  std::vector<geometry_msgs::Point> vertices;
};

struct CollisionObject {
  std_msgs::Header header;
  geometry_msgs::Pose pose;
  std::string id;
  std::string type_key;
  std::string type_db;
  std::vector<SolidPrimitive> primitives;
  std::vector<geometry_msgs::Pose> primitive_poses;
  std::vector<Mesh> meshes;
  std::vector<geometry_msgs::Pose> mesh_poses;
  std::vector<Plane> planes;
  std::vector<geometry_msgs::Pose> plane_poses;
  std::vector<std::string> subframe_names;
  std::vector<geometry_msgs::Pose> subframe_poses;
  std::int8_t operation = 0;
};

struct JointState {
  std_msgs::Header header;
  std::vector<std::string> name;
  std::vector<double> position;
  std::vector<double> velocity;
  std::vector<double> effort;
};

struct MultiDofJointState {
  std_msgs::Header header;
  std::vector<std::string> joint_names;
  std::vector<geometry_msgs::Transform> transforms;
  std::vector<geometry_msgs::Twist> twist;
  std::vector<geometry_msgs::Wrench> wrench;
};

struct JointTrajectoryPoint {
  std::vector<double> positions;
  std::vector<double> velocities;
  std::vector<double> accelerations;
  std::vector<double> effort;
  ros::Duration time_from_start;
};

struct JointTrajectory {
  std_msgs::Header header;
  std::vector<std::string> joint_names;
  std::vector<JointTrajectoryPoint> points;
};

struct AttachedCollisionObject {
  std::string link_name;
  CollisionObject object;
  std::vector<std::string> touch_links;
  JointTrajectory detach_posture;
  double weight = 0;
};

struct AllowedCollisionEntry {
  std::vector<std::uint8_t> enabled;
};

struct LinkNumber {  // LinkPadding, LinkScale
  std::string link_name;
  double number = 0;
};

struct ObjectColor {
  std::string id;
  std_msgs::ColorRGBA color;
};

struct OctomapWithPose {
  std_msgs::Header header;
  geometry_msgs::Pose origin;
  std_msgs::Header octomap_header;
  std::uint8_t binary = 0;
  std::string id;
  double resolution = 0;
  std::vector<std::int8_t> data;
};

struct PlanningScene {
  std::string name;
  JointState joint_state;
  MultiDofJointState multi_dof_joint_state;
  std::vector<AttachedCollisionObject> attached_collision_objects;
  std::uint8_t robot_state_is_diff = 0;
  std::string robot_model_name;
  std::vector<geometry_msgs::TransformStamped> fixed_frame_transforms;
  std::vector<std::string> entry_names;
  std::vector<AllowedCollisionEntry> entry_values;
  std::vector<std::string> default_entry_names;
  std::vector<std::uint8_t> default_entry_values;
  std::vector<LinkNumber> link_padding;
  std::vector<LinkNumber> link_scale;
  std::vector<ObjectColor> object_colors;
  std::vector<CollisionObject> collision_objects;
  OctomapWithPose octomap;
  std::uint8_t is_diff = 0;
};

}  // namespace box_query::test

BQ_SERIALIZED(JointState, m.header, m.name, m.position, m.velocity, m.effort)
BQ_SERIALIZED(MultiDofJointState, m.header, m.joint_names, m.transforms, m.twist, m.wrench)
BQ_SERIALIZED(JointTrajectoryPoint, m.positions, m.velocities, m.accelerations, m.effort,
              m.time_from_start)
BQ_SERIALIZED(JointTrajectory, m.header, m.joint_names, m.points)
BQ_SERIALIZED(AttachedCollisionObject, m.link_name, m.object, m.touch_links, m.detach_posture,
              m.weight)
BQ_SERIALIZED(AllowedCollisionEntry, m.enabled)
BQ_SERIALIZED(LinkNumber, m.link_name, m.number)
BQ_SERIALIZED(ObjectColor, m.id, m.color)
BQ_SERIALIZED(OctomapWithPose, m.header, m.origin, m.octomap_header, m.binary, m.id, m.resolution,
              m.data)
BQ_SERIALIZED(PlanningScene, m.name, m.joint_state, m.multi_dof_joint_state,
              m.attached_collision_objects, m.robot_state_is_diff, m.robot_model_name,
              m.fixed_frame_transforms, m.entry_names, m.entry_values, m.default_entry_names,
              m.default_entry_values, m.link_padding, m.link_scale, m.object_colors,
              m.collision_objects, m.octomap, m.is_diff)
BQ_SERIALIZED(MeshTriangle, m.vertex_indices)
BQ_SERIALIZED(Plane, m.coef)
BQ_SERIALIZED(Mesh, m.triangles, m.vertices)
BQ_SERIALIZED(CollisionObject, m.header, m.pose, m.id, m.type_key, m.type_db, m.primitives,
              m.primitive_poses, m.meshes, m.mesh_poses, m.planes, m.plane_poses, m.subframe_names,
              m.subframe_poses, m.operation)
BQ_SERIALIZED(AutowareWaypoint, m.gid, m.lid, m.pose, m.twist, m.dtlane, m.change_flag, m.aid,
              m.states, m.lanes, m.cost, m.time_cost, m.direction)
BQ_SERIALIZED(AutowareLane, m.header, m.increment, m.lane_id, m.waypoints, m.lane_index, m.cost,
              m.closest_object_distance, m.closest_object_velocity, m.is_blocked)
BQ_SERIALIZED(Image, m.header, m.height, m.width, m.encoding, m.is_bigendian, m.step, m.data)
BQ_SERIALIZED(AutowareObject, m.header, m.id, m.label, m.score, m.color, m.valid, m.space_frame,
              m.pose, m.dimensions, m.variance, m.velocity, m.acceleration, m.pointcloud,
              m.convex_hull, m.lanes_id, m.lanes, m.pose_reliable, m.velocity_reliable,
              m.acceleration_reliable, m.image_frame, m.rectangle, m.angle, m.roi_image,
              m.indicator_state, m.behavior_state, m.user_defined_info)
BQ_SERIALIZED(AutowareObjectArray, m.header, m.objects)
BQ_SERIALIZED(SolidPrimitive, m.type, m.dimensions)
BQ_SERIALIZED(DerivedObject, m.header, m.id, m.detection_level, m.object_classified, m.pose,
              m.twist, m.accel, m.polygon, m.shape, m.classification, m.classification_certainty,
              m.classification_age)
BQ_SERIALIZED(DerivedObjectArray, m.header, m.objects)
BQ_SERIALIZED(PointField, m.name, m.offset, m.datatype, m.count)
BQ_SERIALIZED(PointCloud2, m.header, m.height, m.width, m.fields, m.is_bigendian, m.point_step,
              m.row_step, m.data, m.is_dense)
BQ_SERIALIZED(VisionBoundingBox3D, m.center, m.size)
BQ_SERIALIZED(VisionBoundingBox3DArray, m.header, m.boxes)
BQ_SERIALIZED(VisionHypothesis, m.id, m.score, m.pose)
BQ_SERIALIZED(VisionDetection3D, m.header, m.results, m.bbox, m.source_cloud)
BQ_SERIALIZED(VisionDetection3DArray, m.header, m.detections)
BQ_SERIALIZED(JskBoundingBox, m.header, m.pose, m.dimensions, m.value, m.label)
BQ_SERIALIZED(JskBoundingBoxArray, m.header, m.boxes)
