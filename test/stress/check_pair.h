// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Every query of one component and one box against the oracle.
#pragma once

#include "reference/oracle.h"
#include "stress/families.h"
#include "stress/random.h"
#include "stress/tally.h"

namespace box_query::stress {

/// testIntersection, findIntersection and findRanges of the sample's line, ray or segment.
void checkIntersection(const Sample& sample, oracle::Kind kind, Tally& tally);

/// Of all three.
void checkIntersections(const Sample& sample, Tally& tally);

/// distance, isClear and blockedAt of the sample's segment, with radii that `random` picks, most of
/// them next to the distance.
void checkDistances(const Sample& sample, Random& random, Tally& tally);

}  // namespace box_query::stress
