// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the answers should have been.
#pragma once

#include "benchmark/speed.h"

namespace box_query::benchmark {

/// The right answer: one exact pair after the other, but for boxes that are nowhere near.
SpeedAnswer truthOf(Question question, const std::vector<OrientedBox>& boxes, const Ray& ray);

/// Of the library, `exactly`: not the right answer. Of others: not right for any boxes that differ
/// from these by less than a nanometre.
bool isWrong(Question question, const std::vector<OrientedBox>& boxes, const Ray& ray,
             const SpeedAnswer& answer, const SpeedAnswer& truth, bool exactly);

}  // namespace box_query::benchmark
