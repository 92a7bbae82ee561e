// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// An oriented box solved by a kernel, where the instruction set has one for it.
#pragma once

#include "geometry/planes.h"
#include "geometry/solve.h"
#include "kernels/kernels.h"

namespace box_query {

/// The faces where a component enters and leaves a box, and where that is, by a kernel.
/// @return whether it is clear
template <typename T>
bool solveByKernel(const T& linear, const DoubleComponent& component, const OrientedBox& box,
                   Solution& solution) {
  const auto cross = kernels::active().cross;
  if (cross == nullptr) {
    return false;
  }
  double direction_low[3] = {0.0, 0.0, 0.0};
  if constexpr (kHasEnd<T>) {
    for (int i = 0; i < 3; ++i) {
      direction_low[i] = exactDirection(linear, i).lo;
    }
  }
  const kernels::CrossingQuery query{box.orientation.coeffs().data(),
                                     box.center.data(),
                                     box.half_extents.data(),
                                     component.origin,
                                     component.direction,
                                     direction_low,
                                     kHasStart<T>,
                                     kHasEnd<T>};
  kernels::Crossing enter;
  kernels::Crossing exit;
  switch (cross(query, enter, exit)) {
    case kernels::Crossed::kMiss:
      return true;
    case kernels::Crossed::kUnclear:
      return false;
    case kernels::Crossed::kHit:
      break;
  }
  const auto set = [](const kernels::Crossing& from, double own, Crossing& to) {
    to.axis = from.axis;
    to.positive = from.positive;
    if (from.axis == kernels::Crossing::kOwn) {
      to.t = {own, 1.0};
    } else {
      to.estimate = {{from.t[0], from.t[1]}, from.error};
    }
  };
  solution.num_points = 2;
  set(enter, 0.0, solution.enter);
  set(exit, 1.0, solution.exit);
  if (enter.axis == kernels::Crossing::kOwn) {
    solution.started_inside = kHasStart<T>;
  } else {
    solution.entered.insert(enter.axis, enter.positive);
  }
  if (exit.axis != kernels::Crossing::kOwn) {
    solution.left.insert(exit.axis, exit.positive);
  }
  return true;
}

}  // namespace box_query
