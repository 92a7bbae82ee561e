// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is promised of a measured figure, and whether it holds.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace box_query::benchmark {

struct Bar {
  enum Side { kAtMost, kAtLeast };

  std::string name;
  double figure;
  Side side;
  double limit;
  std::string unit;
  std::string beside;  ///< More numbers, for whoever wants to know.

  bool holds() const { return side == kAtMost ? figure <= limit : figure >= limit; }
};

/// A line a bar: its name, the figure, the bar, whether it holds.
void printBars(const std::vector<Bar>& bars, std::ostream& out);

}  // namespace box_query::benchmark
