// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the certified answers may cost, and whether they do.
#pragma once

#include "benchmark/accuracy.h"

#include <ostream>
#include <string>
#include <vector>

namespace box_query::benchmark {

struct Bar {
  std::string name;
  double figure;
  double limit;
  std::string unit;
  std::string beside;  ///< More numbers, for whoever wants to know.

  bool holds() const { return figure <= limit; }
};

/// @param rows the tables of measurePairs and measureScenes
/// @param slow_pairs random pairs over which those are counted that double could not decide
std::vector<Bar> measureBars(const std::vector<Row>& rows, const Options& options,
                             std::uint64_t slow_pairs);

/// A line a bar: its name, the figure, the bar, whether it holds.
void printBars(const std::vector<Bar>& bars, std::ostream& out);

}  // namespace box_query::benchmark
