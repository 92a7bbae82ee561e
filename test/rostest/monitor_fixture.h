// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What tests of the SceneMonitor through a real master share. Every test has topics and frames of
/// its own, and every wait an end.
#pragma once

#include <box_query/ros/scene_monitor.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

namespace box_query {

/// Whether `condition` comes true within 10 s of wall time.
inline bool eventually(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

inline visualization_msgs::Marker cube(const std::string& frame, int id, double x, double y = 0.0,
                                       double z = 0.0) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = frame;
  marker.ns = "test";
  marker.id = id;
  marker.type = visualization_msgs::Marker::CUBE;
  marker.pose.position.x = x;
  marker.pose.position.y = y;
  marker.pose.position.z = z;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  return marker;
}

inline visualization_msgs::Marker withAction(visualization_msgs::Marker marker, int action) {
  marker.action = action;
  return marker;
}

inline visualization_msgs::MarkerArray array(std::vector<visualization_msgs::Marker> markers) {
  visualization_msgs::MarkerArray message;
  message.markers = std::move(markers);
  return message;
}

inline Parameters listenTo(const std::vector<std::string>& topics) {
  Parameters parameters;
  parameters.box_topics.clear();
  for (const std::string& topic : topics) {
    TopicParameters one;
    one.topic = topic;
    parameters.box_topics.push_back(one);
  }
  return parameters;
}

/// Publishes on one topic to a monitor that is known to listen.
template <typename Message>
class Talker {
 public:
  explicit Talker(const std::string& topic) : publisher_(node_.advertise<Message>(topic, 1000)) {}

  bool isHeard() {
    return eventually([this] { return publisher_.getNumSubscribers() > 0; });
  }
  void say(const Message& message) { publisher_.publish(message); }

 private:
  ros::NodeHandle node_;
  ros::Publisher publisher_;
};
using ArrayTalker = Talker<visualization_msgs::MarkerArray>;

/// A message of /tf; rotations are about z [rad].
inline tf2_msgs::TFMessage transform(const std::string& parent, const std::string& child,
                                     const ros::Time& stamp, double x, double yaw = 0.0) {
  geometry_msgs::TransformStamped one;
  one.header.frame_id = parent;
  one.header.stamp = stamp;
  one.child_frame_id = child;
  one.transform.translation.x = x;
  one.transform.rotation.z = std::sin(yaw / 2.0);
  one.transform.rotation.w = std::cos(yaw / 2.0);
  tf2_msgs::TFMessage message;
  message.transforms.push_back(one);
  return message;
}

inline Completeness completenessOf(SceneMonitor& monitor) {
  return monitor.currentScene()->completeness(ros::Time::now());
}

inline bool hasBoxes(SceneMonitor& monitor, std::size_t boxes) {
  return eventually([&] { return monitor.currentScene()->scene.size() == boxes; });
}

inline const OrientedBox& boxOf(const Snapshot& snapshot, std::size_t index) {
  return std::get<OrientedBox>(snapshot.scene.boxes().at(index));
}

/// "id:x" of every box, in order.
inline std::string contents(const Snapshot& snapshot) {
  std::string text;
  for (std::size_t i = 0; i < snapshot.names.size(); ++i) {
    text += std::to_string(snapshot.names[i].id) + ":" +
            std::to_string(std::lround(boxOf(snapshot, i).center.x())) + " ";
  }
  return text;
}

/// A monitor of one topic that has the name of the test, and what publishes there.
class MonitorOfOneTopic : public testing::Test {
 protected:
  MonitorOfOneTopic()
      : topic_(std::string("/") + testing::UnitTest::GetInstance()->current_test_info()->name()),
        parameters_(listenTo({topic_})) {}

  /// With parameters_ as they are.
  void listen() { monitor_ = std::make_unique<SceneMonitor>(ros::NodeHandle(), parameters_); }
  /// The same, with a publisher that is heard.
  void start() {
    listen();
    talker_ = std::make_unique<ArrayTalker>(topic_);
    ASSERT_TRUE(talker_->isHeard());
  }

  void say(const std::vector<visualization_msgs::Marker>& markers) { talker_->say(array(markers)); }

  bool holds(const std::string& expected) {
    return eventually([&] { return contents(*monitor_->currentScene()) == expected; });
  }
  bool becomes(bool complete) {
    return eventually([&] { return completenessOf(*monitor_).complete == complete; });
  }
  /// Checks that the scene is incomplete for a reason with these words.
  void expectReason(const std::vector<std::string>& words) {
    const Completeness known = completenessOf(*monitor_);
    EXPECT_FALSE(known.complete);
    for (const std::string& word : words) {
      EXPECT_NE(known.reason.find(word), std::string::npos) << word << " in " << known.reason;
    }
  }

  const std::string topic_;
  Parameters parameters_;
  std::unique_ptr<SceneMonitor> monitor_;
  std::unique_ptr<ArrayTalker> talker_;
};

}  // namespace box_query
