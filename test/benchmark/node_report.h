// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the node costs, for people and for programs, and what is promised of it.
#pragma once

#include "benchmark/bars.h"
#include "benchmark/node.h"

#include <ostream>
#include <vector>

namespace box_query::benchmark {

void printCallHeader(std::ostream& out);
void printBoxesHeader(std::ostream& out);
void print(const CallRow& row, std::ostream& out);
void print(const BoxesRow& row, std::ostream& out);

/// One table of both: what a row does not have is empty.
void writeCsv(const std::vector<CallRow>& calls, const std::vector<BoxesRow>& boxes,
              std::ostream& out);

/// The worst of each kind. What was not measured has no bar.
std::vector<Bar> nodeBars(const std::vector<CallRow>& calls, const std::vector<BoxesRow>& boxes);

}  // namespace box_query::benchmark
