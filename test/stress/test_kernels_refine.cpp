// SPDX-License-Identifier: BSD-3-Clause
// That a distance is as exact as a kernel says: within its errors of the exact one.
#include "geometry/aligned_form.h"
#include "geometry/distance_exact.h"
#include "geometry/distance_query.h"
#include "geometry/prepared_box.h"
#include "kernels/kernels.h"
#include "scene/box_bounds.h"
#include "scene/search.h"
#include "stress/families.h"
#include "stress/kernel_scenes.h"

#include <box_query/distance.h>

#include <algorithm>
#include <array>
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

/// What a kernel rounds eight distances to.
struct Rounded {
  struct Numbers {
    double distance;
    double t;
    double on_segment[3];
    double on_box[3];
  } of[kernels::kRoundLanes];
  std::uint32_t certain;
};

/// Eight segments and boxes for a kernel.
struct Pairs {
  std::vector<Sample> samples;
  std::vector<kernels::BoxRecord> records;
  std::vector<kernels::AxisRests> rests;
  std::array<Segment, kernels::kRoundLanes> segments;
  kernels::RoundQueries queries{};

  void add(const kernels::Kernels& kernels, const Sample& sample, double t) {
    const std::size_t k = samples.size();
    const auto& box = std::get<OrientedBox>(sample.box);
    queries.t[k] = t;
    queries.record[k] = static_cast<std::uint32_t>(k);
    samples.push_back(sample);
    segments[k] = sample.segment();
    records.push_back(recordOf(PreparedBox(box)));
    rests.emplace_back();
    kernels.find_rests(box.orientation.coeffs().data(), records.back(), rests.back());
  }

  /// (Only these fields of a scene are read.)
  kernels::SceneView view() const {
    kernels::SceneView view{};
    view.records = records.data();
    view.rests = rests.data();
    return view;
  }

  void round(const kernels::Kernels& kernels, Rounded& rounded) {
    for (std::size_t k = 0; k < kernels::kRoundLanes; ++k) {
      queries.segment[k] = segments[k].start.data();
      queries.rounded[k] = &rounded.of[k].distance;
    }
    rounded.certain = kernels.round_together(view(), queries);
  }
};

/// One distance of many, as `distance()` has it, and the same if it is rounded alone.
/// @return whether the kernel is certain alone too
bool checkRounded(const kernels::Kernels& kernels, const Pairs& pairs, std::size_t k,
                  const Rounded::Numbers* of_many) {
  const Segment segment = pairs.samples[k].segment();
  const SegmentDistance d = distance(segment, std::get<OrientedBox>(pairs.samples[k].box));
  kernels::RoundedNearest alone;
  const bool is_certain =
      kernels.round_nearest(pairs.view(), nearestQuery(segment, nullptr),
                            {static_cast<std::uint32_t>(k), pairs.queries.t[k]}, alone);
  const auto expectSame = [&](double distance, double t, auto&& on_segment, auto&& on_box) {
    EXPECT_EQ(d.distance, distance);
    EXPECT_EQ(d.t, t);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(d.on_segment[i], on_segment(i));
      EXPECT_EQ(d.on_box[i], on_box(i));
      EXPECT_EQ(std::signbit(d.on_box[i]), std::signbit(on_box(i)));
    }
  };
  if (is_certain) {
    expectSame(
        alone.distance, alone.t, [&](int i) { return alone.on_segment[i]; },
        [&](int i) { return alone.on_box[i]; });
  }
  if (of_many != nullptr) {
    expectSame(
        of_many->distance, of_many->t, [&](int i) { return of_many->on_segment[i]; },
        [&](int i) { return of_many->on_box[i]; });
  }
  return is_certain;
}

struct Certain {
  int together = 0;
  int alone = 0;
};

void checkTogether(const kernels::Kernels& kernels, Pairs& pairs, Certain& certain) {
  Rounded rounded;
  pairs.round(kernels, rounded);
  for (std::size_t k = 0; k < pairs.samples.size(); ++k) {
    const bool is_certain = ((rounded.certain >> k) & 1U) != 0;
    certain.together += is_certain ? 1 : 0;
    certain.alone += checkRounded(kernels, pairs, k, is_certain ? &rounded.of[k] : nullptr) ? 1 : 0;
  }
}

TEST_P(RefineKernelTest, NoDistanceFromABoxThatIsMetIsCertain) {
  if (GetParam()->round_together == nullptr) {
    return;  // this kernel leaves it to others
  }
  int met = 0;
  for (std::size_t family = 0; family < familyNames().size(); ++family) {
    Pairs pairs;
    for (std::uint64_t index = 0; index < 500; ++index) {
      const Sample sample = makeSample(family, true, 33, index);
      const auto& box = std::get<OrientedBox>(sample.box);
      const NearestEstimate estimate = estimateNearest(sample.segment(), doubleSlabs(box));
      if (alignedForm(box) || !isModerate(box) || estimate.bounds.lower > 0.0 ||
          !testIntersection(sample.segment(), box)) {
        continue;
      }
      const double guesses[3] = {estimate.guess.t, 0.0, 1.0};
      pairs.add(*GetParam(), sample, guesses[index % 3]);
      if (pairs.samples.size() == kernels::kRoundLanes) {
        Rounded rounded;
        pairs.round(*GetParam(), rounded);
        EXPECT_EQ(0U, rounded.certain);
        for (std::size_t k = 0; k < pairs.samples.size(); ++k) {
          kernels::RoundedNearest alone;
          EXPECT_FALSE(GetParam()->round_nearest(
              pairs.view(), nearestQuery(pairs.samples[k].segment(), nullptr),
              {static_cast<std::uint32_t>(k), pairs.queries.t[k]}, alone));
        }
        met += kernels::kRoundLanes;
        pairs = Pairs();
      }
    }
  }
  EXPECT_GT(met, 1000);
}

/// From guesses that are as good as double, or as float, or bad.
TEST_P(RefineKernelTest, WhatIsCertainIsRoundedAsItIsWithoutAScene) {
  if (GetParam()->round_together == nullptr) {
    return;  // this kernel leaves it to others
  }
  constexpr std::size_t kGuesses = 4;
  Certain certain[kGuesses];
  for (std::size_t family = 0; family < familyNames().size(); ++family) {
    SCOPED_TRACE(familyNames()[family]);
    std::vector<Pairs> pairs(kGuesses);
    for (std::uint64_t index = 0; index < 1000; ++index) {
      const Sample sample = makeSample(family, true, 32, index);
      const auto& box = std::get<OrientedBox>(sample.box);
      const NearestEstimate estimate = estimateNearest(sample.segment(), doubleSlabs(box));
      if (alignedForm(box) || !isModerate(box) || !(estimate.bounds.lower > 0.0)) {
        continue;  // in no record as it is, or met
      }
      const double t = estimate.guess.t;
      const double guesses[kGuesses] = {t, static_cast<float>(t), std::min(1.001 * t, 1.0),
                                        index % 2 == 0 ? 0.0 : 1.0};
      for (std::size_t g = 0; g < kGuesses; ++g) {
        pairs[g].add(*GetParam(), sample, guesses[g]);
        if (pairs[g].samples.size() == kernels::kRoundLanes) {
          checkTogether(*GetParam(), pairs[g], certain[g]);
          pairs[g] = Pairs();
        }
      }
    }
  }
  const int least[kGuesses] = {2500, 2500, 2000, 800};
  const int least_alone[kGuesses] = {2500, 2500, 2500, 2000};  // guessed again
  for (std::size_t g = 0; g < kGuesses; ++g) {
    EXPECT_GT(certain[g].together, least[g]);
    EXPECT_GT(certain[g].alone, least_alone[g]);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, RefineKernelTest, testing::ValuesIn(allKernels()), nameOf);

}  // namespace
}  // namespace box_query::stress
