// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/node_client.h"
#include "benchmark/node_processes.h"
#include "benchmark/node_report.h"
#include "benchmark/node_server.h"

#include <cstring>
#include <fstream>
#include <iostream>

#include <ros/init.h>

namespace {

using namespace box_query::benchmark;

constexpr const char* kUsage =
    R"(What the node costs, on a ROS master of its own. Every answer is compared with the library's while it is timed.

Calls: a batch to a service of the node; beside a plain roscpp service of the same type in the same process, which
takes and sends the same bytes and does nothing ("empty"); and beside the library's own call. All in turns over
persistent connections, of each the lower quartile. The ratio is the node's time over the sum of the other two, its
median over connections.
Boxes: from a message on the wire to the first answer from its boxes; beside a plain roscpp node in the same process
that builds a Scene of each message. Behind them what roscpp's decoding and that build take on their own.

  --quick       fewer scenes and calls: under a minute, else two
  --only REGEX  only rows whose "SERVICE ASKS BOXES QUERIES THREADS" (0: all) or "boxes BOXES HZ" matches
  --csv FILE    write the table there too
  --bars        end with what is promised of the ratios, a line a bar

Where other programs run, "chrt -r 1" before the command of the program keeps them from being measured too.
)";

struct Arguments {
  bool quick = false;
  bool bars = false;
  std::regex only{".*"};
  std::string csv;
};

/// @return false after an argument that it does not know
bool parse(int argc, char** argv, Arguments& arguments) {
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--quick") == 0) {
      arguments.quick = true;
    } else if (std::strcmp(argv[i], "--bars") == 0) {
      arguments.bars = true;
    } else if (std::strcmp(argv[i], "--only") == 0 && i + 1 < argc) {
      arguments.only = std::regex(argv[++i]);
    } else if (std::strcmp(argv[i], "--csv") == 0 && i + 1 < argc) {
      arguments.csv = argv[++i];
    } else {
      return false;
    }
  }
  return true;
}

/// The server, and a client of it.
struct Both {
  explicit Both(int threads)
      : server({"/proc/self/exe", kServerArgument, "_batch_threads:=" + std::to_string(threads)}) {}
  Process server;
  NodeClient client;
};

void run(const Arguments& arguments) {
  CallOptions call_options;
  BoxesOptions boxes_options;
  call_options.only = boxes_options.only = arguments.only;
  if (arguments.quick) {
    call_options.boxes = {1000};
    call_options.connections = 11;
    call_options.rounds = 48;
    boxes_options.seconds = 3.0;
  }
  const Master master;
  ros::init(ros::M_string(), "box_query_benchmark",
            ros::init_options::NoSigintHandler | ros::init_options::NoRosout);
  const ros::NodeHandle keeps_ros_alive;
  std::vector<CallRow> calls;
  printCallHeader(std::cout);
  for (const int threads : {1, 0}) {
    if (threads != 1 && !haveTwoCores()) {
      std::cout << "More threads are not measured, since other programs keep the cores busy.\n";
      continue;
    }
    call_options.threads = threads;
    Both both(threads);
    measureCalls(both.client, call_options, [&](const CallRow& row) {
      print(row, std::cout);
      calls.push_back(row);
    });
  }
  std::vector<BoxesRow> boxes;
  std::cout << '\n';
  printBoxesHeader(std::cout);
  Both both(1);
  measureBoxes(both.client, boxes_options, [&](const BoxesRow& row) {
    print(row, std::cout);
    boxes.push_back(row);
  });
  if (!arguments.csv.empty()) {
    std::ofstream file(arguments.csv);
    writeCsv(calls, boxes, file);
    if (!file.flush()) {
      throw std::runtime_error("cannot write " + arguments.csv);
    }
  }
  if (arguments.bars) {
    std::cout << '\n';
    printBars(nodeBars(calls, boxes), std::cout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], kServerArgument) == 0) {
    return serve(argc, argv);
  }
  Arguments arguments;
  if (!parse(argc, argv, arguments)) {
    const bool asked = std::strcmp(argv[argc - 1], "--help") == 0;
    (asked ? std::cout : std::cerr) << kUsage;
    return asked ? 0 : 2;
  }
  try {
    run(arguments);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
