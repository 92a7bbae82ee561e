// SPDX-License-Identifier: BSD-3-Clause
#include "kernels/scene_view.h"
#include "reference/sampler.h"

#include <box_query/counters.h>
#include <box_query/scene.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace box_query {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kMax = std::numeric_limits<double>::max();

AlignedBox cubeAt(double x, double y = 0, double z = 0) {
  return {Vector3(x - 1, y - 1, z - 1), Vector3(x + 1, y + 1, z + 1)};
}

OrientedBox turnedCubeAt(double x) {
  return {Vector3(x, 0, 0), Quaternion(1, 0, 0, 0), Vector3::Ones()};
}

const Ray kAlongX{{0, 0, 0}, {2, 0, 0}};

TEST(SceneCast, AnEmptySceneIsMissed) {
  for (const Scene& scene : {Scene(), Scene(std::vector<Box>())}) {
    const Hit hit = scene.cast(kAlongX);
    EXPECT_FALSE(hit.hit);
    EXPECT_EQ(hit.box, kNoBox);
    EXPECT_EQ(hit.range, kInf);
    EXPECT_TRUE(std::isnan(hit.exit_range));
    EXPECT_TRUE(std::isnan(hit.normal[0]));
    EXPECT_FALSE(scene.castAny(kAlongX));
    EXPECT_TRUE(scene.findAll(kAlongX).empty());
  }
}

TEST(SceneCast, AnInvalidBoxIsNamed) {
  try {
    const Scene scene({cubeAt(0), OrientedBox{Vector3::Zero(), Quaternion(0, 0, 0, 0), {1, 1, 1}}});
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("box 1"), std::string::npos);
  }
}

TEST(SceneCast, TheClosestBoxOfBothKinds) {
  const Scene scene({cubeAt(30), turnedCubeAt(10), cubeAt(20), cubeAt(-10)});
  const Hit hit = scene.cast(kAlongX);
  EXPECT_TRUE(hit.hit);
  EXPECT_EQ(hit.box, 1U);
  EXPECT_EQ(hit.range, 9.0);
  EXPECT_EQ(hit.exit_range, 11.0);
  EXPECT_EQ(hit.t, 4.5);
  EXPECT_FALSE(hit.started_inside);
  EXPECT_EQ(hit.entered, FaceSet(1U));
  EXPECT_EQ(hit.point, Vector3(9, 0, 0));
  EXPECT_EQ(hit.normal, Vector3(-1, 0, 0));
}

TEST(SceneCast, TiesGoToTheLowestIndex) {
  const Scene scene({cubeAt(20), turnedCubeAt(10), cubeAt(10), cubeAt(10, 1)});
  EXPECT_EQ(scene.cast(kAlongX).box, 1U);
  BoxMask mask(4);
  mask.set(1, false);
  EXPECT_EQ(scene.cast(kAlongX, kInf, &mask).box, 2U);
  // A shelf: the plane x = 9 belongs to three boxes, and 0.1 + 0.2 is not 0.3.
  const Scene near_tie(
      {AlignedBox{{0.1 + 0.2, -1, -1}, {1, 1, 1}}, AlignedBox{{0.3, -1, -1}, {1, 1, 1}}});
  EXPECT_EQ(near_tie.cast(kAlongX).box, 1U);
}

TEST(SceneCast, OrderIsExactWhereParametersRoundToEqualDoubles) {
  // t = a / 3 for two neighbouring a, closer than doubles of t can tell.
  const double a = 1.5;
  const double b = std::nextafter(a, 2.0);
  const Scene scene({AlignedBox{{b, -1, -1}, {9, 1, 1}}, AlignedBox{{a, -1, -1}, {9, 1, 1}}});
  const Ray ray{{0, 0, 0}, {1.0 + 0x1p-52, 0, 0}};
  EXPECT_EQ(scene.cast(ray).box, 1U);
  const auto all = scene.findAll(ray);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].box, 1U);
  // Beyond the range of double every parameter is infinite, and the order still known.
  const Scene far({cubeAt(1e100), cubeAt(1e99), cubeAt(1e98)});
  const Ray slow{{0, 0, 0}, {1e-300, 0, 0}};
  const Hit hit = far.cast(slow);
  EXPECT_EQ(hit.box, 2U);
  EXPECT_EQ(hit.t, kInf);
  EXPECT_EQ(hit.range, 1e98);
  EXPECT_EQ(far.findAll(slow)[1].box, 1U);
}

TEST(SceneCast, StartingInsideIsRangeZero) {
  const Scene scene({cubeAt(5), cubeAt(0)});
  const Hit hit = scene.cast(kAlongX);
  EXPECT_EQ(hit.box, 1U);
  EXPECT_TRUE(hit.started_inside);
  EXPECT_EQ(hit.range, 0.0);
  EXPECT_EQ(hit.exit_range, 1.0);
  EXPECT_EQ(hit.normal, Vector3(0, 0, 0));
  EXPECT_EQ(hit.point, kAlongX.origin);
}

TEST(SceneCast, OfBoxesAroundTheOriginTheLowestIndexIsFirst) {
  const Quaternion turn(0.8, 0.36, 0.48, 0.1);
  const OrientedBox around{{0.1, 0, 0}, turn, {2, 1, 1}};
  const OrientedBox far{{9, 0, 0}, turn, {1, 1, 1}};
  const OrientedBox larger{{0, 0.2, 0}, turn, {3, 2, 4}};
  const Ray ray{{0.2, 0.1, 0.3}, {1, 0.5, -0.25}};
  // Alone, and among so many that the tree offers them in an order of its own.
  for (const int others : {0, 200}) {
    std::vector<Box> boxes{far, around, larger, around};
    for (int i = 0; i < others; ++i) {
      boxes.emplace_back(cubeAt(20 + i, 5));
    }
    EXPECT_EQ(Scene(boxes).cast(ray).box, 1U);
    EXPECT_EQ(Scene(boxes).castClosest(ray).t_upper, 0.0);
    std::swap(boxes[1], boxes[2]);
    EXPECT_EQ(Scene(boxes).cast(ray).box, 1U);
    EXPECT_EQ(Scene(boxes).castClosest(ray).box, 1U);
    boxes.insert(boxes.begin(), far);
    EXPECT_EQ(Scene(boxes).cast(ray).box, 2U);
  }
}

TEST(SceneCast, AZeroDirectionIsAPoint) {
  const Scene scene({cubeAt(5), cubeAt(0)});
  const Hit hit = scene.cast(Ray{{0, 1, 0}, {0, 0, 0}});
  EXPECT_EQ(hit.box, 1U);
  EXPECT_TRUE(hit.started_inside);
  EXPECT_EQ(hit.range, 0.0);
  EXPECT_EQ(hit.exit_range, 0.0);
  EXPECT_TRUE(scene.castAny(Ray{{0, 1, 0}, {0, 0, 0}}, 0.0));
  EXPECT_FALSE(scene.cast(Ray{{0, 2, 0}, {0, 0, 0}}).hit);
}

TEST(SceneCast, MaxRangeIsInMetresClosedAndExact) {
  const Scene scene({cubeAt(10)});
  EXPECT_TRUE(scene.cast(kAlongX, 9.0).hit);
  EXPECT_TRUE(scene.castAny(kAlongX, 9.0));
  EXPECT_FALSE(scene.cast(kAlongX, std::nextafter(9.0, 0.0)).hit);
  EXPECT_FALSE(scene.castAny(kAlongX, std::nextafter(9.0, 0.0)));
  EXPECT_TRUE(Scene({cubeAt(1)}).cast(kAlongX, 0.0).hit);
  // The range is irrational: 9 sqrt(2), and no double is equal to it.
  const Ray diagonal{{0, 0, 0}, {1, 1, 0}};
  const Scene corner({cubeAt(10, 10)});
  const double range = corner.cast(diagonal).range;
  EXPECT_EQ(range, std::sqrt(162.0));
  EXPECT_FALSE(corner.castAny(diagonal, std::nextafter(range, 0.0)));
  EXPECT_TRUE(corner.castAny(diagonal, std::nextafter(range, kInf)));
  EXPECT_EQ(corner.castAny(diagonal, range), corner.cast(diagonal, range).hit);
  EXPECT_TRUE(Scene({AlignedBox{{kMax, 0, 0}, {kMax, 0, 0}}}).cast(kAlongX, kMax).hit);
}

// A range that no kernel had looked at was read before it was set.
TEST(SceneCast, MaxRangeHoldsForABoxThatIsNotInTheTree) {
  const AlignedBox tiny{{10, -1e-300, 0}, {11, 1e-300, 0}};
  const Scene scene({tiny, cubeAt(0, 1000), cubeAt(5, 1000), cubeAt(0, -1000)});
  for (const double max_range : {kInf, 9.0, 20.0, 5.0, 10.0, 0.0}) {
    EXPECT_EQ(scene.cast(kAlongX, max_range).hit, max_range >= 10.0) << max_range;
    EXPECT_EQ(scene.castClosest(kAlongX, max_range).hit, max_range >= 10.0) << max_range;
    EXPECT_EQ(scene.castAny(kAlongX, max_range), max_range >= 10.0) << max_range;
  }
}

TEST(SceneCast, MaxRangeHoldsBeyondAllFloats) {
  // Only doubles tell that the ray misses one box, before it meets one that is too far for a tree.
  const AlignedBox missed{{4, 1e-9, -1}, {6, 2, 1}};
  const Scene scene({AlignedBox{{1e150, -1, -1}, {2e150, 1, 1}}, missed, cubeAt(0, 1000)});
  for (const double max_range : {kInf, 9.0, 1e39, 9e149, 1e150, 2e150}) {
    EXPECT_EQ(scene.cast(kAlongX, max_range).hit, max_range >= 1e150) << max_range;
    EXPECT_EQ(scene.castClosest(kAlongX, max_range).hit, max_range >= 1e150) << max_range;
    EXPECT_EQ(scene.castAny(kAlongX, max_range), max_range >= 1e150) << max_range;
  }
}

TEST(SceneCast, MoreDoubtfulBoxesThanAKernelKeepsAreDecided) {
  const auto scene = [](double below) {
    std::vector<Box> row;  // of corners on the ray, or right beside it
    for (int i = 1; i <= 300; ++i) {
      const double c = 0.125 * i;
      row.emplace_back(AlignedBox{{c, c - 1.0, -1.0}, {c + 1.0, c * below, 1.0}});
    }
    return Scene(row);
  };
  const Ray diagonal{{0, 0, 0}, {1, 1, 0}};
  const Segment part{{0, 0, 0}, {50, 50, 0}};
  EXPECT_TRUE(scene(1.0).castAny(diagonal));
  EXPECT_FALSE(scene(1.0).isClear(part, 0.0));
  EXPECT_EQ(scene(1.0).castClosest(diagonal).box, 0U);
  EXPECT_FALSE(scene(1.0 - 0x1p-53).castAny(diagonal));
  EXPECT_TRUE(scene(1.0 - 0x1p-53).isClear(part, 0.0));
  EXPECT_FALSE(scene(1.0 - 0x1p-53).castClosest(diagonal).hit);
}

TEST(SceneCast, ANormalIsThatOfTheLowestAxis) {
  EXPECT_EQ(Scene({cubeAt(5, 5, 5)}).cast(Ray{{0, 0, 0}, {1, 1, 1}}).normal, Vector3(-1, 0, 0));
  EXPECT_EQ(Scene({cubeAt(0, 5, 5)}).cast(Ray{{0, 0, 0}, {0, 1, 1}}).normal, Vector3(0, -1, 0));
  const OrientedBox turned{Vector3(5, 0, 0), Quaternion(0.7, 0, 0, 0.7), Vector3(1, 2, 3)};
  const Hit hit = Scene({turned}).cast(kAlongX);
  EXPECT_EQ(hit.entered, FaceSet(1U << FaceSet::number(1, true)));
  EXPECT_EQ(hit.range, 3.0);
  EXPECT_NEAR((hit.normal - Vector3(-1, 0, 0)).norm(), 0.0, 1e-15);
}

TEST(SceneCast, BoardsWithOneUpperFaceTieToTheLowestIndex) {
  // 0.1 + 0.2 is no double: the faces are at one height, which no double holds.
  std::vector<Box> boards;
  for (int i = 0; i < 200; ++i) {
    const double turn = 0.01 * (i + 1);
    const double thickness = i % 2 == 0 ? 0.2 : 0.1;
    boards.emplace_back(OrientedBox{{0.001 * i, 0.0, thickness == 0.2 ? 0.1 : 0.2},
                                    Quaternion(std::cos(turn), 0, 0, std::sin(turn)),
                                    {2.0, 2.0, thickness}});
  }
  boards.emplace_back(AlignedBox{{-1, -1, 0}, {1, 1, 0.1 + 0.2}});  // rounded up: higher
  const Ray down{{0.25, 0.125, 5.0}, {0.125, 0.0, -1.0}};
  EXPECT_EQ(200U, Scene(boards).cast(down).box);
  boards.pop_back();
  EXPECT_EQ(0U, Scene(boards).cast(down).box);
  std::swap(boards[0], boards[199]);
  EXPECT_EQ(0U, Scene(boards).cast(down).box);
}

TEST(SceneCastClosest, SaysTheBoxOfCastAndEnclosesItsParameter) {
  const Scene scene({cubeAt(20), cubeAt(10, 1), turnedCubeAt(10), cubeAt(-10)});
  const ClosestBox closest = scene.castClosest(kAlongX);
  const Hit hit = scene.cast(kAlongX);
  ASSERT_TRUE(closest.hit);
  EXPECT_EQ(hit.box, closest.box);
  EXPECT_LE(closest.t_lower, hit.t);
  EXPECT_GE(closest.t_upper, hit.t);
  EXPECT_LT(closest.t_upper - closest.t_lower, 1e-12);

  // The farthest range that is allowed is decided exactly: cubeAt(10, 1) is entered at x = 9.
  EXPECT_TRUE(scene.castClosest(Ray{{0, 0, 0}, {2, 0, 0}}, 9.0).hit);
  const ClosestBox none = scene.castClosest(Ray{{0, 0, 0}, {2, 0, 0}}, std::nextafter(9.0, 0.0));
  EXPECT_FALSE(none.hit);
  EXPECT_EQ(kNoBox, none.box);
  EXPECT_EQ(kInf, none.t_lower);
}

TEST(SceneFindAll, SortedByEntryThenIndex) {
  const Scene scene({cubeAt(20), cubeAt(10, 1), cubeAt(-10), turnedCubeAt(10), cubeAt(0, 9)});
  const auto line = scene.findAll(Line{kAlongX.origin, kAlongX.direction});
  ASSERT_EQ(line.size(), 4U);
  EXPECT_EQ(line[0].box, 2U);
  EXPECT_EQ(line[1].box, 1U);
  EXPECT_EQ(line[2].box, 3U);
  EXPECT_EQ(line[3].box, 0U);
  EXPECT_EQ(line[3].intersection.t_exit, 10.5);
  EXPECT_EQ(scene.findAll(kAlongX).size(), 3U);
  EXPECT_EQ(scene.findAll(Segment{{0, 0, 0}, {9, 0, 0}}).size(), 2U);
  BoxMask mask(5, false);
  mask.set(3, true);
  const auto masked = scene.findAll(kAlongX, &mask);
  ASSERT_EQ(masked.size(), 1U);
  EXPECT_EQ(masked[0].box, 3U);
}

TEST(BoxMask, LooksAtWhatItIsTold) {
  BoxMask mask(130);
  EXPECT_EQ(mask.size(), 130U);
  mask.set(64, false);
  EXPECT_TRUE(mask[63] && !mask[64] && mask[65] && mask[129]);
  BoxMask none(70, false);
  none.set(69, true);
  EXPECT_TRUE(!none[0] && none[69]);
}

TEST(SceneCast, BoxesBehindOneFrontTieToTheLowestIndex) {
  // Fronts at x = 2; what begins above y = 1 is entered later, through its side.
  std::vector<Box> boxes;
  for (int i = 0; i < 300; ++i) {
    const double low = i % 3 == 0 ? -1.0 : 1.0;
    boxes.emplace_back(AlignedBox{{2.0, low, -1.0}, {4.0 + (i * 7) % 11, 3.0, 1.0}});
  }
  std::rotate(boxes.begin(), boxes.begin() + 1, boxes.end());  // the first two begin above
  const Scene scene(boxes);
  for (const double slope : {0.25, 0.5, 0.75}) {
    const Hit hit = scene.cast(Ray{{0.0, 0.0, 0.0}, {1.0, slope, 0.0}});
    EXPECT_EQ(slope < 0.5 ? 2U : 0U, hit.box) << slope;
    EXPECT_EQ(2.0, hit.t);
  }
}

/// More boxes than a kernel keeps as candidates: it hands them over in portions.
constexpr std::size_t kMany = 3 * kernels::Found::kCapacity + 8;

TEST(SceneCast, MoreTiesThanAKernelKeepsGoToTheLowestIndex) {
  // One solid, many times over. Where it is entered no double says.
  const OrientedBox solid{{5, 0, 0}, Quaternion(0.9, 0.1, -0.2, 0.3), {1, 1, 1}};
  const Scene scene(std::vector<Box>(kMany, solid));
  const double range = Scene({solid}).cast(kAlongX).range;
  BoxMask mask(kMany);
  for (std::size_t first = 0; first < kMany; first += 10) {
    const Hit hit = scene.cast(kAlongX, kInf, &mask);
    EXPECT_EQ(first, hit.box);
    EXPECT_EQ(range, hit.range);
    EXPECT_EQ(first, scene.castClosest(kAlongX, kInf, &mask).box);
    EXPECT_TRUE(scene.castAny(kAlongX, std::nextafter(range, kInf), &mask));
    EXPECT_FALSE(scene.castAny(kAlongX, std::nextafter(range, 0.0), &mask));
    for (std::size_t i = first; i < first + 10; ++i) {
      mask.set(i, false);
    }
  }
  EXPECT_FALSE(scene.castAny(kAlongX, kInf, &mask));
}

TEST(SceneCast, MoreNearMissesThanAKernelKeepsAreDecided) {
  // Boards whose upper faces are 2.8e-17 below the ray.
  const double height = 0.1 + 0.2;  // rounded up
  std::vector<Box> boards;
  for (std::size_t i = 0; i < kMany; ++i) {
    const double turn = 0.01 * static_cast<double>(i + 1);
    boards.emplace_back(OrientedBox{
        {5.0, 0.0, 0.1}, Quaternion(std::cos(turn), 0, 0, std::sin(turn)), {1.0, 1.0, 0.2}});
  }
  const Ray over{{0.0, 0.0, height}, {1.0, 0.0, 0.0}};
  const Segment along{over.origin, {9.0, 0.0, height}};
  const Scene missed(boards);
  EXPECT_FALSE(missed.cast(over).hit);
  EXPECT_FALSE(missed.castClosest(over).hit);
  EXPECT_FALSE(missed.castAny(over));
  EXPECT_TRUE(missed.findAll(over).empty());
  EXPECT_TRUE(missed.isClear(along, 0.0));
  // And one that it touches, wherever it is among them.
  for (std::size_t i = 0; i < kMany; i += 40) {
    std::vector<Box> one_higher = boards;
    one_higher[i] = OrientedBox{{5.0, 0.0, 0.0}, Quaternion(2.0, 0, 0, 1.0), {1.0, 1.0, height}};
    const Scene touched(one_higher);
    EXPECT_EQ(i, touched.cast(over).box);
    EXPECT_EQ(i, touched.castClosest(over).box);
    EXPECT_TRUE(touched.castAny(over));
    EXPECT_EQ(1U, touched.findAll(over).size());
    EXPECT_FALSE(touched.isClear(along, 0.0));
  }
}

TEST(SceneCast, DirectionsOfAnySizeGoThroughTheTree) {
  reference::Sampler sampler(77);
  std::vector<Box> boxes;
  while (boxes.size() < 1000) {
    boxes.emplace_back(
        OrientedBox{sampler.vector(-20.0, 20.0), sampler.rotation(), sampler.vector(0.1, 1.5)});
  }
  const Scene scene(boxes);
  for (const int exponent : {-1000, -200, 200, 1000}) {
    std::size_t hits = 0;
    const QueryCounters before = queryCounters();
    for (int i = 0; i < 50; ++i) {
      const Ray ray{sampler.vector(-20.0, 20.0), sampler.direction()};
      const Ray scaled{ray.origin, std::ldexp(1.0, exponent) * ray.direction};
      const Hit hit = scene.cast(ray, 30.0);
      const Hit same = scene.cast(scaled, 30.0);
      ASSERT_EQ(hit.box, same.box);
      ASSERT_EQ(hit.range, same.range);
      ASSERT_EQ(hit.box, scene.castClosest(scaled, 30.0).box);
      ASSERT_EQ(hit.hit, scene.castAny(scaled, 30.0));
      ASSERT_EQ(scene.findAll(ray).size(), scene.findAll(scaled).size());
      ASSERT_EQ(scene.findAll(Line{ray.origin, ray.direction}).size(),
                scene.findAll(Line{scaled.origin, scaled.direction}).size());
      hits += hit.hit ? 1 : 0;
    }
    EXPECT_GT(hits, 10U);
    const QueryCounters work = queryCounters() - before;
    EXPECT_LT(work.exact_decisions, 50U * 200U) << "not all thousand boxes of any query";
  }
}

TEST(SceneCast, ADirectionThatCannotBeScaledExactlyIsStillRight) {
  // 2^900 and 2^-1000: near 1 the latter would be 0, and the ray not go up.
  const Ray ray{{0.0, 0.0, 0.0}, {std::ldexp(1.0, 900), 0.0, std::ldexp(1.0, -1000)}};
  const AlignedBox on{{1.0, -1.0, 0.0}, {2.0, 1.0, 0.0}};
  const AlignedBox above{{1.0, -1.0, std::ldexp(1.0, -1074)}, {2.0, 1.0, 1.0}};
  EXPECT_FALSE(Scene({on, above}).cast(ray).hit) << "2^-1900 above the one, below the other";
  EXPECT_FALSE(Scene({on, above}).castAny(ray));
  EXPECT_TRUE(Scene({AlignedBox{{1.0, -1.0, 0.0}, {2.0, 1.0, 1.0}}}).castAny(ray));
}

}  // namespace
}  // namespace box_query
