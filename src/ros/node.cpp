// SPDX-License-Identifier: BSD-3-Clause
#include "ros/node.h"

#include <box_query/scene.h>

#include <ros/console.h>

namespace box_query {
Node::Node(const ros::NodeHandle& nh, ros::NodeHandle& private_nh)
    : monitor_(nh, Parameters::fromRos(private_nh)),
      server_(private_nh, monitor_),
      diagnostics_(private_nh, monitor_, server_),
      registration_(server_.services(), private_nh.getNamespace()) {
  if (isKernelChoiceRefused()) {
    ROS_WARN("BOX_QUERY_KERNEL names no kernels that this CPU can run: portable, avx2, avx512");
  }
  ROS_INFO("Computing with the %s kernels", activeKernels());
}

}  // namespace box_query
