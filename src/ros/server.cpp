// SPDX-License-Identifier: BSD-3-Clause
#include "ros/server.h"

#include "ros/answers.h"
#include "ros/box_filter.h"
#include "ros/box_source.h"
#include "ros/request_checks.h"

#include <stdexcept>

#include <ros/console.h>

namespace box_query {
namespace {

/// ROS time that is asked about.
template <class Request>
ros::Time timeOf(const Request& request) {
  return request.scene_time.isZero() ? ros::Time::now() : request.scene_time;
}

}  // namespace

template <class Service>
void Server::advertise(ros::NodeHandle& private_nh, const std::string& name) {
  // A segment has two points: no array that is taken needs to be longer.
  const auto queries = static_cast<std::uint32_t>(monitor_.parameters().max_queries_per_call);
  services_.push_back(
      advertiseChecked<Service>(private_nh, name, 2 * queries, queue_,
                                [this](CheckedRequest<typename Service::Request>& request,
                                       typename Service::Response& response) {
                                  handle(request, response);
                                  return true;
                                }));
}

Server::Server(ros::NodeHandle& private_nh, SceneMonitor& monitor)
    : monitor_(monitor),
      markers_(private_nh, monitor),
      spinner_(static_cast<std::uint32_t>(monitor.parameters().service_threads), queue_.get()) {
  advertise<CastRay>(private_nh, "cast_ray");
  advertise<CastRays>(private_nh, "cast_rays");
  advertise<CheckSegment>(private_nh, "check_segment");
  advertise<CheckSegments>(private_nh, "check_segments");
  advertise<FindIntersections>(private_nh, "find_intersections");
  advertise<GetScene>(private_nh, "get_scene");
  spinner_.start();

  std::string topics;
  for (const TopicState& topic : monitor.watchedScene()->topics) {
    topics += (topics.empty() ? "" : ", ") + topic.parameters.topic;
  }
  std::string names;
  for (const std::string& service : services()) {
    names += (names.empty() ? "" : ", ") + service;
  }
  ROS_INFO_STREAM("boxes of " << topics << " in frame " << monitor.parameters().fixed_frame
                              << " are asked for through " << names);
}

Server::~Server() {
  stopping_ = true;
  spinner_.stop();
  for (ros::ServiceServer& service : services_) {
    service.shutdown();
  }
  queue_->disable();
  queue_->clear();
}

std::vector<std::string> Server::services() const {
  std::vector<std::string> names;
  names.reserve(services_.size());
  for (const ros::ServiceServer& service : services_) {
    names.push_back(service.getService());
  }
  return names;
}

SnapshotPtr Server::sceneAt(const ros::Time& scene_time) {
  if (scene_time.isZero()) {
    return monitor_.promptScene();
  }
  SnapshotPtr scene;
  const std::string missing = monitor_.sceneAt(scene_time, scene);
  if (!missing.empty()) {
    throw std::runtime_error(missing);
  }
  return scene;
}

FrameChange Server::frameOf(const std_msgs::Header& header) const {
  const Parameters& parameters = monitor_.parameters();
  if (stripSlash(header.frame_id) == parameters.fixed_frame) {
    return FrameChange();
  }
  geometry_msgs::TransformStamped transform;
  const std::string missing =
      monitor_.lookUpTransform(parameters.fixed_frame, header.frame_id, header.stamp,
                               parameters.transform_timeout, transform);
  if (!missing.empty()) {
    throw std::runtime_error(missing);
  }
  checkFrame(header.frame_id, fromMessage(transform.transform.translation), Limits(parameters));
  return FrameChange(transform.transform);
}

template <class Request>
void Server::resolveTopics(Request& request) const {
  for (auto* topics : {&request.topics, &request.ignore_topics}) {
    for (std::string& topic : *topics) {
      topic = monitor_.resolveTopic(topic);
    }
  }
}

template <class Request, class Response>
void Server::answerNow(const Request& request, Response& response) {
  check(request, Limits(monitor_.parameters()));
  const FrameChange frame = frameOf(request.header);
  const SnapshotPtr snapshot = sceneAt(request.scene_time);
  Context context = {
      *snapshot, timeOf(request), frame, markers_.drawing(), monitor_.parameters().batch_threads,
      &totals_,  &stopping_};
  {
    const CountedQueries counted(&totals_);
    answer(request, context, response);
  }
  response.message = unknownNames(BoxFilter(request), *snapshot);
  markers_.show(context.drawing.take());
}

void Server::answerNow(const GetSceneRequest& request, GetSceneResponse& response) {
  check(request, Limits(monitor_.parameters()));
  const SnapshotPtr snapshot =
      request.scene_id == 0 ? sceneAt(request.scene_time) : monitor_.sceneById(request.scene_id);
  if (!snapshot) {
    throw std::runtime_error(
        "scene " + std::to_string(request.scene_id) + " is not kept: the last " +
        std::to_string(monitor_.parameters().kept_scenes) + " that were asked are, of at most " +
        std::to_string(monitor_.parameters().max_kept_boxes) +
        " boxes in all; ask sooner, raise ~kept_scenes or ~max_kept_boxes, "
        "or ask for 0, the current one");
  }
  answer(request, *snapshot, timeOf(request), response);
  response.message = unknownNames(BoxFilter(request), *snapshot);
}

template <class Request, class Response>
void Server::handle(CheckedRequest<Request>& checked, Response& response) {
  try {
    if (!checked.problem.empty()) {
      throw std::runtime_error(checked.problem);
    }
    resolveTopics(checked.request);
    answerNow(checked.request, response);
    response.success = true;
    ++answered_;
  } catch (const std::exception& error) {
    ++refused_;
    response = nothing<Response>();
    describeScene(checked.request, *monitor_.scene(), ros::Time::now(), response);
    response.message = error.what();
  }
}

}  // namespace box_query
