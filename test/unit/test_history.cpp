// SPDX-License-Identifier: BSD-3-Clause
#include "ros/history.h"
#include "ros/kept_scenes.h"
#include "unit/answer_fixture.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <iostream>
#include <map>
#include <new>
#include <thread>
#include <tuple>

#include <gtest/gtest.h>
#include <malloc.h>

namespace {

// Bytes that are allocated by operator new, with what malloc adds to them.
std::atomic<std::size_t> allocated{0};

}  // namespace

// Not inlined: g++ 12 would take the pair for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  void* const block = std::malloc(size);
  if (block == nullptr) {
    throw std::bad_alloc();
  }
  allocated += malloc_usable_size(block) + sizeof(std::size_t);
  return block;
}
[[gnu::noinline]] void operator delete(void* block) noexcept {
  allocated -= block == nullptr ? 0 : malloc_usable_size(block) + sizeof(std::size_t);
  std::free(block);
}
[[gnu::noinline]] void operator delete(void* block, std::size_t) noexcept {
  operator delete(block);
}

namespace box_query::test {
namespace {

using Key = std::tuple<std::string, std::string, std::int64_t>;
struct Entry {
  std::string label;
  ros::Time stamp;
  OrientedBox box;
};
/// What is there, in the order of snapshots.
using World = std::map<Key, Entry>;

Draft draftOf(const World& world, std::uint64_t id) {
  Draft draft;
  draft.snapshot.id = id;
  draft.snapshot.frame = "map";
  draft.snapshot.stamp = ros::Time(double(id));
  draft.snapshot.topics.resize(1);
  draft.snapshot.topics[0].parameters.topic = "/boxes";
  draft.snapshot.topics[0].last_message = ros::Time(double(id));
  for (const auto& [key, entry] : world) {
    draft.snapshot.names.push_back(
        {std::get<0>(key), std::get<1>(key), std::get<2>(key), entry.label});
    draft.snapshot.stamps.push_back(entry.stamp);
    draft.boxes.emplace_back(entry.box);
  }
  return draft;
}

void expectSame(const Snapshot& restored, const Draft& draft) {
  const Snapshot& expected = draft.snapshot;
  EXPECT_EQ(restored.id, expected.id);
  EXPECT_EQ(restored.stamp, expected.stamp);
  EXPECT_EQ(restored.frame, expected.frame);
  EXPECT_EQ(restored.stamps, expected.stamps);
  ASSERT_EQ(restored.topics.size(), expected.topics.size());
  EXPECT_EQ(restored.topics[0].last_message, expected.topics[0].last_message);
  ASSERT_EQ(restored.names.size(), expected.names.size());
  ASSERT_EQ(restored.scene.size(), draft.boxes.size());
  for (std::size_t i = 0; i < expected.names.size(); ++i) {
    const BoxName& name = restored.names[i];
    const BoxName& named = expected.names[i];
    EXPECT_EQ(std::tie(name.topic, name.ns, name.id, name.label),
              std::tie(named.topic, named.ns, named.id, named.label));
    const auto& box = std::get<OrientedBox>(restored.scene.boxes()[i]);
    const auto& made = std::get<OrientedBox>(draft.boxes[i]);
    EXPECT_EQ(bytesOf(toPoint(box.center)), bytesOf(toPoint(made.center)));
    EXPECT_EQ(box.orientation.coeffs(), made.orientation.coeffs());
    EXPECT_EQ(box.half_extents, made.half_extents);
  }
}

Parameters keeping(double seconds, int scenes) {
  Parameters parameters;
  parameters.history = seconds;
  parameters.max_past_scenes = scenes;
  return parameters;
}

std::uint64_t idAt(History& history, const ros::Time& time) {
  const auto scene = history.at(time);
  return scene ? scene->id() : 0;
}

TEST(History, IsOffByDefault) {
  EXPECT_FALSE(History(Parameters()).keeps());
  EXPECT_TRUE(History(keeping(0.001, 1)).keeps());
}

TEST(History, HasEachSceneUntilTheNext) {
  History history(keeping(10, 100));
  EXPECT_EQ(history.at(ros::Time(5)), nullptr);
  history.add(ros::Time(3), draftOf({}, 1));
  history.add(ros::Time(5), draftOf({}, 4));
  history.add(ros::Time(5), draftOf({}, 5));
  history.add(ros::Time(4), draftOf({}, 6));
  EXPECT_EQ(idAt(history, ros::Time(2, 999999999)), 0U);
  EXPECT_EQ(idAt(history, ros::Time(3)), 1U);
  EXPECT_EQ(idAt(history, ros::Time(4, 999999999)), 1U);
  EXPECT_EQ(idAt(history, ros::Time(5)), 6U) << "the last of one moment; time does not go back";
  EXPECT_EQ(idAt(history, ros::Time(4000000000U, 0)), 6U);
  history.clear();
  EXPECT_EQ(idAt(history, ros::Time(5)), 0U);
}

TEST(History, KeepsWhatWasSoInItsLastSeconds) {
  History history(keeping(10, 100));
  for (const unsigned second : {1U, 2U, 8U, 11U}) {
    history.add(ros::Time(second, 0), draftOf({}, second));
  }
  EXPECT_EQ(history.begin(), ros::Time(1)) << "was so ten seconds ago";
  history.add(ros::Time(11, 999999999), draftOf({}, 12));
  EXPECT_EQ(history.begin(), ros::Time(1));
  history.add(ros::Time(12), draftOf({}, 13));
  EXPECT_EQ(history.begin(), ros::Time(2));
  history.add(ros::Time(1000), draftOf({}, 14));
  EXPECT_EQ(history.begin(), ros::Time(12));
}

TEST(History, KeepsNoMoreScenesThanAllowed) {
  History history(keeping(10, 3));
  for (unsigned i = 1; i <= 7; ++i) {
    history.add(ros::Time(i, 0), draftOf({}, i));
  }
  EXPECT_EQ(history.begin(), ros::Time(5));
  EXPECT_EQ(idAt(history, ros::Time(4)), 0U);
}

TEST(History, RestoresEveryScene) {
  std::mt19937 random(4);
  const auto upTo = [&random](int most) {
    return std::uniform_int_distribution<int>(0, most)(random);
  };
  const auto key = [&] {
    return Key("/" + std::to_string(upTo(1)), std::to_string(upTo(2)), upTo(12));
  };
  History history(keeping(1000, 1000));
  std::vector<Draft> drafts;
  World world;
  for (unsigned step = 1; step <= 300; ++step) {
    for (int changes = upTo(4); changes > 0; --changes) {
      Entry& entry = world[key()];
      entry.box = cubeAt(upTo(2), upTo(1) == 0 ? -0.0 : 0.0, 0, 1);
      entry.stamp = ros::Time(upTo(1) == 0 ? 1 : step);
      entry.label = upTo(5) == 0 ? "" : "known";
    }
    for (int changes = upTo(3); changes > 0; --changes) {
      world.erase(key());
    }
    if (upTo(40) == 0) {
      world.clear();
    }
    drafts.push_back(draftOf(world, step));
    history.add(ros::Time(step), drafts.back());
  }
  for (const Draft& draft : drafts) {
    const auto past = history.at(draft.snapshot.stamp);
    ASSERT_NE(past, nullptr);
    expectSame(*past->restored(), draft);
  }
}

TEST(History, RestoresBoxesOfOneName) {
  Draft draft = draftOf({{Key("/a", "", 1), {"", {}, cubeAt(1, 0, 0, 1)}},
                         {Key("/a", "", 2), {"", {}, cubeAt(2, 0, 0, 1)}}},
                        1);
  draft.snapshot.names[1].id = 1;
  History history(keeping(10, 10));
  history.add(ros::Time(1), draft);
  std::swap(draft.boxes[0], draft.boxes[1]);
  draft.snapshot.id = 2;
  history.add(ros::Time(2), draft);
  expectSame(*history.at(ros::Time(2))->restored(), draft);
}

TEST(History, IsAskedWhileMoreIsNoted) {
  History history(keeping(1000, 5));
  constexpr unsigned kScenes = 300;
  std::atomic<unsigned> noted{0};
  std::thread noting([&] {
    for (unsigned i = 1; i <= kScenes; ++i) {
      history.add(ros::Time(i, 0), draftOf({}, i));
      noted = i;
    }
  });
  std::size_t found = 0;
  while (noted < kScenes || found == 0) {
    const unsigned now = noted;
    if (now == 0) {
      continue;
    }
    std::shared_ptr<const PastScene> scene;
    if (history.find(ros::Time(now, 0), ros::Time(kScenes, 0), scene).empty()) {
      EXPECT_EQ(scene->id(), now) << "what was noted is known";
      ++found;
    } else {
      EXPECT_GT(history.begin(), ros::Time(now, 0)) << "five more may have come meanwhile";
    }
  }
  noting.join();
  EXPECT_EQ(idAt(history, ros::Time(kScenes, 0)), kScenes);
}

TEST(KeptScenes, RestoresEachPastSceneOnce) {
  Parameters parameters;
  parameters.kept_scenes = 3;  // with the latest
  KeptScenes kept(parameters);
  const PastScene past(ros::Time(1), draftOf({}, 1), nullptr);
  const SnapshotPtr scene = kept.restore(past, 0);
  EXPECT_EQ(kept.restore(past, 0), scene);
  EXPECT_EQ(kept.find(1), scene);
  kept.add(past.restored(), 0);  // built for somebody else
  kept.add(PastScene(ros::Time(2), draftOf({}, 2), nullptr).restored(), 0);
  EXPECT_EQ(kept.find(1), scene) << "nothing had to go";
}

/// 1,000 boxes of one namespace.
World thousand() {
  World world;
  for (int i = 0; i < 1000; ++i) {
    world[Key("/boxes", "rack", i)] = {"", ros::Time(1), cubeAt(i, 0, 0, 0.5)};
  }
  return world;
}

/// Bytes that a scene adds to a hundred of 1,000 boxes of which `moved` move from one to the next;
/// all are published again with a new stamp, or only those.
std::size_t bytesOfScene(int moved, bool all_again) {
  constexpr int kScenes = 100;
  History history(keeping(1000, 1000));
  World world = thousand();
  history.add(ros::Time(1), draftOf(world, 1));
  history.remember();
  const std::size_t before = allocated;
  for (int step = 1; step <= kScenes; ++step) {
    for (int i = 0; i < 1000; ++i) {
      Entry& entry = world[Key("/boxes", "rack", i)];
      const bool moves = (i + step) % (1000 / moved) == 0;
      entry.box.center.y() += moves ? 1.0 : 0.0;
      entry.stamp = moves || all_again ? ros::Time(1 + step) : entry.stamp;
    }
    history.add(ros::Time(1 + step), draftOf(world, 1 + std::uint64_t(step)));
    history.remember();
  }
  return (allocated - before) / kScenes;
}

TEST(HistoryMemory, IsBounded) {
  for (const int moved : {10, 1000}) {
    Parameters parameters = keeping(1000, 1000);
    parameters.max_history_memory = 1;
    const std::size_t start = allocated;
    History history(parameters);
    World world = thousand();
    for (auto& [key, entry] : world) {
      entry.label = std::string(100, 'x');
    }
    std::size_t largest = 0;
    const std::size_t before = allocated - start;
    for (int step = 1; step <= 100; ++step) {
      for (int i = 0; i < moved; ++i) {
        world[Key("/boxes", "rack", (i + 7 * step) % 1000)].box.center.y() += 1.0;
      }
      history.add(ros::Time(step), draftOf(world, std::uint64_t(step)));
      history.remember();
      largest = std::max(largest, allocated - start - before);
    }
    EXPECT_LT(largest, 1100000U);
    EXPECT_GT(largest, 700000U) << "what is allowed is used";
    EXPECT_NE(history.at(ros::Time(100)), nullptr);
    EXPECT_EQ(history.at(ros::Time(1)), nullptr);
    const double seconds = 100.0 - history.begin().toSec();
    EXPECT_GE(seconds, moved == 10 ? 20.0 : 1.0) << "of boxes that stay there is one";
    history.clear();
    for (int step = 101; step <= 103; ++step) {
      history.add(ros::Time(step), draftOf(world, std::uint64_t(step)));
      history.remember();
    }
    EXPECT_EQ(history.begin(), ros::Time(101)) << "none of what was cleared counts";
  }
}

TEST(HistoryMemory, SharesWhatDidNotChange) {
  const std::size_t start = allocated;
  const SnapshotPtr whole = PastScene(ros::Time(1), draftOf(thousand(), 1), nullptr).restored();
  const std::size_t snapshot = allocated - start;
  const std::size_t ten = bytesOfScene(10, false);
  const std::size_t ten_again = bytesOfScene(10, true);
  const std::size_t every = bytesOfScene(1000, true);
  std::cout << "[ memory   ] of a snapshot of 1,000 boxes " << snapshot
            << " bytes; remembered, where 10 of them moved, " << ten
            << ", where all were published "
            << "again, " << ten_again << ", where all of them moved, " << every << "\n";
  EXPECT_LT(ten, 30000U);
  EXPECT_LT(ten_again, 20000U);
  EXPECT_LT(every, 200000U);
}

}  // namespace
}  // namespace box_query::test
