// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Ways to ask one box after the other, all but the last in plain double.
#pragma once

#include "benchmark/speed.h"

namespace box_query::benchmark {

/// Slab tests and, for clearances, distances at breakpoints.
std::unique_ptr<SpeedMethod> makeScan(const std::vector<OrientedBox>& boxes);
/// Eight slab tests at once, from a structure of arrays.
std::unique_ptr<SpeedMethod> makeSlabsOfEight(const std::vector<OrientedBox>& boxes);
/// Listing 9 of the paper, find-intersection.
std::unique_ptr<SpeedMethod> makeFindScan(const std::vector<OrientedBox>& boxes);
/// The exact distance of each box, correctly rounded, by the library.
std::unique_ptr<SpeedMethod> makeExactScan(const std::vector<OrientedBox>& boxes);

}  // namespace box_query::benchmark
