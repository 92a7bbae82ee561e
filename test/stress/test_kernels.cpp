// SPDX-License-Identifier: BSD-3-Clause
// What the kernels say is certain, on every instruction set that the CPU has, down trees of every
// depth: compared with one exact query after the other.
#include "kernels/kernels.h"
#include "scene/box_tree.h"
#include "scene/candidates.h"
#include "stress/kernel_scenes.h"
#include "stress/random.h"
#include "stress/scene_families.h"

#include <box_query/intersection.h>
#include <box_query/scene.h>

#include <algorithm>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace box_query::stress {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// A tree over boxes, and what one kernel says of them.
class Asked {
 public:
  Asked(const std::vector<Box>& boxes, const kernels::Kernels& kernels)
      : tree_(SceneBoxes(boxes)), view_(tree_.view()), kernels_(kernels) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      in_tree_.push_back(!std::binary_search(tree_.left_out().begin(), tree_.left_out().end(), i));
    }
  }

  /// Whether the kernel takes a component: at least all that are moderate and near.
  template <typename T>
  bool takes(const T& linear) const {
    const DoubleComponent c = doubleComponent(linear);
    bool must = c.moderate;
    for (int i = 0; i < 3; ++i) {
      must = must && std::fabs(c.origin[i] - view_.center[i]) <= kernels::kFarthestOrigin;
    }
    std::set<std::size_t> boxes;
    const bool taken = ask(kernels_.all, linear, nullptr, boxes) != kernels::Answer::kNotTaken;
    EXPECT_TRUE(taken || !must);
    return taken;
  }
  bool isInTree(std::size_t box) const { return in_tree_[box]; }

  template <typename T>
  std::set<std::size_t> all(const T& linear, const BoxMask* mask = nullptr) const {
    std::set<std::size_t> boxes;
    ask(kernels_.all, linear, mask, boxes);
    return boxes;
  }

  /// The candidates for the first box, whatever the caller would do with those taken on the way.
  template <typename T>
  std::set<std::size_t> closest(const T& linear) const {
    std::set<std::size_t> boxes;
    const kernels::Answer answer = ask(kernels_.closest, linear, nullptr, boxes);
    EXPECT_EQ(boxes.empty(), answer != kernels::Answer::kUndecided);
    return boxes;
  }

  template <typename T>
  bool any(const T& linear, std::set<std::size_t>& undecided) const {
    const kernels::Answer answer = ask(kernels_.any, linear, nullptr, undecided);
    EXPECT_TRUE(answer != kernels::Answer::kNone || undecided.empty());
    return answer == kernels::Answer::kYes;
  }

 private:
  using Query = kernels::Answer (*)(const kernels::SceneView&, const kernels::RayQuery&,
                                    kernels::Found&);

  template <typename T>
  kernels::Answer ask(Query query, const T& linear, const BoxMask* mask,
                      std::set<std::size_t>& boxes) const {
    kernels::Work work;
    kernels::Found found(&work, addTo, &boxes);
    const kernels::Answer answer = query(view_, rayQuery(linear, kInf, mask), found);
    addTo(&boxes, found);
    return answer;
  }

  static double addTo(void* context, const kernels::Found& found) {
    for (int i = 0; i < found.count; ++i) {
      static_cast<std::set<std::size_t>*>(context)->insert(found.candidates[i].box);
    }
    return kInf;
  }

  BoxTree tree_;
  kernels::SceneView view_;
  const kernels::Kernels& kernels_;
  std::vector<bool> in_tree_;
};

/// How many queries met anything.
template <typename T>
int check(const Asked& asked, const std::vector<Box>& boxes, const T& linear) {
  if (!asked.takes(linear)) {
    return 0;
  }
  const std::set<std::size_t> all = asked.all(linear);
  const std::set<std::size_t> closest = asked.closest(linear);
  std::set<std::size_t> undecided;
  const bool any = asked.any(linear, undecided);

  bool any_met = false;
  bool any_undecided = false;
  double earliest = kInf;
  double earliest_kept = kInf;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!asked.isInTree(i)) {
      continue;
    }
    const Intersection truth =
        std::visit([&](const auto& box) { return findIntersection(linear, box); }, boxes[i]);
    if (truth.num_points > 0) {
      EXPECT_EQ(1U, all.count(i)) << "box " << i << " of " << boxes.size();
      any_met = true;
      any_undecided = any_undecided || undecided.count(i) != 0;
      earliest = std::min(earliest, truth.t_enter);
      if (closest.count(i) != 0) {
        earliest_kept = std::min(earliest_kept, truth.t_enter);
      }
    }
  }
  EXPECT_EQ(earliest, earliest_kept) << "of " << boxes.size() << " boxes";
  EXPECT_EQ(any_met, any || any_undecided) << "of " << boxes.size() << " boxes";
  return any_met ? 1 : 0;
}

class KernelTest : public testing::TestWithParam<const kernels::Kernels*> {};

TEST_P(KernelTest, MissNothingInHostileScenes) {
  int asked = 0;
  int met = 0;
  for (std::size_t family = 0; family < sceneFamilyNames().size(); ++family) {
    for (std::uint64_t index = 0; index < 60; ++index) {
      const SceneSample scene = makeScene(family, 11, index);
      const Asked kernel(scene.boxes, *GetParam());
      for (const Sample& s : scene.components) {
        met += check(kernel, scene.boxes, s.ray());
        met += check(kernel, scene.boxes, s.segment());
        asked += 2;
      }
    }
  }
  EXPECT_GT(met, asked / 4);
}

TEST_P(KernelTest, MissNothingAtAnyDepth) {
  for (const std::size_t count : {1, 2, 15, 16, 17, 128, 129, 600, 1300, 12000}) {
    Random random(17, count, 0);
    const double spacing = count % 2 == 0 ? 4.0 : 8.0;
    const std::vector<Box> boxes = scattered(random, count, spacing);
    const double side = spacing * std::cbrt(static_cast<double>(count));
    const Asked kernel(boxes, *GetParam());
    int met = 0;
    const int rays = count > 2000 ? 100 : 400;
    for (int i = 0; i < rays; ++i) {
      const Ray ray = rayAmong(random, side, boxes);
      met += check(kernel, boxes, ray);
      met += check(kernel, boxes, Segment{ray.origin, ray.origin + side * ray.direction});
    }
    EXPECT_GT(met, rays / 4) << count << " boxes";
  }
}

TEST_P(KernelTest, MissNothingInHeaps) {
  // Where some kernels compare boxes themselves: to the last in a word, a block, and beyond.
  for (const std::size_t count : {33, 48, 49, 64, 65, 127, 128, 129, 320, 1023, 1024, 1025}) {
    Random random(28, count, 0);
    for (const double spacing : {0.3, 3.0}) {
      const std::vector<Box> boxes = scattered(random, count, spacing);
      const double side = spacing * std::cbrt(static_cast<double>(count));
      const Asked kernel(boxes, *GetParam());
      int met = 0;
      constexpr int kRays = 60;
      for (int i = 0; i < kRays; ++i) {
        const Ray ray = rayAmong(random, 3.0 * side, boxes);
        met += check(kernel, boxes, ray);
        met += check(kernel, boxes, Segment{ray.origin, ray.origin + side * ray.direction});
      }
      EXPECT_GT(met, kRays / 4) << count << " boxes";
    }
  }
}

TEST_P(KernelTest, MissNothingFarFromTheOriginOrAtAnyScale) {
  Random random(18, 0, 0);
  for (const double scale : {0x1p-80, 0x1p-40, 1.0, 0x1p30, 0x1p50}) {
    for (const double offset : {0.0, 1e6}) {
      const std::vector<Box> plain = scattered(random, 300, 4.0);
      std::vector<Box> boxes = plain;
      const double side = 4.0 * std::cbrt(300.0);
      for (Box& any : boxes) {
        if (auto* box = std::get_if<AlignedBox>(&any)) {
          *box = {scale * (box->min.array() + offset), scale * (box->max.array() + offset)};
        } else {
          auto& oriented = std::get<OrientedBox>(any);
          oriented.center = scale * (oriented.center.array() + offset);
          oriented.half_extents *= scale;
        }
      }
      const Asked kernel(boxes, *GetParam());
      int met = 0;
      for (int i = 0; i < 200; ++i) {
        Ray ray = rayAmong(random, side, plain);
        ray.origin = scale * (ray.origin.array() + offset);
        met += check(kernel, boxes, ray);
      }
      EXPECT_GT(met, 30) << scale << " " << offset;
    }
  }
}

TEST_P(KernelTest, ABoxFarAwayCostsTheOthersNoPrecision) {
  Random random(19, 0, 0);
  std::vector<Box> boxes = scattered(random, 200, 6.0);
  boxes.emplace_back(AlignedBox{{1e12, 1e12, 1e12}, {2e12, 2e12, 2e12}});
  boxes.emplace_back(AlignedBox{{0x1p90, 0.0, 0.0}, {0x1p91, 1.0, 1.0}});  // out of range
  const Asked kernel(boxes, *GetParam());
  EXPECT_FALSE(kernel.isInTree(201));
  std::size_t candidates = 0;
  int met = 0;
  for (int i = 0; i < 200; ++i) {
    const Ray ray = rayAmong(random, 35.0, boxes);
    candidates += kernel.all(ray).size();
    met += check(kernel, boxes, ray);
  }
  EXPECT_GT(met, 50);
  EXPECT_LT(candidates, 200U * 20U);
}

TEST_P(KernelTest, LookOnlyWhereTheMaskSays) {
  Random random(20, 0, 0);
  const std::vector<Box> boxes = scattered(random, 500, 3.0);
  const Asked kernel(boxes, *GetParam());
  std::size_t seen = 0;
  for (int i = 0; i < 100; ++i) {
    const Ray ray = rayAmong(random, 24.0, boxes);
    BoxMask mask(boxes.size());
    for (const std::size_t box : kernel.all(ray)) {
      mask.set(box, random.chance(0.5));
    }
    for (const std::size_t box : kernel.all(ray)) {
      EXPECT_EQ(mask[box] ? 1U : 0U, kernel.all(ray, &mask).count(box));
      ++seen;
    }
  }
  EXPECT_GT(seen, 100U);
}

INSTANTIATE_TEST_SUITE_P(Every, KernelTest, testing::ValuesIn(allKernels()), nameOf);

TEST(Kernels, AreChosenByName) {
  EXPECT_EQ(&kernels::kPortable, kernels::byName("portable"));
  EXPECT_EQ(nullptr, kernels::byName("mmx"));
  EXPECT_NE(nullptr, kernels::active().name);
}

}  // namespace
}  // namespace box_query::stress
