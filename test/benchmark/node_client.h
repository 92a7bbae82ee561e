// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What both measurements of the node do as its client.
#pragma once

#include "benchmark/node_server.h"
#include "rostest/raw_message.h"

#include <box_query/geometry.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <ros/service.h>
#include <ros/service_client.h>
#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

namespace box_query::benchmark {

using WallClock = std::chrono::steady_clock;

inline double microseconds(WallClock::duration duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

/// The service over a connection that stays.
template <class Service>
ros::ServiceClient connect(ros::NodeHandle& nh, const std::string& name) {
  if (!ros::service::waitForService(name, ros::Duration(30))) {
    throw std::runtime_error("there is no service " + name);
  }
  return nh.serviceClient<Service>(name, true);
}

/// @return how long it took [us]
/// @throws std::runtime_error if it does not answer.
template <class Service>
double call(ros::ServiceClient& client, const typename Service::Request& request,
            typename Service::Response& response) {
  const auto start = WallClock::now();
  const bool answered = client.call(request, response);
  const auto end = WallClock::now();
  if (!answered || !response.success) {
    throw std::runtime_error(client.getService() + " does not answer: " + response.message);
  }
  return microseconds(end - start);
}

/// Cubes with the ids 0, 1, ...
visualization_msgs::MarkerArray markersOf(const std::vector<OrientedBox>& boxes);
void setStamps(const ros::Time& stamp, visualization_msgs::MarkerArray& array);

/// A topic of boxes, and one who hears it.
class BoxesTopic {
 public:
  /// Waits for the subscriber.
  /// @throws std::runtime_error if none comes.
  BoxesTopic(ros::NodeHandle& nh, const std::string& name);

  void publish(const RawMarkerArray& message) const { publisher_.publish(message); }
  /// Takes away all boxes that were published.
  void clear() const;

 private:
  ros::Publisher publisher_;
};

/// @pre ros::init(), and serve() runs in another process
struct NodeClient {
  ros::NodeHandle nh;
  BoxesTopic node_boxes{nh, kNodeBoxes};
  BoxesTopic plain_boxes{nh, kPlainBoxes};
};

}  // namespace box_query::benchmark
