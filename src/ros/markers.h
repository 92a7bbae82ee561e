// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// ~markers: what the node believes, and what it was asked last.
#pragma once

#include "ros/drawing.h"
#include "ros/marker_shapes.h"

#include <box_query/ros/scene_monitor.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

namespace box_query {

/// Publishes markers from a thread of its own, only while somebody subscribes: the boxes whenever
/// they have changed, and at once to a new subscriber; the queries since the last time. Whoever
/// reads slowly misses messages, and sees the right boxes again with the latest that has some.
class Markers {
 public:
  Markers(ros::NodeHandle& private_nh, SceneMonitor& monitor);
  ~Markers();
  Markers(const Markers&) = delete;
  Markers& operator=(const Markers&) = delete;

  /// What a query should be drawn on: nothing, where nobody looks.
  Drawing drawing() const;

  /// Takes queries over; never waits for markers being built.
  void show(std::vector<DrawnQuery> queries);

 private:
  /// What subscribers have got of the boxes.
  struct Shown {
    bool looksLike(const Shown& other) const;

    SnapshotPtr scene;
    ros::Time time;
    ros::WallTime said;
    std::string status;
    std::vector<MarkerName> names;  ///< also of those that were taken away: that may be missed
    bool is_overtaken = false;      ///< whether queries have been said after it
  };

  void run();
  Shown look() const;
  std::vector<visualization_msgs::Marker> draw(const Shown& look) const;
  void welcome(const ros::SingleSubscriberPublisher& subscriber);
  void publish();

  SceneMonitor& monitor_;
  ros::CallbackQueue queue_;  ///< of the thread: subscribers that come
  ros::Publisher publisher_;
  std::atomic<bool> wanted_{false};
  std::optional<Shown> shown_;  ///< what every subscriber has got; of the thread
  std::int32_t last_id_ = 0;

  std::mutex mutex_;
  std::vector<DrawnQuery> queries_;  ///< to be shown, guarded by mutex_

  std::thread thread_;
};

}  // namespace box_query
