// SPDX-License-Identifier: BSD-3-Clause
#include "ros/succession.h"

#include <boost/make_shared.hpp>
#include <gtest/gtest.h>

namespace box_query {
namespace {

using Connection = Succession::Connection;
using std::chrono::milliseconds;

const Succession::Clock::time_point kStart = Succession::Clock::now();

Connection connectionTo(const std::string& name = "a") {
  return boost::make_shared<const Succession::Header>(Succession::Header{{"callerid", name}});
}

TEST(Succession, ForgetsWhatAFormerPublisherSaid) {
  Succession succession("self", "here");
  EXPECT_FALSE(succession.asks(kStart));
  const Connection old = connectionTo();
  EXPECT_TRUE(succession.isNew(old));
  succession.hear(old, {"a1"}, 0, kStart);
  EXPECT_FALSE(succession.isNew(old));
  EXPECT_TRUE(succession.asks(kStart));
  EXPECT_EQ(succession.look({"a1"}), std::uint64_t{0}) << "there was nothing";
  EXPECT_FALSE(succession.asks(kStart));
  succession.hear(connectionTo(), {"a2"}, 7, kStart);
  EXPECT_EQ(succession.look({"a2"}), std::uint64_t{7});
  EXPECT_FALSE(succession.asks(kStart));
}

TEST(Succession, ForgetsNothingWhileAFormerPublisherIsThere) {
  Succession succession("self", "here");
  succession.hear(connectionTo(), {"a1", "b1"}, 0, kStart);
  succession.look({"a1", "b1"});
  succession.hear(connectionTo(), {"b1", "c1"}, 3, kStart);
  EXPECT_EQ(succession.look({"b1", "c1"}), std::nullopt);
  EXPECT_TRUE(succession.asks(kStart + milliseconds(999)));
  EXPECT_FALSE(succession.asks(kStart + milliseconds(1000))) << "it does not go";
}

TEST(Succession, ForgetsNothingForAConnectionThatIsMadeAnew) {
  Succession succession("self", "here");
  succession.hear(connectionTo(), {"a1"}, 0, kStart);
  succession.look({"a1"});
  succession.hear(connectionTo(), {"a1"}, 3, kStart);
  EXPECT_EQ(succession.look({"a1"}), std::nullopt);
}

TEST(Succession, WaitsForTheFormerPublisherToGo) {
  Succession succession("self", "here");
  succession.hear(connectionTo(), {"a1"}, 0, kStart);
  succession.look({"a1"});
  succession.hear(connectionTo(), {"a1", "b1"}, 3, kStart);
  EXPECT_EQ(succession.look({"a1", "b1"}), std::nullopt);
  EXPECT_EQ(succession.look({"b1"}), std::uint64_t{3});
}

TEST(Succession, KnowsAPublisherThatIsGoneBeforeTheLook) {
  Succession succession("self", "here");
  succession.hear(connectionTo(), {"a1"}, 0, kStart);
  succession.look({"a2"});  // killed and started again, and silent so far
  succession.hear(connectionTo(), {"a2"}, 3, kStart);
  EXPECT_EQ(succession.look({"a2"}), std::uint64_t{3});
}

TEST(Succession, AsksUntilSomebodyLooks) {
  Succession succession("self", "here");
  succession.hear(connectionTo(), {"a1"}, 0, kStart);
  EXPECT_TRUE(succession.asks(kStart + std::chrono::hours(1)));
  succession.look({"a1"});
  EXPECT_FALSE(succession.asks(kStart + std::chrono::hours(1)));
}

TEST(Succession, TellsPublishersOfThisProcessApart) {
  Succession succession("self", "here");
  succession.hear(connectionTo("self"), {"here"}, 0, kStart);
  succession.look({"here"});
  succession.hear(connectionTo("a"), {"here", "a1"}, 3, kStart);
  EXPECT_EQ(succession.look({"here", "a1"}), std::nullopt);
  succession.hear(connectionTo("self"), {"here"}, 5, kStart);
  EXPECT_EQ(succession.look({"here"}), std::uint64_t{5});
}

TEST(Succession, KeepsWhatTheFirstOfTwoNewPublishersSaid) {
  Succession succession("self", "here");
  succession.hear(connectionTo(), {"a1"}, 0, kStart);
  succession.look({"a1"});
  succession.hear(connectionTo(), {"a2"}, 3, kStart);
  succession.hear(connectionTo(), {"a2", "other1"}, 4, kStart);
  EXPECT_EQ(succession.look({"a2", "other1"}), std::uint64_t{3});
}

}  // namespace
}  // namespace box_query
