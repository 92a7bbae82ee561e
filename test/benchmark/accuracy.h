// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Run time against error: every method on the same input in one run, its answers compared with the
/// exact ones.
#pragma once

#include "benchmark/inputs.h"
#include "benchmark/timing.h"

#include <cstdint>
#include <string>
#include <vector>

namespace box_query::benchmark {

struct Options {
  std::size_t pair_sample = 100000;  ///< Pairs compared with the exact answer, for each table.
  std::size_t scene_sample = 5000;   ///< Rays of scenes, likewise.
  /// In one pass on the clock: as many pairs as the second level of any cache holds, and more than
  /// a branch predictor learns by heart.
  std::size_t timed_pairs = 4096;
  std::size_t timed_rays = 256;
  int rounds = 31;  ///< Turns that each method has on the clock.
  std::uint64_t seed = 1;
};

/// How far a method is from the truth.
struct Errors {
  std::size_t asked = 0;
  std::size_t hits = 0;  ///< In truth.
  std::size_t false_hits = 0;
  std::size_t false_misses = 0;
  std::size_t wrong_boxes = 0;  ///< The closest of a scene: a hit, but of another box.
  std::vector<double> ulps;     ///< Of t, or of a range in scenes, where both truth and method hit.

  std::size_t wrong() const { return false_hits + false_misses + wrong_boxes; }
};

/// One line of the table: one method on one input.
struct Row {
  std::string table;     ///< "line", "ray", "segment": pairs. "any", "closest": scenes of 64 boxes.
  std::string input;     ///< "random", "hostile", "shelf".
  std::string prepared;  ///< "box": made before the clock runs. "nothing": made in every question.
  std::string method;
  Timing timing;
  Errors errors;
};

std::vector<Row> measurePairs(const Options& options);
std::vector<Row> measureScenes(const Options& options);

}  // namespace box_query::benchmark
