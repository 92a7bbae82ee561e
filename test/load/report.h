// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The measurements for people.
#pragma once

#include "benchmark/bars.h"
#include "load/check.h"
#include "load/waits.h"

#include <ostream>
#include <vector>

namespace box_query::load {

struct Measured {
  double seconds = 0.0;
  std::vector<Answer> answers;
  std::map<std::uint64_t, SceneFacts> scenes;  ///< that answers name
  Verdict verdict;
  double early_memory = 0.0;  ///< [MB] after a third of the time
  double late_memory = 0.0;   ///< [MB] at its end
  QueriesBesideMessage beside_message;
  MessagesBesideBatch beside_batch;

  std::size_t lost() const;
  std::size_t firstTriesFailed() const;
  /// No answer was wrong, lost, or from a scene that could not be had.
  bool isFlawless() const;
};

void print(const Measured& measured, std::ostream& out);
std::vector<benchmark::Bar> barsOf(const Measured& measured);

}  // namespace box_query::load
