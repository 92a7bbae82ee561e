// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/backlog.h"
#include "ros/box_source.h"

#include <box_query/ros/parameters.h>

#include <cstddef>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

namespace box_query {

/// Hears the topics of boxes. What roscpp receives goes to a backlog at once; a thread of its own
/// decodes it.
class BoxTopics {
 public:
  using Receive = std::function<void(const Backlog::Message& message, DecodedMessage&& decoded)>;
  using TellUnheard =
      std::function<void(std::size_t topic, std::size_t publishers, const std::string& type)>;

  /// The topics' names are resolved ones. `receive` is called for every message, one at a time,
  /// once start() was called.
  BoxTopics(const ros::NodeHandle& nh, const Parameters& parameters, Receive receive);

  void start();
  /// Returns when no message is received any more. Must be called after start().
  void stop();

  /// Subscribes anew where that lets a publisher of another type be heard, and tells of every topic
  /// how many publishers cannot be heard, and the type of the one that came last. Asks the master;
  /// from one thread only, not within `receive`.
  /// @return whether to look again soon: somebody has gone, and nobody has come yet
  bool checkPublishers(const TellUnheard& tell);

 private:
  struct Topic {
    std::string name;
    ros::Subscriber subscriber;
    bool is_pinned = false;  ///< there was a publisher since it was subscribed to
    // At the last look:
    bool was_alone = false;  ///< no publisher was connected
    bool missing = false;    ///< more publishers were there than were connected
  };

  /// Calls back in the thread that a message comes in: roscpp has nothing left to keep.
  class Immediately : public ros::CallbackQueueInterface {
   public:
    void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t /*owner*/) override {
      callback->call();
    }
    void removeByID(std::uint64_t /*owner*/) override {}
  };

  void subscribe(std::size_t topic);
  void decode();

  ros::NodeHandle nh_;
  const Limits limits_;
  const Receive receive_;
  Immediately immediately_;
  Backlog backlog_;
  std::vector<Topic> topics_;
  std::thread decoder_;
};

}  // namespace box_query
