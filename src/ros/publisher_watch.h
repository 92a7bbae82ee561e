// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/bell.h"
#include "ros/box_topics.h"
#include "ros/box_tracker.h"
#include "ros/succession.h"

#include <box_query/ros/parameters.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace box_query {

/// Watches who publishes the topics and the clock, which roscpp does not tell, and lets the tracker
/// know: of publishers that cannot be heard, of former ones that have made way for new ones, and of
/// a simulated clock that nobody publishes any more. Asks the master, which may take its time, from
/// a thread of its own.
class PublisherWatch {
 public:
  /// `mutex` guards the tracker. `forgotten` is called after what former publishers said was
  /// forgotten.
  PublisherWatch(const Parameters& parameters, BoxTracker& tracker, std::timed_mutex& mutex,
                 std::function<void()> forgotten);

  /// The topics must not stop before this does.
  void start(BoxTopics& topics);
  /// Returns when nothing is watched any more. Must be called after start().
  void stop();

  /// Who publishes the topic, if that connection is a new one: by the time of a look they may be
  /// gone again. To be called before each message is received, without the mutex.
  std::optional<Succession::Addresses> meet(std::size_t topic,
                                            const Succession::Connection& connection);
  /// Notes that. With the mutex locked until the message is received: what former publishers said
  /// is not to be forgotten before.
  void hear(std::size_t topic, const Succession::Connection& connection,
            Succession::Addresses&& publishers);
  /// Has a look at whether those are gone, and returns when they were forgotten, or soon: no scene
  /// should be built in vain. Without the mutex.
  void look(std::size_t topic);

 private:
  void run(BoxTopics& topics);
  bool checkPublishers(BoxTopics& topics);
  void checkClock();
  void forgetFormerPublishers();

  const Parameters& parameters_;
  BoxTracker& tracker_;
  std::timed_mutex& mutex_;  ///< guards the successions too
  const std::function<void()> forgotten_;
  std::vector<Succession> successions_;  ///< of the publishers of each topic
  Bell bell_;
  Bell looked_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace box_query
