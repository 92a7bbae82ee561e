// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_topics.h"

#include "ros/publishers.h"

#include <set>
#include <string>
#include <utility>

#include <boost/function.hpp>
#include <boost/make_shared.hpp>
#include <ros/subscribe_options.h>

namespace box_query {

BoxTopics::BoxTopics(const ros::NodeHandle& nh, const Parameters& parameters, Receive receive)
    : nh_(nh),
      limits_(parameters),
      receive_(std::move(receive)),
      topics_(parameters.box_topics.size()),
      spinner_(1, &queue_) {
  for (std::size_t topic = 0; topic < topics_.size(); ++topic) {
    topics_[topic].name = parameters.box_topics[topic].topic;
    subscribe(topic);
  }
}

void BoxTopics::start() {
  spinner_.start();
}

void BoxTopics::stop() {
  for (Topic& topic : topics_) {
    topic.subscriber.shutdown();  // waits for a callback that runs
  }
  spinner_.stop();
}

void BoxTopics::subscribe(std::size_t topic) {
  // Each message changes what the ones before said, so none may be dropped: the queue is unbounded.
  // Decoding is faster than the network.
  constexpr std::uint32_t kUnbounded = 0;
  const boost::function<void(const boost::shared_ptr<AnyBoxMessage>&)> callback =
      [this, topic](const boost::shared_ptr<AnyBoxMessage>& message) { receive_(topic, *message); };
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const boost::shared_ptr<AnyBoxMessage>&>(
      topics_[topic].name, kUnbounded, callback,
      [limits = limits_] { return boost::make_shared<AnyBoxMessage>(limits); });
  options.callback_queue = &queue_;
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  topics_[topic].subscriber = nh_.subscribe(options);
}

// The first publisher pins a subscription of any type to its own type for good, and roscpp refuses
// publishers of another. Where none is connected, subscribing anew lets the next one be of any type
// again; where one is, the others cannot be heard, and the scene is incomplete.
void BoxTopics::checkPublishers(const TellUnheard& tell) {
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
    if (connected == 0 && (topic.connected || missing)) {
      topic.subscriber.shutdown();
      subscribe(index);
    }
    const bool unheard = connected > 0 && missing && topic.missing;  // not just on its way
    topic.connected = connected > 0;
    topic.missing = missing;
    tell(index, unheard ? registered - connected : 0, publishers.type);
  }
}

}  // namespace box_query
