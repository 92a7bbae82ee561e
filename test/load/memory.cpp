// SPDX-License-Identifier: BSD-3-Clause
#include "load/memory.h"

#include <chrono>
#include <fstream>
#include <stdexcept>

#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcClient.h>

namespace box_query::load {
namespace {

/// [MB]
double residentMemory(int pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/statm");
  double all = 0.0;
  double resident = 0.0;
  file >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

}  // namespace

int processOf(const std::string& node) {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  request[1] = node;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::master::execute("lookupNode", request, response, payload, false) ||
      !ros::network::splitURI(payload, host, port)) {
    throw std::runtime_error("there is no node " + node);
  }
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port));
  XmlRpc::XmlRpcValue caller, answer;
  caller[0] = ros::this_node::getName();
  if (!client.execute("getPid", caller, answer) || answer.size() != 3) {
    throw std::runtime_error("node " + node + " does not say its process id");
  }
  return answer[2];
}

MemoryWatch::MemoryWatch(int pid)
    : thread_([this, pid] {
        using Clock = std::chrono::steady_clock;
        const Clock::time_point start = Clock::now();
        for (int look = 0; !stopping_; ++look) {
          std::this_thread::sleep_until(start + look * std::chrono::milliseconds(500));
          looks_.emplace_back(std::chrono::duration<double>(Clock::now() - start).count(),
                              residentMemory(pid));
        }
      }) {}

MemoryWatch::~MemoryWatch() {
  if (thread_.joinable()) {
    stop();
  }
}

void MemoryWatch::stop() {
  stopping_ = true;
  thread_.join();
}

double MemoryWatch::at(double seconds) const {
  double found = 0.0;
  for (const auto& [when, megabytes] : looks_) {
    if (when <= seconds + 0.25) {
      found = megabytes;
    }
  }
  return found;
}

}  // namespace box_query::load
