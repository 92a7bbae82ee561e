// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Hostile queries by family: what makes plain double arithmetic give wrong answers. Every sample
/// is determined by its seed, family and index, to the last bit and everywhere.
#pragma once

#include "stress/target.h"

#include <cstdint>
#include <string>
#include <vector>

namespace box_query::stress {

/// Names of the families, in the order of their numbers.
const std::vector<std::string>& familyNames();

/// A sample with an oriented or an aligned box. Valid in the sense of isValid().
Sample makeSample(std::size_t family, bool oriented, std::uint64_t seed, std::uint64_t index);

}  // namespace box_query::stress
