// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Calls of the services, in bytes.
#pragma once

#include "load/questions.h"

#include <array>
#include <string>

#include <ros/node_handle.h>
#include <ros/service_client.h>

namespace box_query::load {

/// Calls services of the node; for one thread.
class Caller {
 public:
  explicit Caller(bool persistent) : persistent_(persistent) {}

  /// @return false if the call failed: no answer came.
  bool call(std::size_t service, const Bytes& request, Bytes& response) {
    const ServiceName& name = services().at(service);
    ros::ServiceClient& client = clients_.at(service);
    if (!client.isValid()) {
      ros::ServiceClientOptions options("/box_query/" + std::string(name.name), name.md5,
                                        persistent_, ros::M_string());
      client = ros::NodeHandle().serviceClient(options);
    }
    return client.call(request, response, name.md5);
  }

 private:
  const bool persistent_;
  std::array<ros::ServiceClient, kServices> clients_;
};

}  // namespace box_query::load
