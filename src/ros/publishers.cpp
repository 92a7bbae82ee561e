// SPDX-License-Identifier: BSD-3-Clause
#include "ros/publishers.h"

#include <ros/master.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcException.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace box_query {

std::optional<std::map<std::string, Publishers>> askForPublishers() {
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue state;
  XmlRpc::XmlRpcValue types;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, state, false) ||
      !ros::master::execute("getTopicTypes", request, response, types, false)) {
    return std::nullopt;
  }
  std::map<std::string, Publishers> publishers;
  try {
    XmlRpc::XmlRpcValue& published = state[0];  // [topic, [node, ...]], then subscribers, services
    for (int i = 0; i < published.size(); ++i) {
      const std::string topic = published[i][0];
      publishers[topic].nodes = static_cast<std::size_t>(published[i][1].size());
    }
    for (int i = 0; i < types.size(); ++i) {
      const std::string topic = types[i][0];
      const auto found = publishers.find(topic);
      if (found != publishers.end()) {
        found->second.type = static_cast<std::string>(types[i][1]);
      }
    }
  } catch (const XmlRpc::XmlRpcException&) {
    return std::nullopt;  // not what a master answers
  }
  return publishers;
}

std::optional<std::map<std::string, std::string>> addressesOfPublishers(const std::string& topic) {
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue state;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, state, false)) {
    return std::nullopt;
  }
  std::map<std::string, std::string> addresses;
  try {
    XmlRpc::XmlRpcValue& published = state[0];
    for (int i = 0; i < published.size(); ++i) {
      XmlRpc::XmlRpcValue& nodes = published[i][1];
      for (int n = 0; static_cast<std::string>(published[i][0]) == topic && n < nodes.size(); ++n) {
        XmlRpc::XmlRpcValue address;
        request[1] = nodes[n];
        if (ros::master::execute("lookupNode", request, response, address, false)) {
          addresses[nodes[n]] = static_cast<std::string>(address);
        }
      }
    }
  } catch (const XmlRpc::XmlRpcException&) {
    return std::nullopt;
  }
  return addresses;
}

}  // namespace box_query
