// SPDX-License-Identifier: BSD-3-Clause
#include "ros/markers.h"

#include "ros/marker_shapes.h"

#include <algorithm>
#include <utility>

#include <ros/single_subscriber_publisher.h>
#include <visualization_msgs/MarkerArray.h>

namespace box_query {

Markers::Markers(ros::NodeHandle& private_nh, SceneMonitor& monitor) : monitor_(monitor) {
  auto options = ros::AdvertiseOptions::create<visualization_msgs::MarkerArray>(
      "markers", 10,
      [this](const ros::SingleSubscriberPublisher& subscriber) { welcome(subscriber); },
      ros::SubscriberStatusCallback(), ros::VoidConstPtr(), &queue_);
  publisher_ = private_nh.advertise(options);
  thread_ = std::thread([this] { run(); });
}

Markers::~Markers() {
  queue_.disable();
  thread_.join();
}

Drawing Markers::drawing() const {
  return Drawing(wanted_ ? static_cast<std::size_t>(monitor_.parameters().max_marker_queries) : 0);
}

void Markers::show(std::vector<DrawnQuery> queries) {
  if (queries.empty()) {
    return;
  }
  const auto most = static_cast<std::size_t>(monitor_.parameters().max_marker_queries);
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::size_t both = queries_.size() + queries.size();
  if (both > most) {
    const std::size_t dropped = std::min(both - most, queries_.size());
    queries_.erase(queries_.begin(), queries_.begin() + static_cast<std::ptrdiff_t>(dropped));
  }
  queries_.insert(queries_.end(), queries.begin(), queries.end());
}

void Markers::run() {
  const ros::WallDuration period(1 / monitor_.parameters().marker_rate);
  const ros::WallDuration idle(1.0);
  ros::WallTime next = ros::WallTime::now();
  while (queue_.isEnabled()) {
    const ros::WallDuration left = next - ros::WallTime::now();
    queue_.callAvailable(!wanted_ ? idle : std::max(left, ros::WallDuration(0.001)));
    wanted_ = publisher_.getNumSubscribers() > 0;
    if (!wanted_) {
      shown_.reset();
    } else if (ros::WallTime::now() >= next) {
      next = ros::WallTime::now() + period;
      publish();
    }
  }
}

void Markers::welcome(const ros::SingleSubscriberPublisher& subscriber) {
  const SnapshotPtr scene = monitor_.watchedScene();
  visualization_msgs::MarkerArray array;
  array.markers = boxMarkers(*scene);
  if (!array.markers.empty()) {
    subscriber.publish(array);
  }
  if (publisher_.getNumSubscribers() == 1) {
    shown_ = scene;
  }
}

void Markers::publish() {
  visualization_msgs::MarkerArray array;
  const SnapshotPtr scene = monitor_.watchedScene();
  // Snapshots of the same boxes share them.
  if (!shown_ || &scene->scene.boxes() != &shown_->scene.boxes()) {
    array.markers = boxMarkers(*scene);
    if (shown_) {
      const auto deleted = deletedBoxMarkers(*shown_, *scene);
      array.markers.insert(array.markers.end(), deleted.begin(), deleted.end());
    }
    shown_ = scene;
  }
  std::vector<DrawnQuery> queries;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    queries.swap(queries_);
  }
  const auto drawn =
      queryMarkers(queries, scene->frame, monitor_.parameters().marker_lifetime, last_id_);
  last_id_ += drawn.empty() ? 0 : 1;
  array.markers.insert(array.markers.end(), drawn.begin(), drawn.end());
  if (!array.markers.empty()) {
    publisher_.publish(array);
  }
}

}  // namespace box_query
