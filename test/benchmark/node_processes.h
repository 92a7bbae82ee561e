// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Processes that end with this one.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace box_query::benchmark {

/// A program that runs while this lives. What it prints is dropped, what it complains of is not.
class Process {
 public:
  /// @param arguments the first is the program, which is looked for in PATH
  explicit Process(const std::vector<std::string>& arguments);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

 private:
  pid_t pid_;
};

/// A ROS master of our own on a free port of this host, for this process and those that it starts:
/// nothing else that runs here is disturbed.
class Master {
 public:
  Master();

 private:
  /// Where it and nodes log.
  class Home {
   public:
    Home();
    ~Home();
    Home(const Home&) = delete;
    Home& operator=(const Home&) = delete;

   private:
    std::string path_;
  };

  Home home_;
  int port_;
  Process process_;
};

}  // namespace box_query::benchmark
