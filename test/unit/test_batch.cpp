// SPDX-License-Identifier: BSD-3-Clause
#include "reference/sampler.h"

#include <box_query/batch.h>

#include <atomic>
#include <cfenv>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace box_query {
namespace {

constexpr std::size_t kQueries = 3000;
constexpr double kRange = 30.0;

/// More threads than this machine may have, so that parts really are worked on at once.
constexpr int kThreads[] = {0, 1, 2, 7};

struct Questions {
  Scene scene;
  std::vector<Ray> rays;
  std::vector<Segment> segments;
  BoxMask mask{0};
};

Questions questions() {
  reference::Sampler sampler(11);
  std::vector<Box> boxes;
  while (boxes.size() < 500) {
    boxes.emplace_back(
        OrientedBox{sampler.vector(-20.0, 20.0), sampler.rotation(), sampler.vector(0.1, 1.5)});
  }
  Questions q;
  q.mask = BoxMask(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); i += 3) {
    q.mask.set(i, false);
  }
  q.scene = Scene(std::move(boxes));
  while (q.rays.size() < kQueries) {
    q.rays.push_back({sampler.vector(-20.0, 20.0), sampler.direction()});
    q.segments.push_back({sampler.vector(-20.0, 20.0), sampler.vector(-20.0, 20.0)});
  }
  return q;
}

/// Numbers of a miss are NaN.
bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}
bool same(const Vector3& a, const Vector3& b) {
  return same(a[0], b[0]) && same(a[1], b[1]) && same(a[2], b[2]);
}

class BatchTest : public testing::TestWithParam<int> {
 protected:
  BatchOptions options() const { return {kRange, &q_.mask, GetParam()}; }

  const Questions q_ = questions();
};

TEST_P(BatchTest, CastsAreThoseOfSingleRays) {
  const auto hits = castEach(q_.scene, q_.rays, options());
  const auto closest = castClosestEach(q_.scene, q_.rays, options());
  const auto any = castAnyEach(q_.scene, q_.rays, options());
  ASSERT_EQ(hits.size(), kQueries);
  ASSERT_EQ(closest.size(), kQueries);
  ASSERT_EQ(any.size(), kQueries);
  std::size_t num_hits = 0;
  for (std::size_t i = 0; i < kQueries; ++i) {
    const Hit hit = q_.scene.cast(q_.rays[i], kRange, &q_.mask);
    EXPECT_EQ(hits[i].box, hit.box);
    EXPECT_TRUE(same(hits[i].range, hit.range) && same(hits[i].exit_range, hit.exit_range));
    EXPECT_TRUE(same(hits[i].point, hit.point) && same(hits[i].normal, hit.normal));
    const ClosestBox box = q_.scene.castClosest(q_.rays[i], kRange, &q_.mask);
    EXPECT_EQ(closest[i].box, hit.box);
    EXPECT_EQ(closest[i].t_lower, box.t_lower);
    EXPECT_EQ(closest[i].t_upper, box.t_upper);
    EXPECT_EQ(any[i] != 0, hit.hit);
    num_hits += hit.hit ? 1 : 0;
  }
  EXPECT_GT(num_hits, kQueries / 5);
  EXPECT_LT(num_hits, kQueries);
}

TEST_P(BatchTest, SegmentsAreThoseOfSingleCalls) {
  constexpr double kRadius = 0.5;
  const auto clear = isClearEach(q_.scene, q_.segments, kRadius, options());
  const auto missing = isClearEach(q_.scene, q_.segments, 0.0, options());
  const auto nearest = clearanceEach(q_.scene, q_.segments, options());
  const auto blocked = firstBlockageEach(q_.scene, q_.segments, kRadius, options());
  ASSERT_EQ(clear.size(), kQueries);
  ASSERT_EQ(missing.size(), kQueries);
  ASSERT_EQ(nearest.size(), kQueries);
  ASSERT_EQ(blocked.size(), kQueries);
  std::size_t num_clear = 0;
  for (std::size_t i = 0; i < kQueries; ++i) {
    const Clearance one = q_.scene.clearance(q_.segments[i], &q_.mask);
    const Blockage blockage = q_.scene.firstBlockage(q_.segments[i], kRadius, &q_.mask);
    EXPECT_EQ(nearest[i].box, one.box);
    EXPECT_EQ(nearest[i].distance, one.distance);
    EXPECT_TRUE(same(nearest[i].on_box, one.on_box));
    EXPECT_EQ(blocked[i].box, blockage.box);
    EXPECT_EQ(blocked[i].blocked_at, blockage.blocked_at);
    EXPECT_EQ(clear[i] != 0, !blockage.blocked);
    EXPECT_EQ(missing[i] != 0, one.distance > 0.0);
    num_clear += clear[i];
  }
  EXPECT_GT(num_clear, kQueries / 20);
  EXPECT_LT(num_clear, kQueries - kQueries / 20);
}

TEST_P(BatchTest, EveryIndexIsInOnePart) {
  for (const std::size_t count : {0U, 1U, 127U, 128U, 129U, 1000U, 12345U}) {
    std::vector<std::atomic<int>> seen(count);
    forEachPart(count, GetParam(), [&](std::size_t begin, std::size_t end) {
      EXPECT_LT(begin, end);
      for (std::size_t i = begin; i < end; ++i) {
        ++seen[i];
      }
    });
    for (const auto& times : seen) {
      EXPECT_EQ(1, times);
    }
  }
}

TEST_P(BatchTest, TheExceptionOfTheLowestIndexIsThrown) {
  const auto failing = [](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i >= 700) {
        throw std::runtime_error(std::to_string(i));
      }
    }
  };
  for (int repeat = 0; repeat < 20; ++repeat) {
    try {
      forEachPart(kQueries, GetParam(), failing);
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ("700", error.what());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, BatchTest, testing::ValuesIn(kThreads));

std::set<std::thread::id> threadsOf(std::size_t count, int max_threads) {
  std::set<std::thread::id> ids;
  std::mutex mutex;
  forEachPart(count, max_threads, [&](std::size_t /*begin*/, std::size_t /*end*/) {
    const std::lock_guard<std::mutex> lock(mutex);
    ids.insert(std::this_thread::get_id());
  });
  return ids;
}

TEST(Batch, StaysOnTheCallersThreadWhereItIsSmallOrMay) {
  const std::set<std::thread::id> own = {std::this_thread::get_id()};
  EXPECT_EQ(own, threadsOf(100, 0));
  EXPECT_EQ(own, threadsOf(100000, 1));
}

TEST(Batch, UsesNoMoreThreadsThanItMay) {
  EXPECT_LE(threadsOf(100000, 2).size(), 2U);
}

TEST(Batch, IsAskedFromWithinOthersAndFromManyThreads) {
  std::atomic<std::size_t> asked{0};
  const auto count_inner = [&asked](std::size_t begin, std::size_t end) {
    for (const int threads : {2, 3, 1}) {
      forEachPart(1000, threads, [&](std::size_t from, std::size_t to) { asked += to - from; });
    }
    EXPECT_LT(begin, end);
  };
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 4; ++caller) {
    callers.emplace_back([&] {
      for (const int threads : {2, 3, 2}) {
        std::atomic<std::size_t> done{0};
        forEachPart(1000, threads, [&](std::size_t begin, std::size_t end) {
          count_inner(begin, end);
          done += end - begin;
        });
        EXPECT_EQ(done, 1000U);
      }
    });
  }
  for (std::thread& caller : callers) {
    caller.join();
  }
  EXPECT_EQ(asked % 3000, 0U);
  EXPECT_GE(asked, 4U * 3U * 3000U);
}

TEST(Batch, BeginsNoOtherPartWhereAPartWaits) {
  using Limit = tbb::global_control;
  const Limit threads(Limit::max_allowed_parallelism, 8);  // however few cores there are
  std::atomic<int> begun_within{0};
  for (int repetition = 0; repetition < 20; ++repetition) {
    forEachPart(20000, 4, [&](std::size_t /*begin*/, std::size_t /*end*/) {
      thread_local bool is_within = false;
      begun_within += is_within ? 1 : 0;
      is_within = true;
      forEachPart(1000, 4, [](std::size_t /*from*/, std::size_t /*to*/) {
        std::this_thread::sleep_for(std::chrono::microseconds(10));
      });
      is_within = false;
    });
  }
  EXPECT_EQ(begun_within, 0);
}

/// How the threads of a batch round 1/3.
std::set<double> thirds() {
  std::mutex mutex;
  std::set<double> found;
  forEachPart(5000, 2, [&](std::size_t /*begin*/, std::size_t /*end*/) {
    const volatile double one = 1.0;
    const double third = one / 3.0;
    const std::lock_guard<std::mutex> lock(mutex);
    found.insert(third);
  });
  return found;
}

TEST(Batch, RoundsAsItsThreadDoesAtTheTime) {
  const auto third_rounded = [](int mode) {
    volatile double three = 3.0;
    std::fesetround(mode);
    volatile double third = 1.0 / three;  // here, and not after the next call
    std::fesetround(FE_TONEAREST);
    return third;
  };
  if (third_rounded(FE_UPWARD) == third_rounded(FE_TONEAREST)) {
    GTEST_SKIP() << "this CPU has no way of rounding but to nearest: Valgrind's";
  }
  std::thread([] {
    const std::set<double> nearest = {1.0 / 3.0};
    std::fesetround(FE_UPWARD);
    EXPECT_NE(thirds(), nearest);
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(thirds(), nearest);
  }).join();
}

TEST(Batch, OfNothingIsNothing) {
  EXPECT_TRUE(castEach(Scene(), {}).empty());
  const auto misses = castEach(Scene(), std::vector<Ray>(1000, Ray{{0, 0, 0}, {1, 0, 0}}));
  ASSERT_EQ(misses.size(), 1000U);
  EXPECT_FALSE(misses.back().hit);
}

/// Scenes that are searched in each of the ways there are, some of it by none of them.
std::vector<std::vector<Box>> scenesOfEachKind() {
  reference::Sampler sampler(12);
  const auto scattered = [&](std::size_t count, double side) {
    std::vector<Box> boxes;
    while (boxes.size() < count) {
      boxes.emplace_back(
          OrientedBox{sampler.vector(-side, side), sampler.rotation(), sampler.vector(0.1, 1.5)});
    }
    return boxes;
  };
  std::vector<std::vector<Box>> scenes = {{},
                                          scattered(10, 5.0),
                                          scattered(100, 10.0),
                                          scattered(300, 15.0),
                                          scattered(9000, 40.0),
                                          scattered(60000, 50.0)};  // more than a cache holds
  scenes.push_back(scattered(300, 15.0));
  scenes.back()[7] = AlignedBox{{-1e300, 10.0, -1e300}, {1e300, 11.0, 1e300}};
  // More that are entered at once than any kernel keeps.
  scenes.emplace_back(200, AlignedBox{{5, -9, -9}, {6, 9, 9}});
  scenes.emplace_back(200, OrientedBox{{5, 0, 0}, {0.5, 0.5, 0.5, 0.5}, {1, 9, 9}});
  return scenes;
}

TEST(Batch, OfAnySceneAndAnyRayIsThatOfSingleRays) {
  reference::Sampler sampler(13);
  for (const std::vector<Box>& boxes : scenesOfEachKind()) {
    const Scene scene(boxes);
    // The first two are of such numbers that no kernel takes them.
    std::vector<Ray> rays{{{-1e25, 0.0, 0.0}, {1.0, 0.0, 0.0}},
                          {{-9.0, 0.0, 0.0}, {1e-200, 1e-201, 0.0}}};
    while (rays.size() < 700) {
      const Vector3 from = sampler.vector(-10.0, 10.0);
      const Vector3 toward = sampler.direction();
      rays.push_back({from, toward});
      rays.push_back({-1e9 * toward, 1e25 * toward});
      rays.push_back({from, Vector3::Unit(sampler.index(3))});
      rays.push_back({Vector3::Zero(), Vector3(1.0, sampler.uniform(-0.5, 0.5), 0.0)});
    }
    std::vector<Segment> segments;
    for (const Ray& ray : rays) {
      segments.push_back({ray.origin, ray.origin + 9.0 * ray.direction});
    }
    const auto clear = isClearEach(scene, segments, 0.0);
    for (std::size_t i = 0; i < segments.size(); ++i) {
      ASSERT_EQ(clear[i] != 0, scene.isClear(segments[i], 0.0)) << "segment " << i;
    }
    for (const double range : {6.0, std::numeric_limits<double>::infinity()}) {
      const auto hits = castEach(scene, rays, {range});
      const auto closest = castClosestEach(scene, rays, {range});
      const auto any = castAnyEach(scene, rays, {range});
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit hit = scene.cast(rays[i], range);
        ASSERT_EQ(hits[i].box, hit.box) << boxes.size() << " boxes, ray " << i;
        ASSERT_TRUE(same(hits[i].range, hit.range) && same(hits[i].point, hit.point));
        ASSERT_EQ(closest[i].box, hit.box);
        ASSERT_EQ(any[i] != 0, hit.hit);
      }
    }
  }
}

}  // namespace
}  // namespace box_query
