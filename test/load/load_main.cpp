// SPDX-License-Identifier: BSD-3-Clause
#include "load/run.h"

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <thread>

#include <ros/ros.h>

namespace {

using namespace box_query::load;

constexpr const char* kUsage =
    R"(16 clients ask the node at once, half of them with new connections, while 10 topics of 1,000 boxes come 10 times a
second each and frames move. Every answer is checked against the exact one for the scene that it names. Then a
message of 1e6 boxes comes while one client asks, and a batch of 1e6 rays is asked while messages come.

  --seconds N  that the clients ask (60)
  --bars       end with what is promised, and whether it holds, a line a bar
Returns 0 only if no answer was wrong or lost.
)";

/// What starts it may not be done.
void waitForMaster() {
  for (int tries = 0; !ros::master::check(); ++tries) {
    if (tries == 300) {
      throw std::runtime_error("there is no ROS master");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "load");
  double seconds = 60.0;
  bool bars = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--bars") == 0) {
      bars = true;
    } else if (std::strcmp(argv[i], "--seconds") == 0 && i + 1 < argc &&
               std::atof(argv[i + 1]) > 0.0) {
      seconds = std::atof(argv[++i]);
    } else {
      const bool asked = std::strcmp(argv[i], "--help") == 0;
      (asked ? std::cout : std::cerr) << kUsage;
      return asked ? 0 : 2;
    }
  }
  try {
    waitForMaster();
    const ros::NodeHandle keeps_ros_alive;
    Measured measured = askAndCheck(seconds, 50);
    print(measured, std::cout);
    std::cout.flush();
    measured.beside_message = askBesideMessage(1000000);
    measured.beside_batch = askBesideBatch(1000000);
    if (bars) {
      std::cout << '\n';
      printBars(barsOf(measured), std::cout);
    }
    return measured.isFlawless() ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
