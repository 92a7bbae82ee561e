// SPDX-License-Identifier: BSD-3-Clause
#include "ros/markers.h"

#include <algorithm>
#include <utility>

#include <ros/single_subscriber_publisher.h>
#include <visualization_msgs/MarkerArray.h>

namespace box_query {
namespace {

/// Messages that wait for a subscriber, beside that which is being sent to it. Of 100,000 boxes
/// one has 144 MB, and whoever does not read makes the node keep all of them.
constexpr std::uint32_t kQueue = 1;

/// [s] after which boxes are said again where queries may have taken their place in the queue.
constexpr double kSaidAgain = 5.0;

}  // namespace

Markers::Markers(ros::NodeHandle& private_nh, SceneMonitor& monitor) : monitor_(monitor) {
  auto options = ros::AdvertiseOptions::create<visualization_msgs::MarkerArray>(
      "markers", kQueue,
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

Markers::Shown Markers::look() const {
  Shown look{monitor_.watchedScene(), ros::Time::now(), ros::WallTime::now(), {}, {}};
  look.status = statusText(*look.scene, look.time);
  return look;
}

/// Whether both look alike. Snapshots of the same boxes share them; what is stale is in the status.
bool Markers::Shown::looksLike(const Shown& other) const {
  return &scene->scene.boxes() == &other.scene->scene.boxes() &&
         scene->outdated == other.scene->outdated && status == other.status;
}

std::vector<visualization_msgs::Marker> Markers::draw(const Shown& look) const {
  const auto labels = static_cast<std::size_t>(monitor_.parameters().max_marker_labels);
  return boxMarkers(*look.scene, look.time, labels);
}

void Markers::welcome(const ros::SingleSubscriberPublisher& subscriber) {
  Shown now = look();
  visualization_msgs::MarkerArray array;
  array.markers = draw(now);
  if (!array.markers.empty()) {
    subscriber.publish(array);
  }
  if (publisher_.getNumSubscribers() == 1) {
    now.names = namesOf(array.markers);
    shown_ = std::move(now);
  }
}

void Markers::publish() {
  visualization_msgs::MarkerArray array;
  Shown now = look();
  const bool says_boxes = !shown_ || !now.looksLike(*shown_) ||
                          (shown_->is_overtaken && (now.said - shown_->said).toSec() >= kSaidAgain);
  if (says_boxes) {
    array.markers = draw(now);
    if (shown_) {
      const auto deleted = deletions(shown_->names, array.markers, now.scene->frame);
      array.markers.insert(array.markers.end(), deleted.begin(), deleted.end());
    }
    now.names = namesOf(array.markers);
    shown_ = std::move(now);
  }
  std::vector<DrawnQuery> queries;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    queries.swap(queries_);
  }
  const auto drawn = queryMarkers(queries, monitor_.parameters().fixed_frame,
                                  monitor_.parameters().marker_lifetime, last_id_);
  if (!drawn.empty()) {
    ++last_id_;
    shown_->is_overtaken |= !says_boxes;
  }
  array.markers.insert(array.markers.end(), drawn.begin(), drawn.end());
  if (!array.markers.empty()) {
    publisher_.publish(array);
  }
}

}  // namespace box_query
