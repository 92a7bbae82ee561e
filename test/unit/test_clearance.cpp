// SPDX-License-Identifier: BSD-3-Clause
#include <box_query/distance.h>
#include <box_query/scene.h>

#include <cfenv>
#include <cmath>
#include <limits>
#include <random>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace box_query {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

AlignedBox cubeAt(double x, double y, double z) {
  return {Vector3(x - 1.0, y - 1.0, z - 1.0), Vector3(x + 1.0, y + 1.0, z + 1.0)};
}

OrientedBox turned(const AlignedBox& box, const Quaternion& q) {
  return {(box.min + box.max) / 2.0, q, (box.max - box.min) / 2.0};
}

const Segment kPath{{-8.0, 0.0, 0.0}, {8.0, 0.0, 0.0}};

TEST(SceneClearance, NothingIsInTheWayOfAnEmptyScene) {
  for (const Scene& scene : {Scene(), Scene({cubeAt(0, 0, 0)})}) {
    const BoxMask none(scene.size(), false);
    EXPECT_TRUE(scene.isClear(kPath, 1e300, &none));
    const Clearance clearance = scene.clearance(kPath, &none);
    EXPECT_EQ(clearance.box, kNoBox);
    EXPECT_EQ(clearance.distance, kInf);
    EXPECT_TRUE(std::isnan(clearance.t));
    const Blockage blockage = scene.firstBlockage(kPath, 1e300, &none);
    EXPECT_FALSE(blockage.blocked);
    EXPECT_EQ(blockage.box, kNoBox);
    EXPECT_EQ(blockage.blocked_at, kInf);
  }
}

TEST(SceneClearance, TheNearestBoxNeedNotBeTheFirstThatBlocks) {
  const Scene scene({cubeAt(4, 2, 0), cubeAt(-4, 3, 0)});
  const Clearance clearance = scene.clearance(kPath);
  EXPECT_EQ(clearance.box, 0U);
  EXPECT_EQ(clearance.distance, 1.0);
  EXPECT_EQ(clearance.t, 11.0 / 16.0);
  EXPECT_EQ(clearance.on_segment, Vector3(3, 0, 0));
  EXPECT_EQ(clearance.on_box, Vector3(3, 1, 0));
  const Blockage blockage = scene.firstBlockage(kPath, 2.0);
  EXPECT_TRUE(blockage.blocked);
  EXPECT_EQ(blockage.box, 1U);
  EXPECT_EQ(blockage.blocked_at, 3.0 / 16.0);
  EXPECT_EQ(scene.firstBlockage(kPath, 1.5).box, 0U);
  EXPECT_FALSE(scene.isClear(kPath, 1.0));
  EXPECT_TRUE(scene.isClear(kPath, std::nextafter(1.0, 0.0)));
}

TEST(SceneClearance, TiesGoToTheLowestIndex) {
  // The same solid as an aligned box and twice as an oriented one, and its mirror image.
  const AlignedBox cube = cubeAt(0, 3, 0);
  const std::vector<Box> same{cube, turned(cube, Quaternion(0.5, 0.5, 0.5, 0.5)),
                              turned(cube, Quaternion(3.0, 0.0, 0.0, 0.0)), cubeAt(0, -3, 0)};
  for (std::size_t first = 0; first < same.size(); ++first) {
    std::vector<Box> boxes{cubeAt(0, 30, 0)};
    boxes.insert(boxes.end(), same.begin() + static_cast<std::ptrdiff_t>(first), same.end());
    boxes.insert(boxes.end(), same.begin(), same.end());
    const Scene scene(boxes);
    EXPECT_EQ(scene.clearance(kPath).box, 1U);
    EXPECT_EQ(scene.clearance(kPath).distance, 2.0);
    EXPECT_EQ(scene.firstBlockage(kPath, 3.0).box, 1U);
    BoxMask mask(scene.size());
    mask.set(1, false);
    EXPECT_EQ(scene.clearance(kPath, &mask).box, 2U);
    EXPECT_EQ(scene.firstBlockage(kPath, 3.0, &mask).box, 2U);
  }
}

TEST(SceneClearance, WhatRoundsEquallyIsStillOrdered) {
  // One box a hair closer than a double can say at this distance, after one that is not.
  const Segment point{{0.0, 0.0, 1e9}, {0.0, 0.0, 1e9}};
  const double hair = 1e-300;
  const AlignedBox lower{{-1.0, -1.0, -1.0}, {1.0, 1.0, 0.0}};
  const AlignedBox higher{{-1.0, -1.0, -1.0}, {1.0, 1.0, hair}};
  const Scene scene({lower, higher, higher});
  EXPECT_EQ(distance(point, lower).distance, distance(point, higher).distance);
  EXPECT_EQ(scene.clearance(point).box, 1U);

  const Segment down{{0.0, 0.0, 9.0}, {0.0, 0.0, -9.0}};
  EXPECT_EQ(blockedAt(down, lower, 1.0), blockedAt(down, higher, 1.0));
  EXPECT_EQ(scene.firstBlockage(down, 1.0).box, 1U);
  EXPECT_EQ(scene.firstBlockage(down, 0.0).box, 1U);

  // The same at an edge, where both parameters are roots of quadratics.
  const Segment slanted{{2.0, 0.0, 9.0}, {1.5, 0.25, -9.0}};
  EXPECT_EQ(blockedAt(slanted, lower, 1.0), blockedAt(slanted, higher, 1.0));
  EXPECT_EQ(scene.firstBlockage(slanted, 1.0).box, 1U);
}

TEST(SceneClearance, APathOverAShelfTiesWithAllThatItPasses) {
  // Tops at a height whose square no double holds, so that only exact numbers see the tie.
  const double top = 0.7;
  const double path = 1.1;
  std::vector<Box> shelf;
  for (int i = 0; i < 20; ++i) {
    shelf.emplace_back(AlignedBox{{0.3 * i, -0.2, 0.1}, {0.3 * i + 0.2, 0.2, top}});
  }
  const Segment over{{-1.0, 0.1, path}, {9.0, 0.1, path}};
  const Segment back{over.end, over.start};
  for (const Segment& segment : {over, back}) {
    const Clearance clearance = Scene(shelf).clearance(segment);
    EXPECT_EQ(clearance.box, 0U);
    EXPECT_EQ(clearance.distance, path - top);
    EXPECT_EQ(clearance.on_box[2], top);
  }
  EXPECT_EQ(Scene(shelf).firstBlockage(over, 0.5).box, 0U);
  EXPECT_EQ(Scene(shelf).firstBlockage(back, 0.5).box, 19U);
}

TEST(SceneClearance, BoxesThatBlockTheStartTieWhereverThePathLeads) {
  // The path keeps its distance from the first box and leaves the second one; the radius is the
  // next double after the distance from both, so that no filter is sure of either.
  const Scene scene({AlignedBox{{-2.5, -1.0, -0.5}, {-1.5, 0.0, 1.5}},
                     AlignedBox{{1.0, -2.5, 2.0}, {2.0, -2.5, 3.0}}});
  const Segment path{{-1.5, -3.5, 2.5}, {-2.5, -3.5, 2.5}};
  const Blockage blockage = scene.firstBlockage(path, std::nextafter(std::sqrt(7.25), 3.0));
  EXPECT_EQ(blockage.box, 0U);
  EXPECT_EQ(blockage.blocked_at, 0.0);
}

TEST(SceneClearance, AgreesWithEveryBoxAlone) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&](double scale) {
    return Vector3(scale * unit(engine), scale * unit(engine), scale * unit(engine));
  };
  std::vector<Box> boxes;
  for (int i = 0; i < 60; ++i) {
    const Vector3 center = vector(10.0);
    const Vector3 half = vector(1.0).cwiseAbs();
    if (i % 3 == 0) {
      boxes.emplace_back(AlignedBox{center - half, center + half});
    } else {
      OrientedBox box{center, Quaternion(), half};
      box.orientation.coeffs() << vector(1.0), unit(engine);
      boxes.emplace_back(box);
    }
  }
  const Scene scene(boxes);
  int clear = 0;
  int blocked_later = 0;
  for (int k = 0; k < 200; ++k) {
    const Segment segment{vector(10.0), vector(10.0)};
    const double radius = k % 4 == 0 ? 0.0 : std::abs(unit(engine));
    BoxMask mask(scene.size());
    for (std::size_t i = 0; i < scene.size(); ++i) {
      mask.set(i, unit(engine) > -0.5);
    }
    double distance_of_nearest = kInf;
    double first_blocked_at = kInf;
    bool is_clear = true;
    for (std::size_t i = 0; i < scene.size(); ++i) {
      if (mask[i]) {
        std::visit(
            [&](const auto& box) {
              distance_of_nearest = std::fmin(distance_of_nearest, distance(segment, box).distance);
              first_blocked_at = std::fmin(first_blocked_at, blockedAt(segment, box, radius));
              is_clear = is_clear && isClear(segment, box, radius);
            },
            boxes[i]);
      }
    }
    const Clearance clearance = scene.clearance(segment, &mask);
    ASSERT_TRUE(mask[clearance.box]);
    ASSERT_EQ(clearance.distance, distance_of_nearest);
    const SegmentDistance alone =
        std::visit([&](const auto& box) { return distance(segment, box); }, boxes[clearance.box]);
    ASSERT_EQ(clearance.distance, alone.distance);
    ASSERT_EQ(clearance.t, alone.t);
    ASSERT_EQ(clearance.on_segment, alone.on_segment);
    ASSERT_EQ(clearance.on_box, alone.on_box);
    ASSERT_EQ(scene.isClear(segment, radius, &mask), is_clear);
    const Blockage blockage = scene.firstBlockage(segment, radius, &mask);
    ASSERT_EQ(blockage.blocked, !is_clear);
    ASSERT_EQ(blockage.blocked_at, first_blocked_at);
    clear += is_clear ? 1 : 0;
    blocked_later += blockage.blocked && blockage.blocked_at > 0.0 ? 1 : 0;
  }
  EXPECT_GT(clear, 20);
  EXPECT_GT(blocked_later, 20);
}

TEST(SceneClearance, APathAmongManyBoxesIsNotClearHoweverItsThreadRounds) {
  std::vector<Box> boxes;
  for (int i = 0; i < 3000; ++i) {
    boxes.emplace_back(cubeAt(4.0 * (i % 50), 4.0 * (i / 50), 0.0));
  }
  const Scene scene(boxes);
  for (const int mode : {FE_TONEAREST, FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    int clear = 0;
    for (const double x : {40.0, 80.0}) {
      for (const double z : {-8.0, 8.0}) {  // up and down
        clear += scene.isClear({{x, 40.0, z}, {x + 0.5, 40.5, -z}}, 0.0) ? 1 : 0;
      }
    }
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(clear, 0) << "rounding mode " << mode;
  }
}

}  // namespace
}  // namespace box_query
