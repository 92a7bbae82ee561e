// SPDX-License-Identifier: BSD-3-Clause
// What a scene does not need is not done.
#include "reference/sampler.h"

#include <box_query/batch.h>
#include <box_query/counters.h>
#include <box_query/scene.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace box_query {
namespace {

using reference::Sampler;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr std::size_t kRays = 1000;

template <typename Ask>
QueryCounters workOf(Ask&& ask) {
  const QueryCounters before = queryCounters();
  ask();
  return queryCounters() - before;
}

bool isPortable() {
  return std::string(activeKernels()) == "portable";
}

double sideOf(std::size_t count) {
  return 3.0 * std::cbrt(static_cast<double>(count));
}

std::vector<Box> turnedBoxes(std::size_t count) {
  Sampler sampler(1);
  const double side = sideOf(count);
  std::vector<Box> boxes;
  while (boxes.size() < count) {
    boxes.emplace_back(
        OrientedBox{sampler.vector(-side, side), sampler.rotation(), sampler.vector(0.1, 1.5)});
  }
  return boxes;
}

std::vector<Ray> raysAmong(std::size_t boxes) {
  Sampler sampler(2);
  std::vector<Ray> rays;
  while (rays.size() < kRays) {
    rays.push_back({sampler.vector(-sideOf(boxes), sideOf(boxes)), sampler.direction()});
  }
  return rays;
}

QueryCounters castAll(const Scene& scene, double max_range = kInf) {
  return workOf([&] {
    for (const Ray& ray : raysAmong(scene.size())) {
      scene.castClosest(ray, max_range);
    }
  });
}

TEST(SkippedWork, AHandfulOfBoxesHasNoIndex) {
  // One block of up to sixteen, and nothing else.
  EXPECT_EQ(castAll(Scene(turnedBoxes(5))).nodes, kRays);
  EXPECT_EQ(castAll(Scene(turnedBoxes(16))).nodes, kRays);
}

TEST(SkippedWork, AlignedBoxesAreNotRotatedFor) {
  std::vector<Box> boxes = turnedBoxes(500);
  EXPECT_GT(castAll(Scene(boxes)).turned_boxes, kRays / 5);
  for (Box& box : boxes) {
    const auto& turned = *std::get_if<OrientedBox>(&box);
    box = AlignedBox{turned.center - turned.half_extents, turned.center + turned.half_extents};
  }
  const QueryCounters work = castAll(Scene(boxes));
  EXPECT_GT(work.boxes, kRays / 5);
  EXPECT_EQ(work.turned_boxes, 0U);
  // Nor for those that are turned by nothing, or by a right angle.
  for (Box& box : boxes) {
    box = OrientedBox{{std::round(std::get_if<AlignedBox>(&box)->min.x()), 0.0, 0.0},
                      {1.0, 1.0, 0.0, 0.0},
                      {0.5, 1.0, 2.0}};
  }
  const Scene scene(boxes);
  const QueryCounters right_angles = workOf([&] {
    EXPECT_TRUE(scene.castClosest({{0.0, -9.0, 0.0}, {0.0, 1.0, 0.0}}).hit);
  });
  EXPECT_GT(right_angles.boxes, 0U);
  EXPECT_EQ(right_angles.turned_boxes, 0U);
}

TEST(SkippedWork, WhatFloatExcludesIsNotComparedInDouble) {
  for (const std::size_t count : {10U, 100U, 5000U}) {
    const Scene scene(turnedBoxes(count));
    const double beside = 2.0 * sideOf(count);
    const QueryCounters work = workOf([&] {
      for (const Ray& ray : raysAmong(count)) {
        EXPECT_FALSE(scene.castAny({{beside, beside, ray.origin.z()}, {1.0, 0.1, 0.0}}));
      }
    });
    EXPECT_EQ(work.boxes, 0U) << count;
  }
}

TEST(SkippedWork, WhatFloatDecidesAmongFewBoxesIsNotComparedInDouble) {
  std::vector<Box> row;  // one behind the other
  for (int i = 0; i < 12; ++i) {
    row.emplace_back(OrientedBox{{3.0 * i, 0.0, 0.0}, {1.0, 0.1, 0.2, 0.3}, {1.0, 1.0, 1.0}});
  }
  const Scene scene(row);
  const Ray ray{{-5.0, 0.1, 0.1}, {1.0, 0.0, 0.0}};
  EXPECT_EQ(workOf([&] { EXPECT_TRUE(scene.castAny(ray)); }).boxes, 0U);
  EXPECT_EQ(workOf([&] {
              EXPECT_FALSE(scene.isClear({{-5.0, 0.1, 0.1}, {5.0, 0.1, 0.1}}, 0.0));
            }).boxes,
            0U);
  EXPECT_EQ(workOf([&] { EXPECT_EQ(scene.castClosest(ray).box, 0U); }).boxes, 1U);
}

TEST(SkippedWork, OfAHeapHardlyMoreThanTheFirstBoxIsComparedInDouble) {
  for (const std::size_t size : {40, 100, 600, 1024}) {
    if (size > 48 && isPortable()) {
      continue;  // which is as fast with a tree
    }
    Sampler sampler(3);
    std::vector<Box> heap;
    while (heap.size() < size) {
      heap.emplace_back(
          OrientedBox{sampler.vector(-0.5, 0.5), sampler.rotation(), sampler.vector(0.5, 1.5)});
    }
    const Scene scene(heap);
    std::vector<Ray> rays;
    while (rays.size() < kRays) {
      const Vector3 origin = 5.0 * sampler.direction().normalized();
      rays.push_back({origin, sampler.vector(-0.5, 0.5) - origin});
    }
    std::vector<ClosestBox> closest(rays.size());
    const QueryCounters one_by_one = workOf([&] {
      for (const Ray& ray : rays) {
        EXPECT_TRUE(scene.castClosest(ray).hit);
      }
    });
    const QueryCounters together =
        workOf([&] { scene.castClosest(rays.data(), rays.size(), closest.data()); });
    EXPECT_LT(one_by_one.boxes, kRays * 11 / 10) << "among " << size;
    EXPECT_LT(together.boxes, kRays * 11 / 10) << "among " << size;
  }
}

TEST(SkippedWork, OfAHeapNothingIsComparedInDoubleForARayThatPassesIt) {
  Sampler sampler(4);
  std::vector<Box> heap;
  while (heap.size() < 300) {
    heap.emplace_back(
        OrientedBox{sampler.vector(-0.5, 0.5), sampler.rotation(), sampler.vector(0.5, 1.5)});
  }
  const Scene scene(heap);
  const QueryCounters work = workOf([&] {
    EXPECT_FALSE(scene.castClosest({{5.0, 5.0, 5.0}, {1.0, 0.2, 0.3}}).hit);
  });
  EXPECT_EQ(work.boxes, 0U);
}

/// A ray along such a scene meets the bounds of many boxes, but most rays meet those of few, and
/// then the boxes too.
TEST(SkippedWork, OfALongSceneAndOfAStackOnlyWhatIsNearARayIsCompared) {
  for (const std::size_t size : {180, 600, 1024}) {
    Sampler sampler(5);
    std::vector<Box> road;
    std::vector<Box> stack;
    while (road.size() < size) {
      const auto i = static_cast<double>(road.size());
      const Vector3 center(2.0 * i, sampler.vector(-4.0, 4.0).y(), 0.0);
      road.emplace_back(OrientedBox{center, sampler.rotation(), sampler.vector(0.5, 1.0)});
      stack.emplace_back(AlignedBox{Vector3(0.0, 0.0, i), Vector3(200.0, 200.0, i + 0.5)});
    }
    const Scene along(road);
    const Scene stacked(stack);
    const auto count = static_cast<double>(size);
    const QueryCounters work = workOf([&] {
      for (std::size_t k = 0; k < kRays; ++k) {
        const Vector3 at = sampler.vector(0.0, count);
        along.castClosest({{2.0 * at.x(), 0.0, 0.0}, sampler.direction()}, 3.0);
        stacked.castClosest({{100.0, 100.0, at.z()}, sampler.direction()}, 3.0);
      }
    });
    EXPECT_LT(work.nodes, 2 * kRays * 8) << "among " << size;
  }
}

TEST(SkippedWork, OfBoxesThatFillASceneABatchLooksAtNoMoreThanEachRayDoes) {
  Sampler sampler(6);
  std::vector<Box> boxes;  // one in the other
  while (boxes.size() < 3000) {
    const double half = 3.0 - 0.001 * static_cast<double>(boxes.size());
    boxes.emplace_back(AlignedBox{Vector3::Constant(-half), Vector3::Constant(half)});
  }
  const Scene scene(boxes);
  std::vector<Ray> rays;
  std::vector<Segment> segments;
  while (rays.size() < kRays) {
    rays.push_back({sampler.vector(-3.0, 3.0), sampler.direction()});
    segments.push_back({rays.back().origin, rays.back().origin + rays.back().direction});
  }
  std::vector<std::uint8_t> said(kRays);
  const QueryCounters one_by_one = workOf([&] {
    for (std::size_t k = 0; k < kRays; ++k) {
      scene.castAny(rays[k]);
      scene.isClear(segments[k], 0.1);
    }
  });
  const QueryCounters together = workOf([&] {
    scene.castAny(rays.data(), kRays, said.data());
    scene.isClear(segments.data(), kRays, said.data(), 0.1);
  });
  EXPECT_LE(together.nodes, one_by_one.nodes);
  EXPECT_LE(together.boxes, one_by_one.boxes);
}

TEST(SkippedWork, WhatIsNotWithinARadiusIsNotComparedInDoubleWhereverABoxLies) {
  std::vector<Box> row;
  for (int i = 0; i < 300; ++i) {
    row.emplace_back(OrientedBox{{5.0 * i, 0.0, 0.0}, {1.0, 0.1, 0.2, 0.3}, {1.0, 1.0, 1.0}});
  }
  for (const double far : {1e3, 1e8}) {  // where floats hardly tell the others apart
    std::vector<Box> boxes = row;
    boxes.emplace_back(AlignedBox{{far, far, 0.0}, {far + 1.0, far + 1.0, 1.0}});
    const Scene scene(boxes);
    const Segment segment{{700.0, 5.0, 0.0}, {704.0, 5.0, 0.0}};
    EXPECT_LE(workOf([&] { EXPECT_TRUE(scene.isClear(segment, 0.3)); }).boxes, 2U) << far;
    const std::vector<Segment> segments(20, segment);
    std::vector<std::uint8_t> clear(20);
    const QueryCounters together =
        workOf([&] { scene.isClear(segments.data(), 20, clear.data(), 0.3); });
    EXPECT_LE(together.boxes, 40U) << far;
  }
}

TEST(SkippedWork, OfAClusterInAnEmptySceneFewNodesAreComparedForALargeRadius) {
  Sampler sampler(5);
  std::vector<Box> boxes = {AlignedBox{{-2e3, -2e3, -2e3}, {-1999.0, -1999.0, -1999.0}},
                            AlignedBox{{2e3, 2e3, 2e3}, {2001.0, 2001.0, 2001.0}}};
  while (boxes.size() < 5000) {
    boxes.emplace_back(
        OrientedBox{sampler.vector(-0.5, 0.5), sampler.rotation(), {1e-3, 1e-3, 1e-3}});
  }
  const Scene scene(boxes);
  const std::vector<Segment> segments(16, Segment{{0.0, 0.0, 0.0}, {0.1, 0.1, 0.0}});
  std::vector<std::uint8_t> clear(16);
  const QueryCounters work =
      workOf([&] { scene.isClear(segments.data(), 16, clear.data(), 10.0); });
  EXPECT_EQ(clear, std::vector<std::uint8_t>(16, 0));
  EXPECT_LT(work.nodes, 16U * 20);
}

TEST(SkippedWork, WhichOfTheBoxesThatARayStartsInComesFirstIsNotCompared) {
  const std::vector<Box> nest = [] {
    std::vector<Box> boxes;
    for (int i = 0; i < 100; ++i) {
      const double size = 1.0 + 0.01 * (i * 37 % 100);
      boxes.emplace_back(OrientedBox{{0.0, 0.0, 0.0}, {1.0, 0.1, 0.2, 0.3}, {size, size, size}});
    }
    return boxes;
  }();
  const Scene scene(nest);
  const QueryCounters work = workOf([&] {
    const ClosestBox closest = scene.castClosest({{0.1, 0.2, 0.3}, {1.0, 0.0, 0.0}});
    EXPECT_EQ(closest.box, 0U);
    EXPECT_EQ(closest.t_upper, 0.0);
  });
  EXPECT_EQ(work.boxes, 100U);
  EXPECT_EQ(work.certified_decisions + work.exact_decisions, 0U);
}

TEST(SkippedWork, WhereFloatSaysWhichBoxIsNearestDoubleIsNotAsked) {
  if (isPortable()) {
    GTEST_SKIP() << "the portable kernel does not go on from a float";
  }
  for (const std::size_t count : {10U, 100U, 5000U}) {
    const Scene scene(turnedBoxes(count));
    std::vector<Segment> segments;
    for (const Ray& ray : raysAmong(count)) {
      segments.push_back({ray.origin, ray.origin + ray.direction});
    }
    std::vector<Clearance> clearances(segments.size());
    std::size_t apart = 0;
    const QueryCounters one_by_one = workOf([&] {
      for (const Segment& segment : segments) {
        apart += scene.clearance(segment).distance > 0.0 ? 1 : 0;
      }
    });
    const QueryCounters together =
        workOf([&] { scene.clearance(segments.data(), segments.size(), clearances.data()); });
    EXPECT_GT(apart, kRays / 2);
    EXPECT_LT(one_by_one.boxes, 3 * (kRays - apart) + kRays / 10) << count;
    EXPECT_LT(together.boxes, 3 * (kRays - apart) + kRays / 10) << count;
  }
}

TEST(SkippedWork, OfSegmentsTogetherOnlyNearRootsAreCompared) {
  if (isPortable()) {
    GTEST_SKIP() << "the portable kernel has segments one by one";
  }
  const Scene scene(turnedBoxes(1000));
  std::vector<Segment> segments;
  for (const Ray& ray : raysAmong(scene.size())) {
    segments.push_back({ray.origin, ray.origin + ray.direction});
  }
  std::vector<Clearance> clearances(segments.size());
  const QueryCounters one_by_one = workOf([&] {
    for (const Segment& segment : segments) {
      scene.clearance(segment);
    }
  });
  const QueryCounters together =
      workOf([&] { scene.clearance(segments.data(), segments.size(), clearances.data()); });
  // One by one they are all compared, at once: some five.
  EXPECT_LT(together.nodes, one_by_one.nodes - one_by_one.nodes / 8);
}

TEST(SkippedWork, WhatDoubleDecidesIsNotDecidedExactly) {
  const Scene scene(turnedBoxes(2000));
  std::size_t hits = 0;
  const QueryCounters work = workOf([&] {
    for (const Ray& ray : raysAmong(scene.size())) {
      hits += scene.cast(ray).hit ? 1 : 0;
      scene.clearance({ray.origin, ray.origin + ray.direction});
    }
  });
  EXPECT_GT(hits, kRays / 3);
  EXPECT_EQ(work.certified_decisions, 0U);
  EXPECT_EQ(work.exact_decisions, 0U);
  EXPECT_EQ(work.exact_roundings, 0U);
}

TEST(SkippedWork, WhatLiesBehindTheHitOrTheRangeIsNotLookedAt) {
  const std::vector<Box> boxes = turnedBoxes(20000);
  const QueryCounters far = castAll(Scene(boxes));
  const QueryCounters near = castAll(Scene(boxes), 1.0);
  EXPECT_LT(2 * near.nodes, far.nodes);
  EXPECT_LT(2 * near.boxes, far.boxes);
  const Scene scene(boxes);
  const QueryCounters all = workOf([&] {
    for (const Ray& ray : raysAmong(scene.size())) {
      scene.findAll(ray);
    }
  });
  EXPECT_LT(far.boxes, all.boxes) << "what is behind the first hit";
}

TEST(SkippedWork, DoubtIsCounted) {
  // Two boxes with one face: which of them is entered first, doubles cannot say.
  const OrientedBox box{{5.0, 0.0, 0.0}, {1.0, 0.1, 0.2, 0.3}, {1.0, 1.0, 1.0}};
  OrientedBox longer = box;
  longer.orientation = {2.0, 0.2, 0.4, 0.6};
  const Scene scene({box, longer});
  const QueryCounters work = workOf([&] {
    EXPECT_EQ(scene.cast({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}).box, 0U);
  });
  EXPECT_EQ(work.boxes, 2U);
  EXPECT_EQ(work.turned_boxes, 2U);
  EXPECT_GT(work.certified_decisions + work.exact_decisions, 0U);
}

TEST(SkippedWork, ABatchCountsWhatItsThreadsDo) {
  const Scene scene(turnedBoxes(2000));
  const std::vector<Ray> rays = raysAmong(scene.size());
  std::vector<ClosestBox> closest(rays.size());
  const QueryCounters single =
      workOf([&] { scene.castClosest(rays.data(), rays.size(), closest.data()); });
  EXPECT_GT(single.nodes, kRays);
  for (const int threads : {1, 3}) {
    QueryCounters batch;
    BatchOptions options;
    options.max_threads = threads;
    options.counters = &batch;
    castClosestEach(scene, rays, options);
    EXPECT_EQ(batch.nodes, single.nodes);
    EXPECT_EQ(batch.boxes, single.boxes);
    castClosestEach(scene, rays, options);
    EXPECT_EQ(batch.nodes, 2 * single.nodes);
  }
}

TEST(SkippedWork, IsCountedForEachThread) {
  const Scene scene(turnedBoxes(100));
  const QueryCounters here = workOf([&] { std::thread([&] { castAll(scene); }).join(); });
  EXPECT_EQ(here.nodes, 0U);
}

}  // namespace
}  // namespace box_query
