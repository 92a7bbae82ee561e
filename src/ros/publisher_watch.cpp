// SPDX-License-Identifier: BSD-3-Clause
#include "ros/publisher_watch.h"

#include "ros/publishers.h"
#include "ros/ros_api.h"

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include <ros/console.h>
#include <ros/this_node.h>
#include <ros/time.h>

namespace box_query {
namespace {

using Clock = Bell::Clock;

/// Between looks at whether former publishers are gone, where somebody new has spoken.
constexpr std::chrono::milliseconds kSuccessionCheck(50);
/// Between looks at who publishes, and where nobody does any more.
constexpr std::chrono::milliseconds kPublisherCheck(500);
constexpr std::chrono::milliseconds kGoneCheck(100);

/// The master may take its time, or hang.
constexpr std::chrono::milliseconds kPatience(50);

}  // namespace

PublisherWatch::PublisherWatch(const Parameters& parameters, BoxTracker& tracker,
                               std::timed_mutex& mutex, std::function<void()> forgotten)
    : parameters_(parameters),
      tracker_(tracker),
      mutex_(mutex),
      forgotten_(std::move(forgotten)),
      successions_(parameters.box_topics.size(),
                   Succession(ros::this_node::getName(), ownAddress())) {}

void PublisherWatch::start(BoxTopics& topics) {
  thread_ = std::thread([this, &topics] { run(topics); });
}

void PublisherWatch::stop() {
  stopping_ = true;
  bell_.ring();
  thread_.join();
}

std::optional<Succession::Addresses> PublisherWatch::meet(
    std::size_t topic, const Succession::Connection& connection) {
  {
    const std::lock_guard<std::timed_mutex> lock(mutex_);
    if (!successions_[topic].isNew(connection)) {
      return std::nullopt;
    }
  }
  auto connected = connectedPublishers();
  return connected ? std::move((*connected)[parameters_.box_topics[topic].topic])
                   : Succession::Addresses();
}

void PublisherWatch::hear(std::size_t topic, const Succession::Connection& connection,
                          Succession::Addresses&& publishers) {
  successions_[topic].hear(connection, std::move(publishers), tracker_.lastWord(), Clock::now());
}

void PublisherWatch::look(std::size_t topic) {
  const Clock::time_point deadline = Clock::now() + kPatience;
  bell_.ring();
  while (Clock::now() < deadline) {
    const std::uint64_t rings = looked_.rings();
    {
      const std::lock_guard<std::timed_mutex> lock(mutex_);
      if (successions_[topic].isLooked()) {
        return;
      }
    }
    looked_.waitPast(rings, deadline);
  }
}

void PublisherWatch::run(BoxTopics& topics) {
  Clock::time_point publisher_check = Clock::now();
  while (!stopping_) {
    const std::uint64_t rings = bell_.rings();
    forgetFormerPublishers();
    looked_.ring();
    if (Clock::now() >= publisher_check) {
      const bool is_soon_again = checkPublishers(topics);
      checkClock();
      publisher_check = Clock::now() + (is_soon_again ? kGoneCheck : kPublisherCheck);
    }
    bell_.waitPast(rings, Clock::now() + kSuccessionCheck);
  }
}

bool PublisherWatch::checkPublishers(BoxTopics& topics) {
  return topics.checkPublishers(
      [this](std::size_t topic, std::size_t publishers, const std::string& type) {
        std::unique_lock<std::timed_mutex> lock(mutex_);
        const std::string warning = tracker_.setUnheard(topic, publishers, type);
        lock.unlock();
        ROS_WARN_STREAM_COND(!warning.empty(), "box_query: " << warning);
      });
}

void PublisherWatch::checkClock() {
  const auto there = ros::Time::isSimTime() ? addressesOfPublishers("/clock") : std::nullopt;
  if (there && there->empty()) {
    const std::lock_guard<std::timed_mutex> lock(mutex_);
    tracker_.setClockGone(!ros::Time::now().isZero());
  }
}

void PublisherWatch::forgetFormerPublishers() {
  std::unique_lock<std::timed_mutex> lock(mutex_);
  for (std::size_t topic = 0; topic < successions_.size(); ++topic) {
    if (successions_[topic].asks(Clock::now())) {
      lock.unlock();
      const auto there = addressesOfPublishers(parameters_.box_topics[topic].topic);
      lock.lock();
      if (const auto last_word = there ? successions_[topic].look(*there) : std::nullopt) {
        tracker_.forgetBefore(topic, *last_word);
        forgotten_();
      }
    }
  }
}

}  // namespace box_query
