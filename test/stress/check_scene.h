// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Every query of Scene against the oracle, box by box.
#pragma once

#include "stress/random.h"
#include "stress/scene_families.h"
#include "stress/tally.h"

namespace box_query::stress {

/// All queries with all components of the scene; masks, ranges and radii are picked by `random`,
/// most of them next to the answer without them.
void checkScene(const SceneSample& sample, Random& random, Tally& tally);

}  // namespace box_query::stress
