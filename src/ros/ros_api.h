// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Calls of ROS' Master API, and of the Slave API of other nodes and of this process itself, that
/// roscpp does not offer. Nothing here waits for a master that is away.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <xmlrpcpp/XmlRpcValue.h>

namespace box_query {

/// The arguments of a call: this node's name, then these.
XmlRpc::XmlRpcValue requestOf(const std::vector<std::string>& arguments);

/// Where this process answers others' XML-RPC.
const std::string& ownAddress();

/// What the master answers; nothing if it is away or refuses, or ROS shuts down.
std::optional<XmlRpc::XmlRpcValue> askMaster(const char* method,
                                             const XmlRpc::XmlRpcValue& request);
/// Whether the master is there and answers that it does not know what a call looks up.
bool isUnknownToMaster(const char* method, const std::string& name);

/// What this process answers itself; nothing if it does not within seconds, or ROS shuts down.
std::optional<XmlRpc::XmlRpcValue> askSelf(const char* method, const XmlRpc::XmlRpcValue& request);

/// Whether the host of a node's address says that nothing is there any more: a node that was killed
/// stays registered with the master, and connections to it with roscpp. A host that does not answer
/// within 0.1 s says nothing.
bool isGone(const std::string& address);

}  // namespace box_query
