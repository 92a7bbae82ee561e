// SPDX-License-Identifier: BSD-3-Clause
#include "ros/node.h"

#include <box_query/scene.h>

#include <ros/console.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

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

void keepFreedMemory() {
#ifdef __GLIBC__
  constexpr int kMegabyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 4 * kMegabyte);
  mallopt(M_TRIM_THRESHOLD, 16 * kMegabyte);
#endif
}

}  // namespace box_query
