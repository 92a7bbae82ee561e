// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_store.h"

#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace box_query {
namespace {

BoxChange boxAt(double x, std::int64_t id = 1, const std::string& ns = "a") {
  BoxChange change;
  change.ns = ns;
  change.id = id;
  change.frame = "map";
  change.add(id, Vector3(x, 0.0, 0.0), Quaternion::Identity(), Vector3::Ones());
  return change;
}

BoxChange badBox(std::int64_t id = 1) {
  BoxChange change = boxAt(0.0, id);
  change.boxes.clear();
  change.reject(Rejection::kNotFinite, 1, "its size", change.id);
  return change;
}

/// Hears and places at once.
void say(BoxStore& store, BoxChange change, std::size_t topic = 0,
         const ros::Time& now = ros::Time(100)) {
  store.place(store.hear(topic, std::move(change), now), "");
}

/// "ns/id:x" of every placed box, in order.
std::string contents(const BoxStore& store, std::size_t topic = 0) {
  std::string text;
  for (const auto& [ns, items] : store.items(topic)) {
    for (const auto& [id, item] : items) {
      for (const IdentifiedBox& box : item.boxes) {
        text += ns + "/" + std::to_string(box.id) + ":" +
                std::to_string(static_cast<int>(box.box.center.x())) + " ";
      }
    }
  }
  return text;
}

TEST(BoxStore, OrdersByNamespaceAndIdWhateverCameFirst) {
  BoxStore store(1);
  say(store, boxAt(1, 7, "b"));
  say(store, boxAt(2, 3, "b"));
  say(store, boxAt(3, -9, "b"));
  say(store, boxAt(4, 5, "a"));
  EXPECT_EQ(contents(store), "a/5:4 b/-9:3 b/3:2 b/7:1 ");
}

TEST(BoxStore, FindsItemsInWhateverOrderTheyAreNamed) {
  BoxStore store(2);
  std::map<std::string, std::map<std::int64_t, int>> right[2];
  std::mt19937 random(3);
  std::int64_t id = 0;
  for (int x = 0; x < 5000; ++x) {
    const std::size_t topic = random() % 8 == 0 ? 1 : 0;
    const std::string ns = random() % 8 == 0 ? "b" : "a";
    id = random() % 4 == 0 ? static_cast<std::int64_t>(random() % 50) : id + 1;  // often the next
    if (random() % 5 == 0) {
      store.remove(topic, ns, id);
      right[topic][ns].erase(id);
    } else if (random() % 500 == 0) {
      store.clear(topic);
      right[topic].clear();
    } else {
      say(store, boxAt(x, id, ns), topic);
      right[topic][ns][id] = x;
    }
  }
  for (const std::size_t topic : {0, 1}) {
    std::string text;
    for (const auto& [ns, items] : right[topic]) {
      for (const auto& [item, x] : items) {
        text += ns + "/" + std::to_string(item) + ":" + std::to_string(x) + " ";
      }
    }
    EXPECT_FALSE(text.empty());
    EXPECT_EQ(contents(store, topic), text);
  }
}

TEST(BoxStore, ReplacesRemovesAndClears) {
  BoxStore store(1);
  say(store, boxAt(1));
  say(store, boxAt(2));
  say(store, boxAt(3, 2));
  EXPECT_EQ(contents(store), "a/1:2 a/2:3 ");
  store.remove(0, "a", 1);
  store.remove(0, "a", 77);
  store.remove(0, "nobody", 2);
  EXPECT_EQ(contents(store), "a/2:3 ");
  store.clear(0);
  EXPECT_EQ(contents(store), "");
}

TEST(BoxStore, KeepsTopicsApart) {
  BoxStore store(2);
  say(store, boxAt(1), 0);
  say(store, boxAt(2), 1);
  store.hear(1, badBox(2), ros::Time(100));
  store.remove(0, "a", 1);
  EXPECT_EQ(contents(store, 0), "");
  EXPECT_EQ(contents(store, 1), "a/1:2 ");
  store.clear(0);
  EXPECT_EQ(store.rejected(0), 0U);
  EXPECT_EQ(store.rejected(1), 1U);
}

TEST(BoxStore, KeepsTheOldBoxWhileTheNewOneWaits) {
  BoxStore store(1);
  say(store, boxAt(1));
  Word word = store.hear(0, boxAt(2), ros::Time(100));
  EXPECT_EQ(store.waiting(0), 1U);
  EXPECT_EQ(contents(store), "a/1:1 ");
  ASSERT_TRUE(store.wants(word));
  store.place(std::move(word), "");
  EXPECT_EQ(store.waiting(0), 0U);
  EXPECT_EQ(contents(store), "a/1:2 ");
}

TEST(BoxStore, PlacesAnEarlierWordUntilALaterOneIs) {
  BoxStore store(1);
  Word first = store.hear(0, boxAt(1), ros::Time(100));
  Word second = store.hear(0, boxAt(2), ros::Time(100));
  const Word third = store.hear(0, boxAt(3), ros::Time(100));
  EXPECT_EQ(store.waiting(0), 1U) << "only the latest word counts";
  EXPECT_TRUE(store.wants(first));
  store.place(std::move(second), "");
  EXPECT_EQ(contents(store), "a/1:2 ");
  EXPECT_FALSE(store.wants(first)) << "overtaken";
  EXPECT_TRUE(store.wants(third));
  EXPECT_EQ(store.waiting(0), 1U);
}

TEST(BoxStore, WantsNoWordThatWasDeletedSince) {
  BoxStore store(1);
  const Word removed = store.hear(0, boxAt(1), ros::Time(100));
  store.remove(0, "a", 1);
  EXPECT_EQ(store.waiting(0), 0U);
  EXPECT_FALSE(store.wants(removed));
  const Word cleared = store.hear(0, boxAt(2), ros::Time(100));
  EXPECT_FALSE(store.wants(removed)) << "nor if the item came back";
  EXPECT_TRUE(store.wants(cleared));
  store.clear(0);
  EXPECT_FALSE(store.wants(cleared));
}

TEST(BoxStore, TellsWhenWordsThatMayWaitAreWantedNoMore) {
  BoxStore store(1);
  std::uint64_t unwanted = store.unwanted();
  const auto is_news = [&] { return std::exchange(unwanted, store.unwanted()) != unwanted; };
  const Word first = store.hear(0, boxAt(1), ros::Time(100));
  const Word second = store.hear(0, boxAt(2), ros::Time(100));
  const Word other = store.hear(0, boxAt(2, 2), ros::Time(100));
  EXPECT_TRUE(store.wants(first));
  EXPECT_FALSE(is_news()) << "a later word may wait longer than the first";
  store.place(Word(second), "");
  EXPECT_FALSE(store.wants(first));
  EXPECT_TRUE(is_news());
  store.place(Word(other), "");
  for (int x = 3; x < 9; ++x) {
    say(store, boxAt(x));
  }
  EXPECT_FALSE(is_news()) << "words that are placed at once overtake none";
  store.hear(0, boxAt(9), ros::Time(100));
  say(store, boxAt(9, 3));
  EXPECT_FALSE(is_news());
  store.remove(0, "a", 3);
  EXPECT_FALSE(is_news()) << "nothing waits of what is removed";
  store.remove(0, "a", 1);
  EXPECT_TRUE(is_news());
  store.clear(0);
  EXPECT_TRUE(is_news());
}

TEST(BoxStore, CountsOnlyTheLatestWordAsRejected) {
  BoxStore store(1);
  say(store, boxAt(1));
  store.hear(0, badBox(), ros::Time(100));
  EXPECT_EQ(store.rejected(0), 1U);
  EXPECT_EQ(contents(store), "a/1:1 ") << "the good one stays";
  say(store, boxAt(2));
  EXPECT_EQ(store.rejected(0), 0U);
  store.hear(0, badBox(1), ros::Time(100));
  store.hear(0, badBox(2), ros::Time(100));
  store.hear(0, badBox(3), ros::Time(100));
  EXPECT_EQ(store.rejected(0), 3U);
  store.remove(0, "a", 1);
  EXPECT_EQ(store.rejected(0), 2U);
  store.clear(0);
  EXPECT_EQ(store.rejected(0), 0U);
}

TEST(BoxStore, CountsAGivenUpWordUntilTheNext) {
  BoxStore store(1);
  const Word word = store.hear(0, boxAt(1), ros::Time(100));
  store.giveUp(word, "why");
  EXPECT_EQ(store.waiting(0), 0U);
  EXPECT_EQ(store.rejected(0), 1U);
  EXPECT_EQ(store.items(0).at("a").at(1).problem, "why");
  store.hear(0, boxAt(2), ros::Time(100));
  EXPECT_EQ(store.rejected(0), 0U);
  store.giveUp(word, "old");
  EXPECT_EQ(store.rejected(0), 0U) << "a later word has come";
  EXPECT_EQ(store.waiting(0), 1U);
}

TEST(BoxStore, ExpiresAtTheEndOfALifetimeAndNotBefore) {
  BoxStore store(1);
  BoxChange mortal = boxAt(1);
  mortal.lifetime = 1500000000;
  say(store, mortal);
  say(store, boxAt(2, 2));
  EXPECT_EQ(store.nextExpiry(), 101500000000);
  EXPECT_EQ(store.expire(ros::Time(101, 499999999)), 0U);
  EXPECT_EQ(contents(store), "a/1:1 a/2:2 ");
  EXPECT_EQ(store.expire(ros::Time(101, 500000000)), 1U);
  EXPECT_EQ(contents(store), "a/2:2 ");
  EXPECT_EQ(store.nextExpiry(), kForever);
}

TEST(BoxStore, LivesOnWhenHeardAgain) {
  BoxStore store(1);
  BoxChange mortal = boxAt(1);
  mortal.lifetime = 1000000000;
  say(store, mortal, 0, ros::Time(100));
  say(store, mortal, 0, ros::Time(100, 900000000));
  EXPECT_EQ(store.expire(ros::Time(101, 100000000)), 0U);
  EXPECT_EQ(contents(store), "a/1:1 ");
  EXPECT_EQ(store.expire(ros::Time(101, 900000000)), 1U);
}

TEST(BoxStore, ForgetsRejectedAndWaitingBoxesAtTheEndOfTheirLifetime) {
  BoxStore store(1);
  BoxChange bad = badBox(1);
  bad.lifetime = 1000000000;
  store.hear(0, std::move(bad), ros::Time(100));
  BoxChange late = boxAt(2, 2);
  late.lifetime = 1000000000;
  const Word word = store.hear(0, std::move(late), ros::Time(100));
  EXPECT_EQ(store.expire(ros::Time(101)), 1U);
  EXPECT_EQ(store.rejected(0) + store.waiting(0), 0U);
  EXPECT_FALSE(store.wants(word));
}

TEST(BoxStore, ExpiresAnEarlierWordBeforeTheLatest) {
  BoxStore store(1);
  BoxChange mortal = boxAt(1);
  mortal.lifetime = 1000000000;
  say(store, mortal);
  const Word word = store.hear(0, boxAt(2), ros::Time(100));
  EXPECT_EQ(store.expire(ros::Time(101)), 1U);
  EXPECT_EQ(contents(store), "");
  EXPECT_TRUE(store.wants(word));
}

TEST(BoxStore, TellsNewBoxesFromTheSameAgain) {
  BoxStore store(1);
  say(store, boxAt(1));
  const std::uint64_t revision = store.boxesRevision();
  say(store, boxAt(1));
  EXPECT_EQ(store.boxesRevision(), revision);
  say(store, boxAt(2));
  EXPECT_GT(store.boxesRevision(), revision);
  const std::uint64_t moved = store.boxesRevision();
  BoxChange labelled = boxAt(2);
  labelled.label = "new";
  say(store, labelled);
  EXPECT_GT(store.boxesRevision(), moved);
  const std::uint64_t labelled_revision = store.boxesRevision();
  store.hear(0, badBox(5), ros::Time(100));
  store.remove(0, "a", 5);
  EXPECT_EQ(store.boxesRevision(), labelled_revision) << "there was no box";
  store.remove(0, "a", 1);
  EXPECT_GT(store.boxesRevision(), labelled_revision);
}

}  // namespace
}  // namespace box_query
