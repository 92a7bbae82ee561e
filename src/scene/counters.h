// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kernels/scene_view.h"

namespace box_query {

/// Adds what kernels did for a query to the counters of this thread.
void countWork(const kernels::Work& work) noexcept;

}  // namespace box_query
