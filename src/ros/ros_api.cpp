// SPDX-License-Identifier: BSD-3-Clause
#include "ros/ros_api.h"

#include <cerrno>
#include <cstdint>

#include <poll.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <sys/socket.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcDispatch.h>
#include <xmlrpcpp/XmlRpcSocket.h>

namespace box_query {
namespace {

constexpr int kAnswerTime = 100;  // [ms] of another host
constexpr double kStep = 0.05;    // [s] between looks at whether ROS shuts down
constexpr int kPatience = 100;    // steps

}  // namespace

using XmlRpc::XmlRpcValue;

XmlRpcValue requestOf(const std::vector<std::string>& arguments) {
  XmlRpcValue request;
  request[0] = ros::this_node::getName();
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    request[static_cast<int>(i) + 1] = arguments[i];
  }
  return request;
}

const std::string& ownAddress() {
  return ros::XMLRPCManager::instance()->getServerURI();
}

std::optional<XmlRpcValue> askMaster(const char* method, const XmlRpcValue& request) {
  XmlRpcValue response;
  XmlRpcValue value;
  const bool answered =
      !ros::isShuttingDown() && ros::master::execute(method, request, response, value, false);
  return answered ? std::make_optional(value) : std::nullopt;
}

bool isUnknownToMaster(const char* method, const std::string& name) {
  constexpr int kUnknown = -1;
  XmlRpcValue response;
  XmlRpcValue value;
  return !ros::isShuttingDown() &&
         !ros::master::execute(method, requestOf({name}), response, value, false) &&
         response.getType() == XmlRpcValue::TypeArray && response.size() > 0 &&
         response[0].getType() == XmlRpcValue::TypeInt && static_cast<int>(response[0]) == kUnknown;
}

std::optional<XmlRpcValue> askSelf(const char* method, const XmlRpcValue& request) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(ownAddress(), host, port)) {
    return std::nullopt;
  }
  XmlRpc::XmlRpcClient self(host.c_str(), static_cast<int>(port), "/");
  if (!self.executeNonBlock(method, request)) {
    return std::nullopt;
  }
  // XmlRpcClient::execute() would wait for ever once roscpp has stopped to answer.
  XmlRpc::XmlRpcDispatch dispatch;
  dispatch.addSource(&self,
                     XmlRpc::XmlRpcDispatch::WritableEvent | XmlRpc::XmlRpcDispatch::Exception);
  XmlRpcValue response;
  bool done = false;
  for (int i = 0; i < kPatience && !done && !ros::isShuttingDown(); ++i) {
    dispatch.work(kStep);
    done = self.executeCheckDone(response);
  }
  dispatch.removeSource(&self);
  const bool answered = done && !self.isFault() && response.getType() == XmlRpcValue::TypeArray &&
                        response.size() == 3;
  return answered ? std::make_optional(response[2]) : std::nullopt;
}

bool isGone(const std::string& address) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(address, host, port)) {
    return true;
  }
  using XmlRpc::XmlRpcSocket;
  const int socket = XmlRpcSocket::socket();
  if (socket < 0) {
    return false;
  }
  int error = 0;
  if (XmlRpcSocket::setNonBlocking(socket) &&
      XmlRpcSocket::connect(socket, host, static_cast<int>(port))) {
    pollfd connected = {socket, POLLOUT, 0};
    socklen_t size = sizeof(error);
    poll(&connected, 1, kAnswerTime);
    getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
  } else {
    error = errno;
  }
  XmlRpcSocket::close(socket);
  return error == ECONNREFUSED;
}

}  // namespace box_query
