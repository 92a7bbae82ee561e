// SPDX-License-Identifier: BSD-3-Clause
// What the kernels say of segments and a radius, alone and together: compared with the exact answer
// of one box after the other, also where a box is just within the radius, or just not.
#include "kernels/kernels.h"
#include "scene/box_tree.h"
#include "scene/candidates.h"
#include "stress/kernel_scenes.h"
#include "stress/random.h"

#include <box_query/distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace box_query::stress {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

bool isWithin(const Segment& segment, const std::vector<Box>& boxes, double radius) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const Box& any) {
    return !std::visit([&](const auto& box) { return isClear(segment, box, radius); }, any);
  });
}

double nearestDistance(const Segment& segment, const std::vector<Box>& boxes) {
  double nearest = kInf;
  for (const Box& any : boxes) {
    nearest = std::min(
        nearest, std::visit([&](const auto& box) { return distance(segment, box).distance; }, any));
  }
  return nearest;
}

/// How often a kernel says that a box is within, that none is, and that it cannot tell.
struct Said {
  int yes = 0;
  int none = 0;
  int open = 0;
};

class KernelWithinTest : public testing::TestWithParam<const kernels::Kernels*> {
 protected:
  void check(const std::vector<Box>& boxes, const std::vector<Segment>& segments, double radius,
             Said& said) const {
    const BoxTree tree{SceneBoxes(boxes)};
    const kernels::SceneView view = tree.view();
    kernels::Work work;
    const std::vector<kernels::Answer> alone = askAlone(view, segments, radius, work);
    const std::vector<kernels::Answer> together = askTogether(view, segments, radius, work);
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const bool is_within = isWithin(segments[i], boxes, radius);
      for (const kernels::Answer answer : {alone[i], together[i]}) {
        EXPECT_NE(answer, is_within ? kernels::Answer::kNone : kernels::Answer::kYes)
            << "segment " << i << " of " << boxes.size() << " boxes, radius " << radius;
        said.yes += answer == kernels::Answer::kYes ? 1 : 0;
        said.none += answer == kernels::Answer::kNone ? 1 : 0;
        said.open += answer == kernels::Answer::kNotTaken ? 1 : 0;
      }
    }
  }

  static std::vector<kernels::Answer> askAlone(const kernels::SceneView& view,
                                               const std::vector<Segment>& segments, double radius,
                                               kernels::Work& work) {
    std::vector<kernels::Answer> answers;
    for (const Segment& segment : segments) {
      kernels::Found found(&work);
      answers.push_back(
          GetParam()->any_within(view, rayQuery(segment, kInf, nullptr, radius), found));
    }
    return answers;
  }

  static std::vector<kernels::Answer> askTogether(const kernels::SceneView& view,
                                                  const std::vector<Segment>& segments,
                                                  double radius, kernels::Work& work) {
    std::vector<kernels::Answer> answers(segments.size(), kernels::Answer::kNone);
    GetParam()->any_within_together(
        view, {segments[0].start.data(), segments.size(), &kInf, 0, nullptr, radius},
        [](void* context, std::size_t query, kernels::Answer answer, const kernels::Found*) {
          auto& all = *static_cast<std::vector<kernels::Answer>*>(context);
          EXPECT_EQ(all[query], kernels::Answer::kNone) << "delivered twice";
          all[query] = answer;
        },
        &answers, work);
    return answers;
  }
};

std::vector<Segment> segmentsAmong(Random& random, double side, const std::vector<Box>& boxes,
                                   std::size_t count) {
  std::vector<Segment> segments;
  while (segments.size() < count) {
    Ray ray = rayAmong(random, side, boxes);
    ray.direction *= random.uniform(0.0, 0.5 * side) / ray.direction.norm();
    segments.push_back({ray.origin, ray.origin + ray.direction});
  }
  return segments;
}

TEST_P(KernelWithinTest, SaysWhatIsExactlySo) {
  // In blocks, in lists, down trees; some in heaps.
  for (const std::size_t count : {1, 8, 16, 33, 64, 128, 300, 1024, 1300, 5000}) {
    for (const double spacing : {0.4, 6.0}) {
      Random random(31, count, spacing < 1.0 ? 0 : 1);
      const double side = spacing * std::cbrt(static_cast<double>(count));
      const std::vector<Box> boxes = scattered(random, count, spacing);
      Said said;
      const auto segments = segmentsAmong(random, side, boxes, count > 1000 ? 20 : 60);
      for (const double radius : {1e-6, 0.3, 2.0}) {
        check(boxes, segments, radius, said);
      }
      // (Among crowded boxes of which many are near, and few within.)
      EXPECT_LT(said.open, spacing < 1.0 ? said.yes : 5) << count;
      EXPECT_GT(said.yes, 0) << count;
      EXPECT_TRUE(said.none > 0 || spacing < 1.0) << count;
    }
  }
}

TEST_P(KernelWithinTest, SaysNothingWrongWhereABoxIsJustWithinOrNot) {
  Random random(32, 0, 0);
  Said said;
  for (int scene = 0; scene < 600; ++scene) {
    const std::size_t count = scene % 3 == 0 ? 200 : scene % 3 == 1 ? 40 : 7;
    // (Crowded boxes, through which a segment goes a stretch at a time.)
    const double spacing = scene % 2 == 0 ? 1.5 : 5.0;
    const std::vector<Box> boxes = scattered(random, count, spacing);
    const double side = spacing * std::cbrt(static_cast<double>(count));
    const Vector3 outside = random.uniformVector(0.0, side) - Vector3(side, side, side);
    std::vector<Segment> segments = segmentsAmong(random, side, boxes, 1);
    segments.push_back({outside, outside + random.uniformVector(-0.5, 2.0) * side});
    for (const Segment& segment : {segments[0], segments[1]}) {
      const double nearest = nearestDistance(segment, boxes);
      for (const double radius :
           {nearest, std::nextafter(nearest, 0.0), std::nextafter(nearest, kInf)}) {
        if (radius > 0.0) {
          check(boxes, segments, radius, said);
        }
      }
    }
  }
  EXPECT_GT(said.open, 300);  // left to exact numbers
}

TEST_P(KernelWithinTest, LeavesOpenWhatIsFarAwayOrHasNoLength) {
  Random random(33, 0, 0);
  const Vector3 x = Vector3::UnitX();
  for (const std::size_t count : {8, 100, 400}) {
    const std::vector<Box> boxes = scattered(random, count, 4.0);
    const Vector3 at = pointOf(boxes[0]);
    const std::vector<Segment> segments = {{at, at},                // a point
                                           {at, at + 0x1p-40 * x},  // hardly longer
                                           {at - 0x1p60 * x, at},   // begins far away
                                           {at, at + 0x1p30 * x}};  // goes far
    Said said;
    check(boxes, segments, 0.25, said);
    EXPECT_EQ(said.open, 2 * static_cast<int>(segments.size())) << count;
  }
}

TEST_P(KernelWithinTest, LeavesOpenWhatManyBoundsAreNearAndNoBox) {
  Random random(34, 0, 0);
  for (const std::size_t count : {8, 100, 400, 20000}) {
    std::vector<Box> boxes;
    while (boxes.size() < count) {
      const Vector3 min = random.uniformVector(0.0, 1.0);
      boxes.emplace_back(AlignedBox{min, min + Vector3::Constant(0.02)});
    }
    const Vector3 corner = Vector3::Constant(-8.0);  // 13.9 away, at most 9 along each axis
    const std::vector<Segment> segments(16, {corner, corner + 0.1 * Vector3::UnitX()});
    const BoxTree tree{SceneBoxes(boxes)};
    for (const bool is_alone : {true, false}) {
      kernels::Work work;
      const std::vector<kernels::Answer> answers =
          is_alone ? askAlone(tree.view(), segments, 10.0, work)
                   : askTogether(tree.view(), segments, 10.0, work);
      for (const kernels::Answer answer : answers) {
        EXPECT_EQ(answer, kernels::Answer::kNotTaken) << count;
      }
      EXPECT_LE(work.boxes, 8 * segments.size()) << count;
      EXPECT_LE(work.nodes, 500 * segments.size()) << count;
    }
  }
}

TEST(Kernels, AreAskedAboutRadiiThatReachFewOfManyBoxes) {
  Random random(35, 0, 0);
  const auto mostRadius = [](const std::vector<Box>& boxes) {
    return BoxTree{SceneBoxes(boxes)}.view().most_radius;
  };
  EXPECT_EQ(mostRadius(scattered(random, 4, 6.0)), kernels::kLargestRadius);
  for (const std::size_t count : {64, 1000}) {
    for (const double spacing : {1.0, 6.0}) {
      const double most = mostRadius(scattered(random, count, spacing));
      EXPECT_GT(most, 0.4 * spacing) << count;
      EXPECT_LT(most, 3.0 * spacing) << count;
    }
  }
  const Vector3 at(1.0, 2.0, 3.0);
  EXPECT_LT(mostRadius(std::vector<Box>(5, AlignedBox{at, at})), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Each, KernelWithinTest, testing::ValuesIn(allKernels()), nameOf);

}  // namespace
}  // namespace box_query::stress
