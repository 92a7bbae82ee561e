// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The closest box of a scene, exactly.
#pragma once

#include "reference/oracle.h"

#include <box_query/scene.h>

#include <vector>

namespace box_query::benchmark {

struct SceneTruth {
  std::size_t box = kNoBox;
  oracle::Fraction squared_range;

  bool hit() const { return box != kNoBox; }
};

std::vector<SceneTruth> truthOf(const std::vector<OrientedBox>& boxes,
                                const std::vector<Ray>& rays);

}  // namespace box_query::benchmark
