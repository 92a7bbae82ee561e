// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The measurements for people and for programs.
#pragma once

#include "benchmark/speed.h"

#include <ostream>

namespace box_query::benchmark {

void printHeader(std::ostream& out);
void print(const SpeedRow& row, std::ostream& out);
void writeCsv(const std::vector<SpeedRow>& rows, std::ostream& out);

}  // namespace box_query::benchmark
