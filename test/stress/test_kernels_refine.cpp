// SPDX-License-Identifier: BSD-3-Clause
// That a distance is as exact as a kernel says: within its errors of the exact one.
#include "geometry/aligned_form.h"
#include "geometry/distance_exact.h"
#include "geometry/distance_query.h"
#include "geometry/prepared_box.h"
#include "kernels/kernels.h"
#include "stress/families.h"
#include "stress/kernel_scenes.h"

#include <box_query/distance.h>

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace box_query::stress {
namespace {

using exact::Dyadic;

class RefineKernelTest : public testing::TestWithParam<const kernels::Kernels*> {};

bool isWithin(const double* x, double error, const exact::Parameter& exactly) {
  const Dyadic off = (Dyadic(x[0]) + x[1]) * exactly.den - exactly.num;
  return abs(off) <= exactly.den * error;
}

bool isRootWithin(const double* x, double error, const exact::Ratio& squared) {
  const Dyadic lower = Dyadic(x[0]) + x[1] - error;
  const Dyadic upper = Dyadic(x[0]) + x[1] + error;
  return (lower.sign() <= 0 || lower * lower * squared.den <= squared.num) &&
         squared.num <= upper * upper * squared.den;
}

/// @param t near where it is nearest
/// @return whether the kernel said something, and that is worth it
bool checkRefined(const kernels::Kernels& kernels, const Segment& segment, const OrientedBox& box,
                  double t) {
  kernels::Refined refined;
  if (!kernels.refine({box.orientation.coeffs().data(), box.center.data(), box.half_extents.data(),
                       segment.start.data(), segment.end.data(), t},
                      refined) ||
      !(refined.t_error < 1.0)) {
    return false;
  }
  if (refined.inside && !(refined.t[0] > 0.0 && refined.t[0] < 1.0)) {
    return false;  // another piece, or an end
  }
  const exact::Nearest nearest = exact::nearest(exact::segmentAtBox(segment, box));
  EXPECT_TRUE(isWithin(refined.t, refined.t_error, nearest.t));
  EXPECT_TRUE(isRootWithin(refined.distance, refined.distance_error, nearest.squared));
  return refined.distance_error < 0x1p-70 * (segment.start - box.center).lpNorm<1>();
}

TEST_P(RefineKernelTest, ErrorsEncloseTheExactDistance) {
  if (GetParam()->refine == nullptr) {
    return;  // this kernel leaves it to others
  }
  int refined = 0;
  for (std::size_t family = 0; family < familyNames().size(); ++family) {
    for (std::uint64_t index = 0; index < 400; ++index) {
      const Sample sample = makeSample(family, true, 31, index);
      SCOPED_TRACE(familyNames()[family] + " " + std::to_string(index));
      const Segment segment = sample.segment();
      const auto& box = std::get<OrientedBox>(sample.box);
      const double t = estimateNearest(segment, doubleSlabs(box)).guess.t;
      for (const double guess : {t, double{static_cast<float>(t)}, 0.5 * t}) {
        refined += checkRefined(*GetParam(), segment, box, guess) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(refined, 1500);
}

/// Eight segments and boxes for a kernel.
struct Pairs {
  kernels::RefineQueries queries{};
  std::vector<Sample> samples;

  void add(const Sample& sample, double t) {
    const std::size_t k = samples.size();
    const auto& box = std::get<OrientedBox>(sample.box);
    const Segment segment = sample.segment();
    for (int i = 0; i < 3; ++i) {
      queries.center[i][k] = box.center[i];
      queries.half_extents[i][k] = box.half_extents[i];
      queries.start[i][k] = segment.start[i];
      queries.end[i][k] = segment.end[i];
    }
    for (int i = 0; i < 4; ++i) {
      queries.quaternion[i][k] = box.orientation.coeffs()[i];
    }
    queries.t[k] = t;
    samples.push_back(sample);
  }
};

/// @return how many the kernel is certain about
int checkTogether(const kernels::Kernels& kernels, const Pairs& pairs) {
  kernels::RefinedEach refined;
  const std::uint32_t certain = kernels.refine_together(pairs.queries, refined);
  for (std::size_t k = 0; k < pairs.samples.size(); ++k) {
    if (((certain >> k) & 1U) == 0) {
      continue;
    }
    const Sample& sample = pairs.samples[k];
    const SegmentDistance d = distance(sample.segment(), std::get<OrientedBox>(sample.box));
    EXPECT_EQ(d.distance, refined.distance[k]);
    EXPECT_EQ(d.t, refined.t[k]);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(d.on_segment[i], refined.on_segment[i][k]);
      EXPECT_EQ(d.on_box[i], refined.on_box[i][k]);
      EXPECT_EQ(std::signbit(d.on_box[i]), std::signbit(refined.on_box[i][k]));
    }
  }
  return __builtin_popcount(certain);
}

/// From guesses that are as good as double, or as float, or bad.
TEST_P(RefineKernelTest, WhatIsCertainOfManyIsRoundedAsEachIs) {
  if (GetParam()->refine_together == nullptr) {
    return;  // this kernel leaves it to others
  }
  constexpr std::size_t kGuesses = 4;
  int certain[kGuesses] = {};
  for (std::size_t family = 0; family < familyNames().size(); ++family) {
    SCOPED_TRACE(familyNames()[family]);
    std::vector<Pairs> pairs(kGuesses);
    for (std::uint64_t index = 0; index < 1000; ++index) {
      const Sample sample = makeSample(family, true, 32, index);
      if (alignedForm(std::get<OrientedBox>(sample.box))) {
        continue;  // distance() sees it as an aligned box
      }
      const double t =
          estimateNearest(sample.segment(), doubleSlabs(std::get<OrientedBox>(sample.box))).guess.t;
      const double guesses[kGuesses] = {t, static_cast<float>(t), std::min(1.001 * t, 1.0),
                                        index % 2 == 0 ? 0.0 : 1.0};
      for (std::size_t g = 0; g < kGuesses; ++g) {
        pairs[g].add(sample, guesses[g]);
        if (pairs[g].samples.size() == kernels::kRefineLanes) {
          certain[g] += checkTogether(*GetParam(), pairs[g]);
          pairs[g] = Pairs();
        }
      }
    }
  }
  EXPECT_GT(certain[0], 3500);
  EXPECT_GT(certain[1], 3500);
  EXPECT_GT(certain[2], 2500);
  EXPECT_GT(certain[3], 800);
}

INSTANTIATE_TEST_SUITE_P(Every, RefineKernelTest, testing::ValuesIn(allKernels()), nameOf);

}  // namespace
}  // namespace box_query::stress
