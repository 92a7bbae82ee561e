// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A ray and a segment with handles to drag in rviz, and what the node answers about them.
#include "ros/conversions.h"
#include "ros/marker_shapes.h"
#include "ros/probe_answers.h"

#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <interactive_markers/interactive_marker_server.h>
#include <ros/ros.h>
#include <visualization_msgs/InteractiveMarker.h>
#include <visualization_msgs/MarkerArray.h>

namespace box_query {
namespace {

using visualization_msgs::InteractiveMarker;
using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::InteractiveMarkerFeedbackConstPtr;
using visualization_msgs::Marker;

constexpr double kHandleSize = 0.18;  // [m]
constexpr double kArrowSize = 0.45;   // [m]
constexpr double kMissLength = 30.0;  // [m] of a ray that is drawn where it hits nothing
constexpr double kPeriod = 0.1;       // [s] between questions while nothing is dragged

InteractiveMarkerControl ball() {
  Marker sphere;
  sphere.type = Marker::SPHERE;
  sphere.scale.x = sphere.scale.y = sphere.scale.z = kHandleSize;
  sphere.color.r = sphere.color.g = sphere.color.b = sphere.color.a = 0.9F;
  InteractiveMarkerControl control;
  control.name = "ball";
  control.interaction_mode = InteractiveMarkerControl::MOVE_3D;
  control.always_visible = 1;
  control.markers.push_back(sphere);
  return control;
}

/// An arrow both ways along the axis onto which the rotation takes x.
InteractiveMarkerControl arrow(const char* name, double x, double y, double z) {
  InteractiveMarkerControl control;
  control.name = name;
  control.interaction_mode = InteractiveMarkerControl::MOVE_AXIS;
  control.orientation.w = std::sqrt(0.5);
  control.orientation.x = x * std::sqrt(0.5);
  control.orientation.y = y * std::sqrt(0.5);
  control.orientation.z = z * std::sqrt(0.5);
  return control;
}

class Probe {
 public:
  explicit Probe(ros::NodeHandle& private_nh)
      : handles_(private_nh.getNamespace()),
        publisher_(private_nh.advertise<visualization_msgs::MarkerArray>("answers", 10)) {
    server_ = private_nh.param<std::string>("server", "box_query");
    frame_ = private_nh.param<std::string>("frame", "map");
    radius_ = private_nh.param("radius", 0.25);
    if (frame_.empty() || !(radius_ >= 0.0)) {
      throw std::invalid_argument("~frame must name a tf frame, ~radius be 0 or more [m]");
    }
    // Where they show something in the demo's warehouse.
    add("ray_origin", Vector3(1.2, 0.7, 0.5));
    add("ray_target", Vector3(1.9, 0.95, 0.53));
    add("segment_start", Vector3(2.2, -0.1, 0.5));
    add("segment_end", Vector3(4.2, -0.75, 0.6));
    handles_.applyChanges();
    timer_ = private_nh.createWallTimer(ros::WallDuration(kPeriod), [this](auto&) { ask(); });
  }

 private:
  void add(const std::string& name, const Vector3& at) {
    InteractiveMarker handle;
    handle.header.frame_id = frame_;
    handle.name = name;
    handle.scale = static_cast<float>(kArrowSize);
    handle.pose.position = toPoint(at);
    handle.pose.orientation.w = 1;
    handle.controls = {ball(), arrow("x", 1, 0, 0), arrow("y", 0, 0, 1), arrow("z", 0, 1, 0)};
    handles_.insert(handle, [this](const InteractiveMarkerFeedbackConstPtr& feedback) {
      drag(feedback->marker_name, fromMessage(feedback->pose.position));
    });
    ends_[name] = at;
  }

  void drag(const std::string& name, const Vector3& to) {
    ends_[name] = to;
    handles_.applyChanges();  // other viewers see it move
    ask();
  }

  void ask() {
    if (publisher_.getNumSubscribers() == 0) {
      shown_.clear();
      return;
    }
    CastRay ray;
    ray.request.header.frame_id = frame_;
    ray.request.origin = toPoint(ends_["ray_origin"]);
    ray.request.direction = toVector3(ends_["ray_target"] - ends_["ray_origin"]);
    CheckSegment segment;
    segment.request.header.frame_id = frame_;
    segment.request.start = toPoint(ends_["segment_start"]);
    segment.request.end = toPoint(ends_["segment_end"]);
    segment.request.radius = radius_;
    std::vector<Marker> markers;
    std::string problem = call("cast_ray", ray);
    if (problem.empty()) {
      markers = probeMarkers(ray.request, ray.response, kMissLength);
    }
    const std::string segment_problem = call("check_segment", segment);
    if (segment_problem.empty()) {
      const auto more = probeMarkers(segment.request, segment.response);
      markers.insert(markers.end(), more.begin(), more.end());
    } else {
      problem = problem.empty() ? segment_problem : problem;
    }
    if (!problem.empty()) {
      const auto more = probeMarkers(frame_, problem);
      markers.insert(markers.end(), more.begin(), more.end());
    }
    show(std::move(markers));
  }

  /// @return why there is no answer; empty if there is one.
  template <class Service>
  std::string call(const std::string& name, Service& service) const {
    const std::string full = ros::names::resolve(server_ + "/" + name);
    // roscpp's clients fail now and then: once more.
    if (!ros::service::call(full, service) && !ros::service::call(full, service)) {
      return "no answer from " + full + ": start box_query_node, or correct ~server";
    }
    return service.response.success ? "" : service.response.message;
  }

  void show(std::vector<Marker>&& markers) {
    const auto gone = deletions(shown_, markers, frame_);
    shown_ = namesOf(markers);
    visualization_msgs::MarkerArray array;
    array.markers = std::move(markers);
    array.markers.insert(array.markers.end(), gone.begin(), gone.end());
    publisher_.publish(array);
  }

  std::string server_;
  std::string frame_;
  double radius_ = 0.0;
  std::map<std::string, Vector3> ends_;
  std::vector<MarkerName> shown_;
  interactive_markers::InteractiveMarkerServer handles_;
  ros::Publisher publisher_;
  ros::WallTimer timer_;
};

}  // namespace
}  // namespace box_query

int main(int argc, char** argv) {
  ros::init(argc, argv, "box_query_probe");
  ros::NodeHandle private_nh("~");
  try {
    const box_query::Probe probe(private_nh);
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
