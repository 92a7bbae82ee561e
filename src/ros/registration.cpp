// SPDX-License-Identifier: BSD-3-Clause
// By the Master API, and the Slave API of this very process: no other part of roscpp says what
// topics it has, or takes publishers to connect to.
#include "ros/registration.h"

#include "ros/publishers.h"
#include "ros/ros_api.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include <ros/connection_manager.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/names.h>
#include <ros/network.h>
#include <ros/param.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcException.h>

namespace box_query {
namespace {

using XmlRpc::XmlRpcValue;

constexpr std::chrono::milliseconds kPause(250);

/// A struct of what is set in a namespace, or invalid.
XmlRpcValue parametersIn(const std::string& ns) {
  XmlRpcValue values;
  return !ns.empty() && ros::param::get(ns, values) && values.getType() == XmlRpcValue::TypeStruct
             ? values
             : XmlRpcValue();
}

/// Connects to publishers, as if the master had told of them. roscpp drops those that it is not
/// told of: who has not registered again is to be heard all the same.
bool hearAlso(const std::string& topic, XmlRpcValue& publishers) {
  auto connections = connectedPublishers();
  if (!connections) {
    return false;
  }
  std::set<std::string>& addresses = (*connections)[topic];
  for (int i = 0; i < publishers.size(); ++i) {
    addresses.insert(publishers[i]);
  }
  XmlRpcValue request = requestOf({topic});
  int count = 0;
  for (const std::string& address : addresses) {
    request[2][count++] = address;
  }
  return askSelf("publisherUpdate", request).has_value();
}

bool registerSubscriptions() {
  auto topics = askSelf("getSubscriptions", requestOf({}));
  for (int i = 0; topics && i < topics->size(); ++i) {
    const std::string topic = (*topics)[i][0];
    auto publishers =
        askMaster("registerSubscriber", requestOf({topic, (*topics)[i][1], ownAddress()}));
    if (!publishers || (publishers->size() > 0 && !hearAlso(topic, *publishers))) {
      return false;
    }
  }
  return topics.has_value();
}

bool registerPublications() {
  auto topics = askSelf("getPublications", requestOf({}));
  for (int i = 0; topics && i < topics->size(); ++i) {
    XmlRpcValue& topic = (*topics)[i];  // and its type
    if (!askMaster("registerPublisher", requestOf({topic[0], topic[1], ownAddress()}))) {
      return false;
    }
  }
  return topics.has_value();
}

bool registerServices(const std::vector<std::string>& services, const std::string& address) {
  return std::all_of(services.begin(), services.end(), [&address](const std::string& service) {
    return askMaster("registerService", requestOf({service, address, ownAddress()}));
  });
}

/// Where this process answers services; it must not be asked for while ROS shuts down.
std::string serviceAddress() {
  return "rosrpc://" + ros::network::getHost() + ":" +
         std::to_string(ros::ConnectionManager::instance()->getTCPPort());
}

/// `values` is a struct, or invalid. What somebody else has set since then stays.
bool setParameters(const std::string& ns, const XmlRpcValue& values) {
  if (!values.valid()) {
    return true;
  }
  for (const auto& [key, value] : values) {
    XmlRpcValue request = requestOf({ns + "/" + key});
    auto is_set = askMaster("hasParam", request);
    request[2] = value;
    if (!is_set || (!static_cast<bool>(*is_set) && !askMaster("setParam", request))) {
      return false;
    }
  }
  return true;
}

}  // namespace

Registration::Registration()
    : Registration({ros::names::resolve("~get_loggers"), ros::names::resolve("~set_logger_level")},
                   "") {}

Registration::Registration(std::vector<std::string> services, std::string ns)
    : services_(std::move(services)),
      service_address_(serviceAddress()),
      ns_(std::move(ns)),
      parameters_(parametersIn(ns_)),
      watch_(kPause, [this] { renew(); }) {}

bool Registration::isMissing() const {
  if (!broken_off_ && !isUnknownToMaster("lookupService", services_.front())) {
    return false;
  }
  auto address = askMaster("lookupNode", requestOf({ros::this_node::getName()}));
  return !address || static_cast<std::string>(*address) == ownAddress();
}

bool Registration::tellMaster() const {
  return setParameters(ns_, parameters_) && registerServices(services_, service_address_) &&
         registerPublications() && registerSubscriptions();
}

void Registration::renew() {
  try {
    // In this order: a node that shuts down is unknown for that reason.
    if (!isMissing() || ros::isShuttingDown()) {
      return;
    }
    broken_off_ = !tellMaster();
    ROS_WARN_STREAM_COND(!broken_off_, "box_query: the master was restarted; "
                                           << services_.front()
                                           << " and all topics are registered again");
  } catch (const XmlRpc::XmlRpcException& error) {
    broken_off_ = true;
    ROS_WARN_STREAM_THROTTLE(5.0, "box_query: registering again failed: " << error.getMessage());
  }
}

}  // namespace box_query
