// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Boxes for the tests of kernels, and the kernels that the CPU has.
#pragma once

#include "kernels/kernels.h"
#include "stress/random.h"

#include <box_query/geometry.h>

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace box_query::stress {

inline std::vector<const kernels::Kernels*> allKernels() {
  std::vector<const kernels::Kernels*> all;
  for (const char* name : {"portable", "avx2", "avx512"}) {
    if (const kernels::Kernels* kernels = kernels::byName(name)) {
      all.push_back(kernels);
    }
  }
  return all;
}

/// In a cube, a fifth of them aligned.
inline std::vector<Box> scattered(Random& random, std::size_t count, double spacing) {
  const double side = spacing * std::cbrt(static_cast<double>(count));
  std::vector<Box> boxes;
  while (boxes.size() < count) {
    const Vector3 center = random.uniformVector(0.0, side);
    const Vector3 size = random.uniformVector(0.1, 1.5);
    if (random.chance(0.2)) {
      boxes.emplace_back(AlignedBox{center - size, center + size});
    } else {
      boxes.emplace_back(OrientedBox{center, random.rotation(), size});
    }
  }
  return boxes;
}

inline Vector3 pointOf(const Box& box) {
  return std::holds_alternative<AlignedBox>(box) ? std::get<AlignedBox>(box).min
                                                 : std::get<OrientedBox>(box).center;
}

/// Most at a box. Some along an axis, as lidars and shelves have them: exactly, or all but.
inline Ray rayAmong(Random& random, double side, const std::vector<Box>& boxes) {
  Ray ray{random.uniformVector(-0.2 * side, 1.2 * side), random.uniformVector(-1.0, 1.0)};
  const auto target = static_cast<std::size_t>(random.below(static_cast<int>(boxes.size())));
  if (random.chance(0.6)) {
    ray.direction = pointOf(boxes[target]) - ray.origin;
  }
  const int axis = random.below(3);
  if (random.chance(0.3)) {
    ray.direction[axis] = random.chance(0.5) ? 0.0 : random.signedMagnitude(-80, -20);
  }
  if (random.chance(0.15)) {
    ray.direction = Vector3::Unit(axis) * random.signedMagnitude(-30, 30);
  }
  return ray;
}

inline std::string nameOf(const testing::TestParamInfo<const kernels::Kernels*>& info) {
  return info.param->name;
}

}  // namespace box_query::stress
