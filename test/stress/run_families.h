// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Runs of the stress suite over samples and scenes, on several threads.
#pragma once

#include "stress/tally.h"

namespace box_query::stress {

/// `count` samples of a family, every other one with an oriented box: all queries of pairs.
Tally runIntersections(std::size_t family, std::uint64_t seed, std::uint64_t count, int threads);
Tally runDistances(std::size_t family, std::uint64_t seed, std::uint64_t count, int threads);
/// `count` scenes of a family.
Tally runScenes(std::size_t family, std::uint64_t seed, std::uint64_t count, int threads);

}  // namespace box_query::stress
