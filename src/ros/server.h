// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The services of the node, in front of a SceneMonitor.
#pragma once

#include "ros/checked_request.h"
#include "ros/conversions.h"
#include "ros/markers.h"
#include "ros/query_totals.h"

#include <box_query/GetScene.h>
#include <box_query/ros/scene_monitor.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <std_msgs/Header.h>

namespace box_query {

/// Requests since start.
struct RequestCounts {
  std::uint64_t answered = 0;
  std::uint64_t refused = 0;
};

/// Answers on Parameters::service_threads threads of its own, until it is destroyed.
class Server {
 public:
  Server(ros::NodeHandle& private_nh, SceneMonitor& monitor);
  /// Waits for the answers that are being worked on, but not for the rest of a batch.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Their names.
  std::vector<std::string> services() const;
  RequestCounts counts() const { return {answered_, refused_}; }
  /// What the queries of all requests had to do.
  QueryCounters queryCounts() const { return totals_.get(); }

 private:
  template <class Service>
  void advertise(ros::NodeHandle& private_nh, const std::string& name);

  /// Answers a request or refuses it; never throws for what a request says.
  template <class Request, class Response>
  void handle(CheckedRequest<Request>& checked, Response& response);

  /// A nodelet has a namespace of its own: what the filters know is that of the process.
  template <class Request>
  void resolveTopics(Request& request) const;
  template <class Request, class Response>
  void answerNow(const Request& request, Response& response);
  void answerNow(const GetSceneRequest& request, GetSceneResponse& response);

  /// The scene that was known at this ROS time; 0: now.
  /// @throws std::runtime_error saying which times there are.
  SnapshotPtr sceneAt(const ros::Time& scene_time);

  /// Waits for the transform of the request's frame.
  /// @throws std::runtime_error saying what was missing.
  FrameChange frameOf(const std_msgs::Header& header) const;

  SceneMonitor& monitor_;
  Markers markers_;
  QueryTotals totals_;
  std::atomic<std::uint64_t> answered_{0};
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<bool> stopping_{false};
  std::shared_ptr<ros::CallbackQueue> queue_ = std::make_shared<ros::CallbackQueue>();
  std::vector<ros::ServiceServer> services_;
  ros::AsyncSpinner spinner_;
};

}  // namespace box_query
