// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The load on a node /box_query that was started with load.launch.
#pragma once

#include "load/report.h"

namespace box_query::load {

/// Waits until the node knows all topics, lets the clients ask, and checks what they were answered.
/// @throws std::runtime_error where the node or what it listens to is not there
Measured askAndCheck(double seconds, std::size_t oracle_step);

}  // namespace box_query::load
