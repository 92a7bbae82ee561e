// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// /diagnostics: whether the scene is complete, and what has come, waits, was rejected and was
/// done.
#pragma once

#include "ros/bell.h"
#include "ros/server.h"

#include <box_query/ros/scene_monitor.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <thread>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

namespace box_query {

/// Publishes once a second of wall time, whatever the ROS clock does, from a thread of its own, and
/// only while somebody subscribes: one status of the scene, one a topic, one of the work. OK, or
/// WARN with the reason for which the scene, or a topic in it, is incomplete.
class Diagnostics {
 public:
  /// Both outlive it.
  Diagnostics(ros::NodeHandle& private_nh, SceneMonitor& monitor, const Server& server);
  ~Diagnostics();
  Diagnostics(const Diagnostics&) = delete;
  Diagnostics& operator=(const Diagnostics&) = delete;

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  void run();
  void look();
  void describeScene(Status& status) const;
  void describeTopic(std::size_t index, Status& status);
  void describeWork(Status& status);

  /// Of what has been counted so far, since the look before. [1/s]
  double rate(const std::string& what, std::uint64_t count);

  SceneMonitor& monitor_;
  const Server& server_;
  ros::Publisher subscribers_;  ///< the updater's own is private; one topic has one connection
  diagnostic_updater::Updater updater_;

  // At the last look.
  SnapshotPtr scene_;
  MonitorStatistics statistics_;
  ros::Time now_;
  Bell::Clock::time_point time_;
  double interval_ = 0.0;  ///< [s] since the look before
  std::map<std::string, std::uint64_t> counts_;

  std::atomic<bool> stopping_{false};
  Bell bell_;
  std::thread thread_;
};

}  // namespace box_query
