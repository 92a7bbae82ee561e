// SPDX-License-Identifier: BSD-3-Clause
// What the kernels say of many rays at once, in lists and down trees: compared with one exact query
// after the other.
#include "kernels/kernels.h"
#include "scene/box_tree.h"
#include "stress/kernel_scenes.h"
#include "stress/random.h"

#include <box_query/intersection.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace box_query::stress {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// What a kernel delivered for a ray.
struct Delivered {
  int times = 0;
  kernels::Answer answer = kernels::Answer::kUndecided;
  bool is_known = true;
  std::vector<std::uint32_t> boxes;
};

/// @param rays those of segments end at parameter 1
std::vector<Delivered> ask(kernels::Together together, const kernels::SceneView& view,
                           const std::vector<Ray>& rays, const std::vector<double>& ranges) {
  std::vector<Delivered> all(rays.size());
  kernels::Work work;
  together(
      view, {rays[0].origin.data(), rays.size(), ranges.data(), 1, nullptr, 0.0},
      [](void* context, std::size_t query, kernels::Answer answer, const kernels::Found* found) {
        Delivered& d = (*static_cast<std::vector<Delivered>*>(context))[query];
        ++d.times;
        d.answer = answer;
        d.is_known = found != nullptr;
        for (int i = 0; d.is_known && i < found->count; ++i) {
          d.boxes.push_back(found->candidates[i].box);
        }
      },
      &all, work);
  return all;
}

/// Where each box is entered; +inf where it is not.
std::vector<double> entriesOf(const Ray& ray, const std::vector<Box>& boxes) {
  std::vector<double> entries;
  for (const Box& any : boxes) {
    const Intersection i =
        std::visit([&](const auto& box) { return findIntersection(ray, box); }, any);
    entries.push_back(i.num_points > 0 ? i.t_enter : kInf);
  }
  return entries;
}

class KernelTogetherTest : public testing::TestWithParam<const kernels::Kernels*> {
 protected:
  /// How many rays meet anything.
  int check(const std::vector<Box>& boxes, const std::vector<Ray>& rays,
            const std::vector<double>& ranges) const {
    const BoxTree tree{SceneBoxes(boxes)};
    const kernels::SceneView view = tree.view();
    const std::vector<Delivered> closest = ask(GetParam()->closest_together, view, rays, ranges);
    const std::vector<Delivered> any = ask(GetParam()->any_together, view, rays, ranges);
    int met = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::vector<double> entries = entriesOf(rays[i], boxes);
      const double first = *std::min_element(entries.begin(), entries.end());
      // (What is not just at the limit.)
      const double range = first * rays[i].direction.norm();
      const bool is_met = range < ranges[i] * (1.0 - 1e-9);
      const bool is_not = !(range <= ranges[i] * (1.0 + 1e-9));
      EXPECT_LE(closest[i].times, 1);
      EXPECT_LE(any[i].times, 1);
      if (is_met) {
        ++met;
        EXPECT_EQ(closest[i].times, 1) << "ray " << i << " of " << boxes.size() << " boxes";
        EXPECT_EQ(any[i].times, 1) << "ray " << i << " of " << boxes.size() << " boxes";
        const auto& found = closest[i].boxes;
        EXPECT_TRUE(!closest[i].is_known ||
                    std::any_of(found.begin(), found.end(),
                                [&](std::uint32_t box) { return entries[box] == first; }))
            << "ray " << i << " of " << boxes.size() << " boxes";
      }
      if (is_not) {
        EXPECT_NE(any[i].answer, kernels::Answer::kYes) << "ray " << i;
      }
    }
    return met;
  }
};

TEST_P(KernelTogetherTest, MissesNothing) {
  for (const std::size_t count : {1, 2, 15, 16, 17, 33, 100, 128, 129, 1300, 5000}) {
    for (const std::size_t num_rays : {1, 15, 16, 17, 333}) {
      Random random(23, count, num_rays);
      const double spacing = count % 2 == 0 ? 4.0 : 8.0;
      const double side = spacing * std::cbrt(static_cast<double>(count));
      const std::vector<Box> boxes = scattered(random, count, spacing);
      std::vector<Ray> rays;
      std::vector<double> ranges;
      while (rays.size() < num_rays) {
        rays.push_back(rayAmong(random, side, boxes));
        ranges.push_back(random.chance(0.5) ? kInf : random.uniform(0.0, side));
      }
      const int met = check(boxes, rays, ranges);
      EXPECT_TRUE(num_rays < 333 || met > 60) << count << " boxes";
    }
  }
}

TEST_P(KernelTogetherTest, MissesNoFaceThatARayRunsIn) {
  // Rays along axes, in the planes of boxes that touch them from either side, from near and far.
  Random random(24, 0, 0);
  for (const std::size_t count : {8, 40}) {
    std::vector<Box> boxes;
    while (boxes.size() < count) {
      const Vector3 corner = random.uniformVector(-4.0, 4.0).array().round();
      boxes.emplace_back(AlignedBox{corner, corner + Vector3(1.0, 1.0, 1.0)});
    }
    std::vector<Ray> rays;
    for (int i = 0; i < 400; ++i) {
      Ray ray{random.uniformVector(-6.0, 6.0).array().round(), Vector3::Zero()};
      const int axis = random.below(3);
      ray.direction[axis] = random.signedMagnitude(-18, 18);
      ray.direction[(axis + 1) % 3] = random.chance(0.5) ? -0.0 : random.signedMagnitude(-180, -70);
      if (random.chance(0.3)) {
        ray.origin[axis] = random.signedMagnitude(20, 36);
      }
      rays.push_back(ray);
    }
    EXPECT_GT(check(boxes, rays, std::vector<double>(rays.size(), kInf)), 20);
  }
}

TEST_P(KernelTogetherTest, LeavesOpenWhatItCannotTake) {
  Random random(25, 0, 0);
  for (const std::size_t count : {8, 100, 400}) {
    const std::vector<Box> boxes = scattered(random, count, 4.0);
    const Vector3 at = pointOf(boxes[0]);
    const Vector3 x = Vector3::UnitX();
    std::vector<Ray> rays(16, Ray{at - x, x});
    rays[3] = {at - 0x1p200 * x, x};           // too far away
    rays[7] = {at - x, 0x1p-300 * x};          // hardly goes
    rays[11] = {at - x, 0x1p300 * x};          // goes too far
    rays[13] = {at - 0x1p42 * x, 0x1p30 * x};  // beyond what rays in lanes may have
    const BoxTree tree{SceneBoxes(boxes)};
    const std::vector<Delivered> closest =
        ask(GetParam()->closest_together, tree.view(), rays, std::vector<double>(16, kInf));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(closest[i].times, 1) << i;
      EXPECT_EQ(closest[i].is_known, i != 3 && i != 7 && i != 11) << i;
    }
  }
}

TEST_P(KernelTogetherTest, SegmentsEndWhereTheyDo) {
  for (const std::size_t count : {1, 16, 33, 128, 129, 1300, 5000}) {
    Random random(26, count, 0);
    const double side = 6.0 * std::cbrt(static_cast<double>(count));
    const std::vector<Box> boxes = scattered(random, count, 6.0);
    std::vector<Ray> parts;
    std::vector<Ray> numbers;  // start and end of each
    while (parts.size() < 333) {
      Ray part = rayAmong(random, side, boxes);
      part.direction *= random.uniform(0.0, side) / part.direction.norm();
      parts.push_back(part);
      numbers.push_back({part.origin, part.origin + part.direction});
    }
    const BoxTree tree{SceneBoxes(boxes)};
    const std::vector<Delivered> any = ask(GetParam()->any_of_segments_together, tree.view(),
                                           numbers, std::vector<double>(parts.size(), kInf));
    int met = 0;
    int ends_before = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::vector<double> entries = entriesOf(parts[i], boxes);
      const double first = *std::min_element(entries.begin(), entries.end());
      EXPECT_LE(any[i].times, 1);
      if (first < 1.0 - 1e-9) {
        ++met;
        EXPECT_EQ(any[i].times, 1) << "segment " << i << " of " << count << " boxes";
      } else if (first > 1.0 + 1e-9) {
        ends_before += first < kInf ? 1 : 0;
        EXPECT_NE(any[i].answer, kernels::Answer::kYes) << "segment " << i;
      }
    }
    EXPECT_TRUE(count == 1 || (met > 40 && ends_before > 20)) << met << ", " << ends_before;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, KernelTogetherTest, testing::ValuesIn(allKernels()), nameOf);

}  // namespace
}  // namespace box_query::stress
