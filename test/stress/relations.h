// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What must hold between two answers, whatever the right one is.
#pragma once

#include "stress/families.h"
#include "stress/tally.h"

#include <box_query/distance.h>
#include <box_query/intersection.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace box_query::stress {

enum class Component { kLine, kRay, kSegment };

/// What does not depend on the frame, or follows it exactly.
struct Answer {
  bool test = false;
  Intersection found;
  IntersectionRanges ranges;
  double distance = std::numeric_limits<double>::quiet_NaN();    ///< Of segments.
  double distance_t = std::numeric_limits<double>::quiet_NaN();  ///< Of segments.
};

inline Answer answer(const Sample& sample, Component component) {
  const auto ask = [](const auto& linear, const auto& box) {
    return Answer{testIntersection(linear, box), findIntersection(linear, box),
                  findRanges(linear, box)};
  };
  return std::visit(
      [&](const auto& box) {
        switch (component) {
          case Component::kLine:
            return ask(sample.line(), box);
          case Component::kRay:
            return ask(sample.ray(), box);
          default:
            Answer result = ask(sample.segment(), box);
            const SegmentDistance nearest = distance(sample.segment(), box);
            result.distance = nearest.distance;
            result.distance_t = nearest.t;
            return result;
        }
      },
      sample.box);
}

/// How an answer changes: faces are renamed, parameters and lengths scale by powers of two.
struct Change {
  /// New number of each face.
  std::array<unsigned, 6> faces = {0, 1, 2, 3, 4, 5};
  int t_power = 0;
  int length_power = 0;

  void swapSides(int axis) {
    const std::size_t low = 2 * static_cast<std::size_t>(axis);
    std::swap(faces[low], faces[low + 1]);
  }
  FaceSet operator()(FaceSet set) const {
    unsigned bits = 0;
    for (unsigned face = 0; face < 6; ++face) {
      if ((set.bits() >> face & 1U) != 0) {
        bits |= 1U << faces[face];
      }
    }
    return FaceSet(bits);
  }
};

/// Whether b is a * 2^power, as far as both are far enough from underflow and overflow to say so.
inline bool isScaled(double a, double b, int power) {
  const auto ordinary = [](double x) {
    return std::fabs(x) > 0x1p-1000 && std::fabs(x) < 0x1p1000;
  };
  const double expected = std::ldexp(a, power);
  if (power == 0 || (ordinary(a) && ordinary(b) && ordinary(expected))) {
    return expected == b || (std::isnan(a) && std::isnan(b));
  }
  // Something underflowed or overflowed on one side: only the sign can be compared.
  return !(a < 0.0 && b > 0.0) && !(a > 0.0 && b < 0.0);
}

/// Counts a failure wherever `after` is not `before` as it changes.
inline void expectChanged(const Answer& before, const Answer& after, const Change& change,
                          const std::string& input, Tally& tally) {
  const auto expect = [&](bool right, const char* what) {
    if (!right) {
      tally.fail(input, what);
    }
  };
  const Intersection& a = before.found;
  const Intersection& b = after.found;
  expect(before.test == after.test, "test");
  expect(a.num_points == b.num_points, "num_points");
  expect(a.started_inside == b.started_inside, "started_inside");
  expect(isScaled(a.t_enter, b.t_enter, change.t_power), "t_enter");
  expect(isScaled(a.t_exit, b.t_exit, change.t_power), "t_exit");
  expect(change(a.entered) == b.entered, "entered");
  expect(change(a.left) == b.left, "left");
  expect(isScaled(before.ranges.enter, after.ranges.enter, change.length_power), "range enter");
  expect(isScaled(before.ranges.exit, after.ranges.exit, change.length_power), "range exit");
  expect(isScaled(before.distance, after.distance, change.length_power), "distance");
  expect(isScaled(before.distance_t, after.distance_t, 0), "t of the distance");
}

inline std::string describe(const Sample& sample) {
  return hex(sample.box) + " origin " + hex(sample.origin) + " direction " + hex(sample.direction) +
         " end " + hex(sample.end);
}

}  // namespace box_query::stress
