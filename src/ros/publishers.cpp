// SPDX-License-Identifier: BSD-3-Clause
#include "ros/publishers.h"

#include "ros/ros_api.h"

#include <algorithm>
#include <iterator>

#include <xmlrpcpp/XmlRpcException.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace box_query {
namespace {

using XmlRpc::XmlRpcValue;

/// Adds what the master knows.
void readRegistered(XmlRpcValue& published, std::map<std::string, Publishers>& publishers) {
  for (int i = 0; i < published.size(); ++i) {  // [topic, [node, ...]]
    const auto found = publishers.find(published[i][0]);
    for (int n = 0; found != publishers.end() && n < published[i][1].size(); ++n) {
      const std::string node = published[i][1][n];
      auto address = askMaster("lookupNode", requestOf({node}));
      if (address && !isGone(*address)) {
        found->second.registered[node] = static_cast<std::string>(*address);
      }
    }
  }
}

void readTypes(XmlRpcValue& types, std::map<std::string, Publishers>& publishers) {
  for (int i = 0; i < types.size(); ++i) {  // [topic, type]
    const auto found = publishers.find(types[i][0]);
    if (found != publishers.end()) {
      found->second.type = static_cast<std::string>(types[i][1]);
    }
  }
}

std::set<std::string> livingOf(const std::set<std::string>& addresses) {
  std::set<std::string> living;
  std::remove_copy_if(addresses.begin(), addresses.end(), std::inserter(living, living.end()),
                      isGone);
  return living;
}

}  // namespace

std::optional<std::map<std::string, Publishers>> askForPublishers(
    const std::set<std::string>& topics) {
  auto state = askMaster("getSystemState", requestOf({}));
  auto types = askMaster("getTopicTypes", requestOf({}));
  auto connections = connectedPublishers();
  if (!state || !types || !connections) {
    return std::nullopt;
  }
  std::map<std::string, Publishers> publishers;
  for (const std::string& topic : topics) {
    publishers[topic].links = (*connections)[topic];
    publishers[topic].connected = livingOf(publishers[topic].links);
  }
  try {
    readRegistered((*state)[0], publishers);  // then come subscribers and services
    readTypes(*types, publishers);
  } catch (const XmlRpc::XmlRpcException&) {
    return std::nullopt;  // not what a master answers
  }
  return publishers;
}

std::optional<std::set<std::string>> addressesOfPublishers(const std::string& topic) {
  const auto publishers = askForPublishers({topic});
  if (publishers) {
    std::set<std::string> addresses = publishers->at(topic).connected;
    for (const auto& node : publishers->at(topic).registered) {
      addresses.insert(node.second);
    }
    return addresses;
  }
  auto connections = connectedPublishers();
  return connections ? std::make_optional(livingOf((*connections)[topic])) : std::nullopt;
}

std::optional<std::map<std::string, std::set<std::string>>> connectedPublishers() {
  auto connections = askSelf("getBusInfo", requestOf({}));
  if (!connections) {
    return std::nullopt;
  }
  std::map<std::string, std::set<std::string>> addresses;
  for (int i = 0; i < connections->size(); ++i) {
    XmlRpcValue& connection = (*connections)[i];  // [id, address, direction, transport, topic, ...]
    if (static_cast<std::string>(connection[2]) == "i") {
      addresses[connection[4]].insert(connection[1]);
    }
  }
  return addresses;
}

}  // namespace box_query
