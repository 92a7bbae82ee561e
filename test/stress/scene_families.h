// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Scenes of many boxes in which boxes tie, or nearly tie, and components that meet them.
#pragma once

#include "stress/target.h"

#include <cstdint>
#include <string>
#include <vector>

namespace box_query::stress {

struct SceneSample {
  std::vector<Box> boxes;
  /// Components; their own boxes are among those of the scene.
  std::vector<Sample> components;
};

const std::vector<std::string>& sceneFamilyNames();

/// How many scenes of a family there are among `scenes` of all: as many as of others, but fewer
/// where one has thousands of boxes.
std::uint64_t sceneCount(std::size_t family, std::uint64_t scenes);

SceneSample makeScene(std::size_t family, std::uint64_t seed, std::uint64_t index);

}  // namespace box_query::stress
