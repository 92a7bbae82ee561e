// SPDX-License-Identifier: BSD-3-Clause
#include "ros/latest.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace box_query {
namespace {

using Number = std::shared_ptr<const int>;

TEST(Latest, KeepsNothingOfTheValueBefore) {
  const auto first = std::make_shared<const int>(1);
  Latest<Number> latest(first);
  EXPECT_EQ(*latest.read([](const Number& number) { return number; }), 1);
  latest.write(std::make_shared<const int>(2));
  EXPECT_EQ(first.use_count(), 1);
  EXPECT_EQ(*latest.read([](const Number& number) { return number; }), 2);
}

TEST(Latest, IsNeverOlderThanWhatWasRead) {
  Latest<Number> latest(std::make_shared<const int>(0));
  std::atomic<int> went_back{0};
  std::atomic<int> readers_left{3};
  std::vector<std::thread> readers;
  for (int reader = 0; reader < 3; ++reader) {
    readers.emplace_back([&] {
      int last = 0;
      for (int changes = 0; changes < 100;) {
        const Number number = latest.read([](const Number& value) { return value; });
        went_back += *number < last;
        changes += *number > last;
        last = *number;
      }
      --readers_left;
    });
  }
  for (int n = 1; readers_left > 0; ++n) {
    latest.write(std::make_shared<const int>(n));
  }
  for (std::thread& reader : readers) {
    reader.join();
  }
  EXPECT_EQ(went_back, 0);
}

TEST(Latest, IsNotReplacedUnderAReader) {
  Latest<Number> latest(std::make_shared<const int>(1));
  std::atomic<bool> looks{false};
  std::atomic<bool> may_leave{false};
  std::atomic<bool> written{false};
  std::thread reader([&] {
    latest.read([&](const Number& number) {
      looks = true;
      while (!may_leave) {
        std::this_thread::yield();
      }
      EXPECT_EQ(*number, 1);
      EXPECT_FALSE(written) << "a writer returned while somebody looked at the value before";
    });
  });
  while (!looks) {
    std::this_thread::yield();
  }
  std::thread writer([&] {
    latest.write(std::make_shared<const int>(2));
    written = true;
  });
  while (*latest.read([](const Number& number) { return number; }) != 2) {
    std::this_thread::yield();
  }
  may_leave = true;
  reader.join();
  writer.join();
  EXPECT_TRUE(written);
}

}  // namespace
}  // namespace box_query
