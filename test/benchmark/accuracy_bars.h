// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the certified answers may cost, and whether they do.
#pragma once

#include "benchmark/accuracy.h"
#include "benchmark/bars.h"

#include <vector>

namespace box_query::benchmark {

/// @param rows the tables of measurePairs and measureScenes
/// @param slow_pairs random pairs over which those are counted that double could not decide
std::vector<Bar> measureBars(const std::vector<Row>& rows, const Options& options,
                             std::uint64_t slow_pairs);

}  // namespace box_query::benchmark
