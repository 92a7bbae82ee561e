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
  return boost::make_shared<const Succession::Strings>(Succession::Strings{{"callerid", name}});
}

TEST(Succession, ForgetsWhatAFormerPublisherSaid) {
  Succession succession("self");
  EXPECT_FALSE(succession.asks(kStart));
  const Connection old = connectionTo();
  succession.hear(old, 0, kStart);
  EXPECT_TRUE(succession.asks(kStart));
  EXPECT_EQ(succession.look({{"a", "1"}}), std::uint64_t{0}) << "there was nothing";
  EXPECT_FALSE(succession.asks(kStart));
  succession.hear(old, 5, kStart);
  EXPECT_FALSE(succession.asks(kStart)) << "nobody new";
  succession.hear(connectionTo(), 7, kStart);
  EXPECT_EQ(succession.look({{"a", "2"}}), std::uint64_t{7});
  EXPECT_FALSE(succession.asks(kStart));
}

TEST(Succession, ForgetsNothingWhileAFormerPublisherIsThere) {
  Succession succession("self");
  succession.hear(connectionTo(), 0, kStart);
  succession.look({{"a", "1"}, {"b", "1"}});
  succession.hear(connectionTo(), 3, kStart);
  EXPECT_EQ(succession.look({{"b", "1"}, {"c", "1"}}), std::nullopt);
  EXPECT_TRUE(succession.asks(kStart + milliseconds(999)));
  EXPECT_FALSE(succession.asks(kStart + milliseconds(1000))) << "it does not go";
}

TEST(Succession, ForgetsNothingForAConnectionThatIsMadeAnew) {
  Succession succession("self");
  succession.hear(connectionTo(), 0, kStart);
  succession.look({{"a", "1"}});
  succession.hear(connectionTo(), 3, kStart);
  EXPECT_EQ(succession.look({{"a", "1"}}), std::nullopt);
}

TEST(Succession, WaitsForTheFormerPublisherToGo) {
  Succession succession("self");
  succession.hear(connectionTo(), 0, kStart);
  succession.look({{"a", "1"}});
  succession.hear(connectionTo(), 3, kStart);
  EXPECT_EQ(succession.look({{"a", "1"}, {"b", "1"}}), std::nullopt);
  EXPECT_EQ(succession.look({{"b", "1"}}), std::uint64_t{3});
}

TEST(Succession, TellsPublishersOfThisProcessApart) {
  Succession succession("self");
  succession.hear(connectionTo("self"), 0, kStart);
  succession.look({{"self", "1"}});
  succession.hear(connectionTo("a"), 3, kStart);
  EXPECT_EQ(succession.look({{"self", "1"}, {"a", "1"}}), std::nullopt);
  succession.hear(connectionTo("self"), 5, kStart);
  EXPECT_EQ(succession.look({{"self", "1"}}), std::uint64_t{5});
}

TEST(Succession, KeepsWhatTheFirstOfTwoNewPublishersSaid) {
  Succession succession("self");
  succession.hear(connectionTo(), 0, kStart);
  succession.look({{"a", "1"}});
  succession.hear(connectionTo(), 3, kStart);
  succession.hear(connectionTo(), 4, kStart);
  EXPECT_EQ(succession.look({{"a", "2"}, {"other", "1"}}), std::uint64_t{3});
}

}  // namespace
}  // namespace box_query
