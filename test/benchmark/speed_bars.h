// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How much faster than others the library is to be.
#pragma once

#include "benchmark/bars.h"
#include "benchmark/speed.h"

namespace box_query::benchmark {

/// The bars of which something was measured: the worst of what was.
/// @param rows of measureSpeed()
std::vector<Bar> speedBars(const std::vector<SpeedRow>& rows);

}  // namespace box_query::benchmark
