// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_topics.h"

#include "ros/publishers.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <boost/function.hpp>
#include <ros/subscribe_options.h>

namespace box_query {

BoxTopics::BoxTopics(const ros::NodeHandle& nh, const Parameters& parameters, Receive receive)
    : nh_(nh),
      limits_(parameters),
      receive_(std::move(receive)),
      backlog_(parameters.box_topics.size(),
               static_cast<std::size_t>(parameters.max_backlog_memory) * 1000000),
      topics_(parameters.box_topics.size()) {
  for (std::size_t topic = 0; topic < topics_.size(); ++topic) {
    topics_[topic].name = parameters.box_topics[topic].topic;
    subscribe(topic);
  }
}

void BoxTopics::start() {
  decoder_ = std::thread([this] { decode(); });
}

void BoxTopics::stop() {
  for (Topic& topic : topics_) {
    topic.subscriber.shutdown();
  }
  backlog_.close();
  decoder_.join();
}

void BoxTopics::subscribe(std::size_t topic) {
  constexpr std::uint32_t kUnbounded = 0;  // of a queue that is always empty
  const boost::function<void(const RawMessagePtr&)> callback =
      [this, topic](const RawMessagePtr& message) { backlog_.add(topic, message); };
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const RawMessagePtr&>(topics_[topic].name, kUnbounded, callback);
  options.callback_queue = &immediately_;
  options.allow_concurrent_callbacks = true;  // nobody would call again what is not called at once
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  topics_[topic].subscriber = nh_.subscribe(options);
}

void BoxTopics::decode() {
  while (const auto message = backlog_.take()) {
    const RawMessage& raw = *message->raw;
    DecodedMessage decoded;
    decoded.problem = raw.problem;
    if (raw.source) {
      decoded = decodeMessage(*raw.source, raw.bytes.get(), raw.size, limits_);
    }
    receive_(*message, std::move(decoded));
  }
}

namespace {

/// Whether somebody has come to a topic since these were its publishers.
bool hasCome(const std::string& topic, const Publishers& publishers) {
  auto links = connectedPublishers();
  if (!links) {
    return false;
  }
  const std::set<std::string>& now = (*links)[topic];
  return !std::includes(publishers.links.begin(), publishers.links.end(), now.begin(), now.end());
}

}  // namespace

// The first publisher pins a subscription of any type to its own type for good, and roscpp refuses
// publishers of another. Where none is connected, subscribing anew lets the next one be of any type
// again; where one is, the others cannot be heard, and the scene is incomplete.
//
// What a publisher says that has just come would be lost with its connection. So not at the first
// look without one: where a publisher makes way for another, that is on its way.
bool BoxTopics::checkPublishers(const TellUnheard& tell) {
  bool is_soon_again = false;
  std::set<std::string> names;
  for (const Topic& topic : topics_) {
    names.insert(topic.name);
  }
  const auto known = askForPublishers(names);
  for (std::size_t index = 0; known && index < topics_.size(); ++index) {
    Topic& topic = topics_[index];
    const Publishers& publishers = known->at(topic.name);
    const std::size_t connected = publishers.connected.size();
    const std::size_t registered = publishers.registered.size();
    const bool missing = registered > connected;
    const bool is_alone = connected == 0;
    topic.is_pinned = topic.is_pinned || !is_alone;
    if (is_alone && (topic.is_pinned || missing)) {
      if (!topic.was_alone) {
        is_soon_again = true;
      } else if (!hasCome(topic.name, publishers)) {
        topic.subscriber.shutdown();
        subscribe(index);
        topic.is_pinned = false;
      }
    }
    const bool unheard = !is_alone && missing && topic.missing;  // not just on its way
    topic.was_alone = is_alone;
    topic.missing = missing;
    tell(index, unheard ? registered - connected : 0, publishers.type);
  }
  return is_soon_again;
}

}  // namespace box_query
