// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/node_server.h"

#include "ros/conversions.h"
#include "ros/memory.h"
#include "ros/node.h"

#include <box_query/CastRay.h>
#include <box_query/CastRays.h>
#include <box_query/CheckSegments.h>
#include <box_query/scene.h>

#include <csignal>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <boost/function.hpp>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>

namespace box_query::benchmark {
namespace {

/// Sends as many bytes as the node, and computes nothing.
template <class Service>
class EmptyService {
 public:
  using Request = typename Service::Request;
  using Response = typename Service::Response;

  EmptyService(ros::NodeHandle& nh, const std::string& name)
      : node_(nh.serviceClient<Service>(kNode + name)),
        server_(nh.advertiseService(
            kPlain + name, boost::function<bool(Request&, Response&)>([this](Request& request,
                                                                             Response& response) {
              return (request.header.seq == question_ || learn(request)) && say(response);
            }))) {}

 private:
  bool learn(Request& request) {
    question_ = request.header.seq;
    return node_.call(request, said_);
  }
  bool say(Response& response) const {
    response = said_;
    return true;
  }

  std::uint32_t question_ = 0;
  Response said_;
  ros::ServiceClient node_;
  ros::ServiceServer server_;
};

/// What one writes with roscpp and the library: a subscriber that builds, a service that asks.
class PlainNode {
 public:
  PlainNode(ros::NodeHandle& nh, ros::NodeHandle& boxes_nh)
      : boxes_(boxes_nh.subscribe(kPlainBoxes, 0, &PlainNode::receive, this,
                                  ros::TransportHints().tcpNoDelay())),
        server_(nh.advertiseService(kPlain + std::string("cast_ray"), &PlainNode::castRay, this)) {}

 private:
  struct Known {
    ros::Time stamp;
    Scene scene;
  };

  void receive(const visualization_msgs::MarkerArray::ConstPtr& message) {
    std::vector<Box> boxes;
    for (const visualization_msgs::Marker& marker : message->markers) {
      if (marker.action == visualization_msgs::Marker::ADD) {
        const geometry_msgs::Quaternion& q = marker.pose.orientation;
        boxes.emplace_back(OrientedBox{fromMessage(marker.pose.position),
                                       Quaternion(q.w, q.x, q.y, q.z),
                                       0.5 * fromMessage(marker.scale)});
      }
    }
    auto known = std::make_shared<const Known>(
        Known{message->markers.back().header.stamp, Scene(std::move(boxes))});
    const std::lock_guard<std::mutex> lock(mutex_);
    known_.swap(known);
  }

  bool castRay(CastRayRequest& request, CastRayResponse& response) {
    std::unique_lock<std::mutex> lock(mutex_);
    const std::shared_ptr<const Known> known = known_;
    lock.unlock();
    const Hit hit =
        known->scene.cast(Ray{fromMessage(request.origin), fromMessage(request.direction)});
    response.success = true;
    response.scene_stamp = known->stamp;
    response.hit = hit.hit;
    response.range = hit.range;
    return true;
  }

  std::mutex mutex_;
  std::shared_ptr<const Known> known_ = std::make_shared<Known>();
  ros::Subscriber boxes_;
  ros::ServiceServer server_;
};

/// A handle whose callbacks one thread of its own calls: with one client that is the fastest.
struct OwnThread {
  explicit OwnThread(ros::NodeHandle& nh) : spinner(1, &queue) {
    nh.setCallbackQueue(&queue);
    spinner.start();
  }
  ros::CallbackQueue queue;
  ros::AsyncSpinner spinner;
};

}  // namespace

int serve(int argc, char** argv) {
  keepFreedMemory();
  ros::init(argc, argv, "box_query", ros::init_options::NoSigintHandler);
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  const ros::NodeHandle nh;
  ros::NodeHandle private_nh("~");
  ros::NodeHandle services_nh;
  ros::NodeHandle boxes_nh;
  const OwnThread services_thread(services_nh);
  const OwnThread boxes_thread(boxes_nh);
  const PlainNode plain(services_nh, boxes_nh);
  const EmptyService<CastRays> cast_rays(services_nh, "cast_rays");
  const EmptyService<CheckSegments> check_segments(services_nh, "check_segments");
  const Node node(nh, private_nh);
  ros::waitForShutdown();
  return 0;
}

}  // namespace box_query::benchmark
