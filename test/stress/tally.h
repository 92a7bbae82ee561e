// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a stress run counts.
#pragma once

#include <box_query/geometry.h>

#include <cstdint>
#include <string>
#include <vector>

namespace box_query::stress {

/// Points are right within this many ulps of the largest coordinate of component and box.
constexpr double kPointUlps = 8.0;
/// A blocked_at for a radius greater than 0 may be this many doubles early.
constexpr int kBlockedSteps = 4;

/// Counts of one family, or of several.
struct Tally {
  std::uint64_t queries = 0;
  std::uint64_t hits = 0;
  std::uint64_t wrong = 0;
  /// What the slower stages of the library had to do: see exact/stage_counters.h.
  std::uint64_t certified_decisions = 0;
  std::uint64_t exact_decisions = 0;
  std::uint64_t exact_roundings = 0;
  double worst_t = 0.0;         ///< [ulp]
  double worst_range = 0.0;     ///< [ulp]
  double worst_distance = 0.0;  ///< [ulp]
  double worst_point = 0.0;     ///< [ulp of the largest coordinate]
  int worst_blocked = 0;        ///< [doubles]
  /// The first few wrong answers, with the input in hexadecimal floating point.
  std::vector<std::string> failures;

  void merge(const Tally& other);
  /// Counts a wrong answer; `what` is wrong about `input`.
  void fail(const std::string& input, const std::string& what);
};

/// Exact text of a number and of what queries are made of, as C++ takes it.
std::string hex(double value);
std::string hex(const Vector3& v);
std::string hex(const Box& box);

}  // namespace box_query::stress
