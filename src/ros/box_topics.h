// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/any_box_message.h"

#include <box_query/ros/parameters.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>

namespace box_query {

/// Hears the topics of boxes, on a thread of its own.
class BoxTopics {
 public:
  using Receive = std::function<void(std::size_t topic, AnyBoxMessage& message)>;
  using TellUnheard =
      std::function<void(std::size_t topic, std::size_t publishers, const std::string& type)>;

  /// The topics' names are resolved ones. `receive` is called for every message, one at a time,
  /// once start() was called.
  BoxTopics(const ros::NodeHandle& nh, const Parameters& parameters, Receive receive);

  void start();
  /// Returns when no message is received any more.
  void stop();

  /// Subscribes anew where that lets a publisher of another type be heard, and tells of every topic
  /// how many publishers cannot be heard, and the type of the one that came last. Asks the master;
  /// from one thread only, not within `receive`.
  void checkPublishers(const TellUnheard& tell);

 private:
  struct Topic {
    std::string name;
    ros::Subscriber subscriber;
    // At the last look:
    bool connected = false;  ///< to a publisher
    bool missing = false;    ///< more publishers were there than were connected
  };

  void subscribe(std::size_t topic);

  ros::NodeHandle nh_;
  const Limits limits_;
  const Receive receive_;
  ros::CallbackQueue queue_;
  std::vector<Topic> topics_;
  ros::AsyncSpinner spinner_;
};

}  // namespace box_query
