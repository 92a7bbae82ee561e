// SPDX-License-Identifier: BSD-3-Clause
#include "reference/sampler.h"

#include <box_query/scene.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace box_query {
namespace {

using reference::Sampler;

constexpr double kInf = std::numeric_limits<double>::infinity();

/// Boxes, and which they were before.
struct Next {
  std::vector<Box> boxes;
  std::vector<std::size_t> previous;
};

double sideOf(std::size_t count) {
  return 3.0 * std::cbrt(static_cast<double>(count));
}

/// A fifth of them aligned.
Box randomBox(Sampler& sampler, double side) {
  const Vector3 center = sampler.vector(-side, side);
  const Vector3 size = sampler.vector(0.1, 1.5);
  if (sampler.chance(0.2)) {
    return AlignedBox{center - size, center + size};
  }
  return OrientedBox{center, sampler.rotation(), size};
}

std::vector<Box> randomBoxes(Sampler& sampler, std::size_t count) {
  std::vector<Box> boxes;
  while (boxes.size() < count) {
    boxes.push_back(randomBox(sampler, sideOf(count)));
  }
  return boxes;
}

Box moved(Sampler& sampler, const Box& any, double far) {
  const Vector3 by = sampler.vector(-far, far);
  if (const auto* aligned = std::get_if<AlignedBox>(&any)) {
    return AlignedBox{aligned->min + by, aligned->max + by};
  }
  OrientedBox box = *std::get_if<OrientedBox>(&any);
  box.center += by;
  box.orientation = sampler.rotation();
  return box;
}

/// Each box is gone, or has moved by up to `far`, with these chances; others come, and all change
/// places.
Next nextOf(Sampler& sampler, const std::vector<Box>& boxes, double gone, double move, double far,
            std::size_t come) {
  Next next;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!sampler.chance(gone)) {
      next.boxes.push_back(sampler.chance(move) ? moved(sampler, boxes[i], far) : boxes[i]);
      next.previous.push_back(i);
    }
  }
  for (; come > 0; --come) {
    next.boxes.push_back(randomBox(sampler, sideOf(boxes.size())));
    next.previous.push_back(kNoBox);
  }
  for (std::size_t i = next.boxes.size(); i > 1; --i) {
    const auto other = static_cast<std::size_t>(sampler.index(static_cast<int>(i)));
    std::swap(next.boxes[i - 1], next.boxes[other]);
    std::swap(next.previous[i - 1], next.previous[other]);
  }
  return next;
}

/// Compares every kind of query with a new scene of the same boxes.
void expectAnswersOfNewScene(Sampler& sampler, const Scene& scene) {
  const Scene fresh(scene.boxes());
  const double side = sideOf(scene.size());
  BoxMask mask(scene.size());
  for (std::size_t i = 0; i < scene.size(); i += 2) {
    mask.set(i, false);
  }
  std::size_t hits = 0;
  constexpr std::size_t kQueries = 300;
  for (std::size_t k = 0; k < kQueries; ++k) {
    const Ray ray{sampler.vector(-side, side), sampler.direction()};
    const BoxMask* look = k % 3 == 0 ? &mask : nullptr;
    const double range = k % 2 == 0 ? 5.0 : kInf;
    const Hit hit = fresh.cast(ray, range, look);
    const Hit same = scene.cast(ray, range, look);
    ASSERT_EQ(hit.box, same.box);
    if (hit.hit) {
      ++hits;
      ASSERT_EQ(hit.range, same.range);
      ASSERT_EQ(hit.normal, same.normal);
    }
    ASSERT_EQ(hit.box, scene.castClosest(ray, range, look).box);
    ASSERT_EQ(hit.hit, scene.castAny(ray, range, look));
    const Segment segment{ray.origin, ray.origin + 3.0 * ray.direction};
    const Clearance nearest = fresh.clearance(segment, look);
    ASSERT_EQ(nearest.box, scene.clearance(segment, look).box);
    ASSERT_EQ(nearest.distance, scene.clearance(segment, look).distance);
    ASSERT_EQ(fresh.isClear(segment, 0.5, look), scene.isClear(segment, 0.5, look));
    ASSERT_EQ(fresh.firstBlockage(segment, 0.5, look).box,
              scene.firstBlockage(segment, 0.5, look).box);
    const auto all = fresh.findAll(ray, look);
    const auto same_all = scene.findAll(ray, look);
    ASSERT_EQ(all.size(), same_all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_EQ(all[i].box, same_all[i].box);
    }
  }
  EXPECT_GT(hits, kQueries / 20);
}

TEST(SceneUpdate, AnswersAreThoseOfANewScene) {
  Sampler sampler(1);
  std::size_t refitted = 0;
  for (const std::size_t count : {20U, 100U, 200U, 2000U}) {
    Scene scene(randomBoxes(sampler, count));
    for (int step = 0; step < 12; ++step) {
      const std::size_t come = step % 3 == 0 ? count / 50 : 0;
      Next next = nextOf(sampler, scene.boxes(), 0.01, 0.1, 0.3, come);
      scene = scene.updated(next.boxes, next.previous);
      refitted += scene.update().rebuilt ? 0 : 1;
      expectAnswersOfNewScene(sampler, scene);
    }
  }
  EXPECT_GT(refitted, 15U);
}

/// Aligned boxes with centers within `spread` of the origin.
std::vector<Box> boxesWithin(Sampler& sampler, std::size_t count, double spread, double least,
                             double most) {
  std::vector<Box> boxes;
  while (boxes.size() < count) {
    const Vector3 center = sampler.vector(-spread, spread);
    const Vector3 size = sampler.vector(least, most);
    boxes.emplace_back(AlignedBox{center - size, center + size});
  }
  return boxes;
}

/// Turned boxes that overlap so much that the kernels compare them themselves though they make more
/// than a list.
std::vector<Box> heapOf(Sampler& sampler, std::size_t count) {
  std::vector<Box> heap;
  while (heap.size() < count) {
    heap.emplace_back(
        OrientedBox{sampler.vector(-6.0, 6.0), sampler.rotation(), sampler.vector(2.0, 6.0)});
  }
  return heap;
}

TEST(SceneUpdate, HeapedBoxesAreWhereTheyMovedTo) {
  Sampler sampler(8);
  std::size_t refitted = 0;
  for (const std::size_t count : {160, 400, 1024}) {
    Scene scene(heapOf(sampler, count));
    for (int step = 0; step < 8; ++step) {
      const bool is_other = step % 3 == 0;
      Next next = nextOf(sampler, scene.boxes(), is_other ? 0.01 : 0.0, 0.3, 2.0, is_other ? 3 : 0);
      scene = scene.updated(next.boxes, next.previous);
      refitted += scene.update().rebuilt ? 0 : 1;
      expectAnswersOfNewScene(sampler, scene);
    }
  }
  EXPECT_GT(refitted, 15U);
}

TEST(SceneUpdate, ScatteredBoxesBecomeAHeapAndAreScatteredAgain) {
  Sampler sampler(10);
  const std::vector<Box> heap = heapOf(sampler, 300);
  std::vector<Box> scattered = heap;
  std::vector<std::size_t> previous;
  for (Box& box : scattered) {
    previous.push_back(previous.size());
    std::get<OrientedBox>(box).half_extents *= 0.2;
  }
  Scene scene(scattered);
  for (const std::vector<Box>& next : {heap, scattered, heap}) {
    scene = scene.updated(next, previous);
    expectAnswersOfNewScene(sampler, scene);
  }
}

TEST(SceneUpdate, CrowdedBoxesThatNoKernelComparesThemselvesAreRefitted) {
  Sampler sampler(9);
  Scene scene(boxesWithin(sampler, 160, 12.0, 0.3, 1.5));
  const Next next = nextOf(sampler, scene.boxes(), 0.0, 0.1, 0.3, 0);
  scene = scene.updated(next.boxes, next.previous);
  EXPECT_FALSE(scene.update().rebuilt);
  expectAnswersOfNewScene(sampler, scene);
}

TEST(SceneUpdate, CountsWhatIsDifferent) {
  Sampler sampler(2);
  const std::vector<Box> boxes = randomBoxes(sampler, 1000);
  const Scene scene(boxes);
  EXPECT_TRUE(scene.update().rebuilt);
  EXPECT_EQ(scene.update().added, 1000U);

  Next next{boxes, {}};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    next.previous.push_back(i);
  }
  next.boxes[7] = moved(sampler, boxes[7], 0.1);
  next.boxes[8] = moved(sampler, boxes[8], 0.1);
  next.boxes.push_back(randomBox(sampler, 10.0));
  next.previous.push_back(kNoBox);
  next.boxes.erase(next.boxes.begin());
  next.previous.erase(next.previous.begin());
  const SceneUpdate update = scene.updated(next.boxes, next.previous).update();
  EXPECT_FALSE(update.rebuilt);
  EXPECT_EQ(update.moved, 2U);
  EXPECT_EQ(update.added, 1U);
  EXPECT_EQ(update.removed, 1U);
}

/// The share of updates that were not built anew, of a scene whose boxes all move.
double shareRefitted(double far) {
  Sampler sampler(3);
  Scene scene(randomBoxes(sampler, 1000));
  constexpr int kSteps = 10;
  int refitted = 0;
  for (int step = 0; step < kSteps; ++step) {
    Next next = nextOf(sampler, scene.boxes(), 0.0, 1.0, far, 0);
    scene = scene.updated(next.boxes, next.previous);
    refitted += scene.update().rebuilt ? 0 : 1;
  }
  return static_cast<double>(refitted) / kSteps;
}

TEST(SceneUpdate, IsBuiltAnewOnlyWhereBoundsBecomeBad) {
  EXPECT_EQ(shareRefitted(0.05), 1.0);
  EXPECT_EQ(shareRefitted(30.0), 0.0);
}

TEST(SceneUpdate, BoxesThatComeOneByOneAreNoneTooMany) {
  Sampler sampler(4);
  Scene scene(randomBoxes(sampler, 400));
  std::size_t rebuilt = 0;
  for (int step = 0; step < 300; ++step) {
    Next next = nextOf(sampler, scene.boxes(), 0.0, 0.0, 0.0, 1);
    scene = scene.updated(next.boxes, next.previous);
    rebuilt += scene.update().rebuilt ? 1 : 0;
  }
  EXPECT_EQ(scene.size(), 700U);
  EXPECT_GE(rebuilt, 1U);
  EXPECT_LE(rebuilt, 4U);
  expectAnswersOfNewScene(sampler, scene);
}

TEST(SceneUpdate, TakesBoxesThatKernelsMayNotTake) {
  Sampler sampler(5);
  Scene scene(randomBoxes(sampler, 300));
  for (int step = 0; step < 3; ++step) {
    Next next = nextOf(sampler, scene.boxes(), 0.0, 0.0, 0.0, 0);
    const std::size_t at = step == 0 ? 0 : 1;
    next.boxes[at] = AlignedBox{{-1e300, 20.0, -1e300}, {1e300, 21.0, 1e300}};
    if (step == 2) {
      next.boxes[at] = AlignedBox{{0, 0, 0}, {1, 1, 1}};
    }
    scene = scene.updated(next.boxes, next.previous);
    expectAnswersOfNewScene(sampler, scene);
  }
}

TEST(SceneUpdate, FromNothingAndToNothing) {
  Sampler sampler(6);
  const std::vector<Box> boxes = randomBoxes(sampler, 200);
  const Scene some = Scene().updated(boxes, std::vector<std::size_t>(200, kNoBox));
  EXPECT_TRUE(some.update().rebuilt);
  expectAnswersOfNewScene(sampler, some);
  const Scene none = some.updated({}, {});
  EXPECT_EQ(none.size(), 0U);
  EXPECT_EQ(none.update().removed, 200U);
  EXPECT_FALSE(none.cast({{0, 0, 0}, {1, 0, 0}}).hit);
}

TEST(SceneUpdate, RefusesWhatDoesNotFit) {
  const Box cube = AlignedBox{{0, 0, 0}, {1, 1, 1}};
  const Scene scene({cube, cube});
  EXPECT_THROW(scene.updated({cube}, {}), std::invalid_argument);
  EXPECT_THROW(scene.updated({cube}, {2}), std::invalid_argument);
  EXPECT_THROW(scene.updated({cube, cube}, {1, 1}), std::invalid_argument);
  EXPECT_THROW(scene.updated({AlignedBox{{1, 0, 0}, {0, 0, 0}}}, {0}), std::invalid_argument);
}

}  // namespace
}  // namespace box_query
