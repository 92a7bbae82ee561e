// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

namespace box_query {

/// The publishers of a topic that are there, and not only registered still. Nodes by their
/// addresses: one that was restarted has a new one.
struct Publishers {
  std::map<std::string, std::string> registered;  ///< addresses by names, as the master knows them
  std::set<std::string> connected;                ///< to this process
  std::set<std::string> links;  ///< the same, and those whose connection roscpp tries to make again
  std::string type;             ///< of the one that registered last
};

/// By topic; nothing if the master cannot be reached, or ROS shuts down.
std::optional<std::map<std::string, Publishers>> askForPublishers(
    const std::set<std::string>& topics);

/// The addresses of those of a topic that the master knows, if it is there, and of those that are
/// connected: after a restart it knows nobody, while they go on. Nothing if ROS shuts down.
std::optional<std::set<std::string>> addressesOfPublishers(const std::string& topic);

/// The addresses of the publishers that roscpp keeps connections to, or tries to, by topic. Nothing
/// if ROS shuts down.
std::optional<std::map<std::string, std::set<std::string>>> connectedPublishers();

}  // namespace box_query
