// SPDX-License-Identifier: BSD-3-Clause
// That the kernels offer every box that may be the nearest to a segment, or near enough.
#include "kernels/kernels.h"
#include "scene/box_tree.h"
#include "scene/search.h"
#include "stress/kernel_scenes.h"
#include "stress/random.h"
#include "stress/scene_families.h"

#include <box_query/distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace box_query::stress {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

class NearestKernelTest : public testing::TestWithParam<const kernels::Kernels*> {};

double distanceTo(const Segment& segment, const Box& any) {
  return std::visit([&](const auto& box) { return distance(segment, box).distance; }, any);
}

/// Whether what is said of a segment that meets its nearest box holds.
void expectStart(const kernels::NearestOne& one, const Segment& segment, const Box& any) {
  const SegmentDistance d =
      std::visit([&](const auto& box) { return distance(segment, box); }, any);
  EXPECT_TRUE(one.isApart() || d.distance == 0.0);
  EXPECT_TRUE(one.start != kernels::NearestOne::Start::kInside || d.t == 0.0);
}

struct Counts {
  int met_ones = 0;
  int met = 0;    ///< boxes that segments certainly meet
  int apart = 0;  ///< segments that are nearest to a box at some distance
  int ones = 0;   ///< segments for which floats say to which box
  std::size_t offered = 0;
  std::size_t close = 0;  ///< of the boxes offered, those whose bounds tell something
};

void checkNearest(const kernels::Kernels& kernels, const std::vector<Box>& boxes,
                  const Segment& segment, Counts& counts) {
  const BoxTree tree{SceneBoxes(boxes)};
  const kernels::SceneView view = tree.view();
  if (!isForKernels(segment, view)) {
    return;
  }
  struct Search {
    const std::vector<Box>& boxes;
    const Segment& segment;
    bool shrinks;
    double bound;
    std::set<std::size_t> offered;
    std::size_t close;  ///< of these, those whose bounds tell something
    int met = 0;        ///< those that are certainly met
  };
  const auto offer = [](void* context, std::uint32_t box, const kernels::NearBox& near) {
    auto& search = *static_cast<Search*>(context);
    search.offered.insert(box);
    const double distance = distanceTo(search.segment, search.boxes[box]);
    EXPECT_LE(near.lower, distance);
    EXPECT_GE(near.upper, distance);
    search.met += near.upper == 0.0 ? 1 : 0;
    search.close += near.upper - near.lower <= 1e-9 * near.scale ? 1U : 0U;
    if (search.shrinks) {
      search.bound = std::min(search.bound, distance);
    }
    return search.bound;
  };
  std::vector<double> truth;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const bool left_out = std::binary_search(tree.left_out().begin(), tree.left_out().end(), i);
    truth.push_back(left_out ? kInf : distanceTo(segment, boxes[i]));
  }
  const double least = *std::min_element(truth.begin(), truth.end());
  const auto querySegment = [&](double bound, bool shrinks) {
    return kernels::SegmentQuery{{segment.start[0], segment.start[1], segment.start[2]},
                                 {segment.end[0], segment.end[1], segment.end[2]},
                                 bound,
                                 shrinks,
                                 nullptr};
  };
  kernels::Work work;
  Search shrinking{boxes, segment, true, kInf, {}, 0};
  kernels.nearest(view, querySegment(kInf, true), offer, &shrinking, work);
  Search fixed{boxes, segment, false, 1.5 * least, {}, 0};
  kernels.nearest(view, querySegment(fixed.bound, false), offer, &fixed, work);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (std::isinf(truth[i])) {
      continue;
    }
    EXPECT_TRUE(truth[i] > least || shrinking.offered.count(i) == 1) << "box " << i;
    EXPECT_TRUE(truth[i] > fixed.bound || fixed.offered.count(i) == 1) << "box " << i;
  }
  if (kernels.nearest_one != nullptr) {
    Search several{boxes, segment, true, kInf, {}, 0};
    kernels::NearestOne one;
    const kernels::SegmentQuery query = querySegment(kInf, true);
    const bool is_one = kernels.nearest_one(view, query, offer, &several, &one, work);
    Search every{boxes, segment, true, kInf, {}, 0};
    EXPECT_FALSE(kernels.nearest_one(view, query, offer, &every, nullptr, work));
    if (is_one) {
      expectStart(one, segment, boxes[view.box_of_record[one.record]]);
      counts.met_ones += least == 0.0 ? 1 : 0;
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!std::isinf(truth[i]) && truth[i] == least) {
        EXPECT_TRUE(is_one ? view.box_of_record[one.record] == i : several.offered.count(i) == 1)
            << "box " << i;
        EXPECT_EQ(1U, every.offered.count(i)) << "box " << i;
      }
    }
    counts.ones += is_one ? 1 : 0;
  }
  counts.apart += least > 0.0 ? 1 : 0;
  counts.offered += shrinking.offered.size();
  counts.close += shrinking.close;
  counts.met += shrinking.met;
}

TEST_P(NearestKernelTest, OfferTheNearestInHostileScenes) {
  int asked = 0;
  Counts counts;
  for (std::size_t family = 0; family < sceneFamilyNames().size(); ++family) {
    for (std::uint64_t index = 0; index < 60; ++index) {
      const SceneSample scene = makeScene(family, 12, index);
      for (const Sample& s : scene.components) {
        checkNearest(*GetParam(), scene.boxes, s.segment(), counts);
        ++asked;
      }
    }
  }
  EXPECT_GT(counts.apart, asked / 10);
  EXPECT_GT(counts.met, 50);
  EXPECT_GT(counts.ones, GetParam()->nearest_one != nullptr ? asked / 20 : -1);
  EXPECT_GT(counts.met_ones, GetParam()->nearest_one != nullptr ? 50 : -1);
  EXPECT_GT(10 * counts.close, 9 * counts.offered);
}

TEST_P(NearestKernelTest, OfferTheNearestAtAnyDepthAndScale) {
  for (const std::size_t count : {1, 17, 129, 1300}) {
    for (const double scale : {0x1p-70, 1.0, 0x1p50}) {
      Random random(21, count, 0);
      std::vector<Box> boxes = scattered(random, count, 6.0);
      const double side = 6.0 * std::cbrt(static_cast<double>(count));
      for (Box& any : boxes) {
        if (auto* box = std::get_if<AlignedBox>(&any)) {
          *box = {scale * box->min, scale * box->max};
        } else {
          auto& oriented = std::get<OrientedBox>(any);
          oriented.center *= scale;
          oriented.half_extents *= scale;
        }
      }
      Counts counts;
      for (int i = 0; i < 12; ++i) {
        const Vector3 start = random.uniformVector(-0.2 * side, 1.2 * side);
        const double length = i % 3 == 0 ? 0.0 : random.magnitude(-6, 5);
        const Vector3 end = start + length * random.uniformVector(-1.0, 1.0);
        checkNearest(*GetParam(), boxes, {scale * start, scale * end}, counts);
      }
      EXPECT_GT(counts.apart, 2) << count << " boxes, scale " << scale;
      EXPECT_GT(10 * counts.close, 8 * counts.offered);
    }
  }
}

/// What was offered to many segments, each with the bound that it has since.
struct ManySearches {
  const std::vector<Box>& boxes;
  const std::vector<Segment>& segments;
  std::vector<double> bounds;

  static double offer(void* context, std::size_t query, std::uint32_t box,
                      const kernels::NearBox& near) {
    auto& self = *static_cast<ManySearches*>(context);
    const double distance = distanceTo(self.segments[query], self.boxes[box]);
    EXPECT_LE(near.lower, distance);
    EXPECT_GE(near.upper, distance);
    self.bounds[query] = std::min(self.bounds[query], distance);
    return self.bounds[query];
  }
};

TEST_P(NearestKernelTest, OfferTheNearestOfManySegments) {
  if (GetParam()->nearest_together == nullptr) {
    return;  // this kernel leaves it to others
  }
  int num_ones = 0;
  for (const std::size_t count : {1, 16, 17, 100, 129, 2500}) {
    Random random(22, count, 0);
    const std::vector<Box> boxes = scattered(random, count, 6.0);
    const double side = 6.0 * std::cbrt(static_cast<double>(count));
    const BoxTree tree{SceneBoxes(boxes)};
    const kernels::SceneView view = tree.view();
    BoxMask mask(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      mask.set(i, random.chance(0.5));
    }
    for (const std::size_t num_segments : {1, 16, 17, 40}) {
      std::vector<Segment> segments;
      std::vector<kernels::SegmentQuery> queries;
      while (segments.size() < num_segments) {
        const Vector3 start = random.uniformVector(-0.2 * side, 1.2 * side);
        const double length = random.chance(0.2) ? 0.0 : random.magnitude(-6, 6);
        segments.push_back({start, start + length * random.uniformVector(-1.0, 1.0)});
        const Segment& s = segments.back();
        queries.push_back({{s.start[0], s.start[1], s.start[2]},
                           {s.end[0], s.end[1], s.end[2]},
                           kInf,
                           true,
                           random.chance(0.1) ? mask.words() : nullptr});
      }
      ManySearches searches{boxes, segments, std::vector<double>(num_segments, kInf)};
      kernels::Work work;
      GetParam()->nearest_together(view, queries.data(), num_segments, ManySearches::offer,
                                   &searches, nullptr, work);
      ManySearches others{boxes, segments, std::vector<double>(num_segments, kInf)};
      constexpr std::uint32_t kNone = ~std::uint32_t{0};
      std::vector<kernels::NearestOne> ones(num_segments, {kNone, 0.0});
      GetParam()->nearest_together(view, queries.data(), num_segments, ManySearches::offer, &others,
                                   ones.data(), work);
      for (std::size_t k = 0; k < num_segments; ++k) {
        double least = kInf;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
          if (queries[k].mask == nullptr || mask[i]) {
            least = std::min(least, distanceTo(segments[k], boxes[i]));
          }
        }
        EXPECT_EQ(least, searches.bounds[k]) << "segment " << k << " among " << count << " boxes";
        const bool is_one = ones[k].record != kNone;
        EXPECT_EQ(least, is_one ? distanceTo(segments[k], boxes[view.box_of_record[ones[k].record]])
                                : others.bounds[k]);
        if (is_one) {
          expectStart(ones[k], segments[k], boxes[view.box_of_record[ones[k].record]]);
        }
        num_ones += is_one ? 1 : 0;
      }
    }
  }
  EXPECT_GT(num_ones, 200);
}

INSTANTIATE_TEST_SUITE_P(Every, NearestKernelTest, testing::ValuesIn(allKernels()), nameOf);

}  // namespace
}  // namespace box_query::stress
