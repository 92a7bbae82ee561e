// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How often the slower stages had to decide or to round. What is not counted was settled in double
/// (decisions) or in double-double (rounding).
#pragma once

#include <cstdint>

namespace box_query::exact {

/// Counts of one thread: plain numbers, touched by the slow stages only.
struct StageCounters {
  std::uint64_t certified_decisions = 0;  ///< undecided in double
  std::uint64_t exact_decisions = 0;      ///< of these, undecided in double-double too
  std::uint64_t exact_roundings = 0;      ///< too close to a midpoint for double-double
};

StageCounters& stageCounters();

}  // namespace box_query::exact
