// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The node as a process of its own.
#include "ros/memory.h"
#include "ros/node.h"

#include <box_query/ros/parameters.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <thread>

#include <ros/ros.h>

namespace {

/// roscpp takes leave of the master, and waits for ever if that hangs.
void endWhateverTheMasterDoes() {
  std::thread([] {
    while (!ros::isShuttingDown()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    std::this_thread::sleep_for(std::chrono::seconds(5));
    std::_Exit(EXIT_SUCCESS);
  }).detach();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--help") == 0) {
    std::cout << "Services in front of box topics. Parameters:\n\n"
              << box_query::Parameters::documentation();
    return 0;
  }
  box_query::keepFreedMemory();
  ros::init(argc, argv, "box_query");
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  endWhateverTheMasterDoes();
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
