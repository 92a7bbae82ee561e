// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a method of the benchmark is, and the loop that every one of them is timed in.
///
/// A method is a struct with
///     static constexpr const char* kName;
///     static constexpr bool kGivesT;    // else Answer::t means nothing
///     static constexpr bool kLooksAtT;  // whether it is timed with a caller that reads t
///     using Prepared = ...;           // of a box, made before the clock runs
///     static Prepared prepare(const OrientedBox& box);
///     static Answer ask(const Component& component, const Prepared& box);  // for each component
#pragma once

#include <box_query/geometry.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace box_query::benchmark {

struct Answer {
  bool hit = false;
  /// Where the component enters the box: a multiple of the direction, 0 to 1 along a segment.
  double t = std::numeric_limits<double>::quiet_NaN();
  /// The upper end where t is the lower one of an enclosure; else NaN.
  double t_above = std::numeric_limits<double>::quiet_NaN();
};

inline std::uint64_t bitsOf(double x) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

inline std::uint64_t rotated(std::uint64_t x, std::size_t n) {
  n &= 63U;
  return (x << n) | (x >> ((64U - n) & 63U));
}

/// Asks about every pair; returns a sum of all that was answered, so that nothing can be left out.
template <typename Method, typename Component>
std::uint64_t passOver(const std::vector<Component>& components,
                       const std::vector<typename Method::Prepared>& boxes) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < components.size(); ++i) {
    const Answer answer = Method::ask(components[i], boxes[i]);
    const std::uint64_t hit = answer.hit ? 1U : 0U;
    if constexpr (Method::kLooksAtT) {
      sum ^= rotated(bitsOf(answer.t) & (0U - hit), i);
    }
    sum += hit << (i % 32U);
  }
  return sum;
}

template <typename Method>
std::vector<typename Method::Prepared> prepareAll(const std::vector<OrientedBox>& boxes) {
  std::vector<typename Method::Prepared> prepared;
  prepared.reserve(boxes.size());
  for (const OrientedBox& box : boxes) {
    prepared.push_back(Method::prepare(box));
  }
  return prepared;
}

/// A pair on its own: what a method prepares of a box is made anew for every question.
template <typename Method>
struct Lone {
  static constexpr const char* kName = Method::kName;
  static constexpr bool kGivesT = Method::kGivesT;
  static constexpr bool kLooksAtT = Method::kLooksAtT;
  using Prepared = OrientedBox;
  static const OrientedBox& prepare(const OrientedBox& box) { return box; }
  template <typename Component>
  static Answer ask(const Component& component, const OrientedBox& box) {
    return Method::ask(component, Method::prepare(box));
  }
};

}  // namespace box_query::benchmark
