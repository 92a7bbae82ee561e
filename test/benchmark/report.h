// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The measurements for people and for programs.
#pragma once

#include "benchmark/accuracy.h"

#include <ostream>

namespace box_query::benchmark {

void printTables(const std::vector<Row>& rows, std::ostream& out);
void writeCsv(const std::vector<Row>& rows, std::ostream& out);

}  // namespace box_query::benchmark
