// SPDX-License-Identifier: BSD-3-Clause
#include "ros/backlog.h"

#include <future>
#include <string>
#include <thread>

#include <boost/make_shared.hpp>
#include <gtest/gtest.h>

namespace box_query {
namespace {

constexpr std::size_t kOverhead = Backlog::kOverhead;

RawMessagePtr messageOf(std::size_t size) {
  const auto message = boost::make_shared<RawMessage>();
  message->size = size;
  return message;
}

/// The topics and sizes of what is in it, and what was dropped before each.
std::string contents(Backlog& backlog, std::size_t messages) {
  std::string text;
  for (std::size_t n = 0; n < messages; ++n) {
    const auto message = backlog.take();
    text += (n > 0 ? ", " : "") + std::to_string(message->topic) + ": " +
            std::to_string(message->raw->size);
    text += message->dropped > 0 ? " after " + std::to_string(message->dropped) : "";
  }
  return text;
}

TEST(Backlog, KeepsTheOrderAcrossTopics) {
  Backlog backlog(3, 1000000);
  for (const std::size_t topic : {2U, 0U, 0U, 1U, 2U}) {
    backlog.add(topic, messageOf(10 + topic));
  }
  EXPECT_EQ(contents(backlog, 5), "2: 12, 0: 10, 0: 10, 1: 11, 2: 12");
}

TEST(Backlog, DropsTheOldestOfATopicAndSaysWhere) {
  Backlog backlog(2, 100 + 3 * kOverhead);
  backlog.add(0, messageOf(50));
  backlog.add(1, messageOf(1));
  for (const std::size_t size : {49U, 1U}) {
    backlog.add(0, messageOf(size));
  }
  EXPECT_EQ(contents(backlog, 4), "0: 50, 1: 1, 0: 49, 0: 1") << "as many as are allowed";
  for (const std::size_t size : {60U, 61U, 62U, 1U, 2U}) {
    backlog.add(0, messageOf(size));
  }
  backlog.add(1, messageOf(1));
  EXPECT_EQ(contents(backlog, 4), "0: 62 after 2, 0: 1, 0: 2, 1: 1");
  backlog.add(0, messageOf(3));
  EXPECT_EQ(contents(backlog, 1), "0: 3") << "what was said once is not said again";
}

TEST(Backlog, CountsWhatWasDroppedBeforeWhatIsDropped) {
  Backlog backlog(1, 100 + 2 * kOverhead);
  for (const std::size_t size : {90U, 80U, 70U, 20U}) {
    backlog.add(0, messageOf(size));
  }
  EXPECT_EQ(contents(backlog, 2), "0: 70 after 2, 0: 20");
}

TEST(Backlog, KeepsTheLatestHoweverLargeItIs) {
  Backlog backlog(1, 100);
  backlog.add(0, messageOf(10));
  backlog.add(0, messageOf(1000000));
  EXPECT_EQ(contents(backlog, 1), "0: 1000000 after 1");
}

TEST(Backlog, CountsMoreThanTheBytesOfAMessage) {
  Backlog backlog(1, 10 * kOverhead);
  for (int n = 0; n < 100; ++n) {
    backlog.add(0, messageOf(0));
  }
  EXPECT_EQ(contents(backlog, 1), "0: 0 after 90");
}

TEST(Backlog, WakesWhoWaitsWhenOneComesAndWhenItIsClosed) {
  Backlog backlog(1, 1000);
  std::promise<void> taken;
  std::thread taker([&] {
    EXPECT_TRUE(backlog.take());
    taken.set_value();
    EXPECT_FALSE(backlog.take());
  });
  backlog.add(0, messageOf(1));
  taken.get_future().wait();
  backlog.close();
  taker.join();
}

}  // namespace
}  // namespace box_query
