// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The node: a SceneMonitor with services in front and markers behind.
#include "ros/server.h"

#include <box_query/ros/scene_monitor.h>
#include <box_query/scene.h>

#include <csignal>
#include <cstring>
#include <iostream>
#include <stdexcept>

#include <ros/ros.h>

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--help") == 0) {
    std::cout << "Services in front of box topics. Parameters:\n\n"
              << box_query::Parameters::documentation();
    return 0;
  }
  ros::init(argc, argv, "box_query");
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  if (box_query::isKernelChoiceRefused()) {
    ROS_WARN("BOX_QUERY_KERNEL names no kernels that this CPU can run: portable, avx2, avx512");
  }
  ROS_INFO("Computing with the %s kernels", box_query::activeKernels());
  ros::NodeHandle nh;
  ros::NodeHandle private_nh("~");
  try {
    box_query::SceneMonitor monitor(nh, box_query::Parameters::fromRos(private_nh));
    const box_query::Server server(private_nh, monitor);
    ros::waitForShutdown();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
