// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The node as a process of its own.
#include "ros/memory.h"
#include "ros/node.h"

#include <box_query/ros/parameters.h>

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
  box_query::keepFreedMemory();
  ros::init(argc, argv, "box_query");
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  const ros::NodeHandle nh;
  ros::NodeHandle private_nh("~");
  try {
    const box_query::Node node(nh, private_nh);
    ros::waitForShutdown();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
