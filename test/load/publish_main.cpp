// SPDX-License-Identifier: BSD-3-Clause
// Publishes load/world.h until it is ended: every topic ten times a second, one after the other,
// and the transforms.
#include "load/messages.h"

#include <chrono>
#include <thread>

#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

namespace box_query::load {
namespace {

constexpr std::int64_t kSlot = 10000000;  // [ns] between two messages, of different topics

void sendTransforms(ros::NodeHandle& nh) {
  const ros::Publisher publisher = nh.advertise<tf2_msgs::TFMessage>("/tf", 100);
  Tick next = tickAt(ros::Time::now()) / kTicksPerTransform * kTicksPerTransform;
  for (; ros::ok(); next += kTicksPerTransform) {
    ros::Time::sleepUntil(timeOf(next));
    tf2_msgs::TFMessage message;
    message.transforms = transformsAt(next);
    publisher.publish(message);
  }
}

void sendBoxes(ros::NodeHandle& nh) {
  std::vector<ros::Publisher> publishers;
  for (const TopicOfBoxes& topic : topics()) {
    publishers.push_back(advertise(nh, topic.name, rosType(topic.type), 100));
  }
  auto slot = static_cast<std::int64_t>(ros::Time::now().toNSec()) / kSlot;
  while (ros::ok()) {
    ros::Time due;
    due.fromNSec(static_cast<std::uint64_t>(++slot * kSlot));
    ros::Time::sleepUntil(due);
    const auto topic = static_cast<std::size_t>(slot) % kTopics;
    publishers[topic].publish(messageAt(topic, tickAt(due)));
  }
}

}  // namespace
}  // namespace box_query::load

int main(int argc, char** argv) {
  ros::init(argc, argv, "load_publisher");
  ros::NodeHandle nh;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  std::thread transforms([&nh] { box_query::load::sendTransforms(nh); });
  box_query::load::sendBoxes(nh);
  transforms.join();
  return 0;
}
