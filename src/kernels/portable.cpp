// SPDX-License-Identifier: BSD-3-Clause
// The kernels for every CPU.
#include "exact/bounds.h"
#include "exact/distance_bounds.h"
#include "exact/float_model.h"
#include "kernels/float_bounds.h"
#include "kernels/kernels.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace box_query::kernels {
namespace portable {
// Each needs those before it.
// clang-format off
#include "kernels/generic/lanes_portable.h"
#include "kernels/generic/ray.h"
#include "kernels/generic/ray_in_double.h"
#include "kernels/generic/unusual_ray.h"
#include "kernels/generic/box_times.h"
#include "kernels/generic/box_distance.h"
#include "kernels/generic/blocks.h"
#include "kernels/generic/short_trees.h"
#include "kernels/generic/search_blocks.h"
#include "kernels/generic/traverse.h"
#include "kernels/generic/ray_queries.h"
#include "kernels/generic/together.h"
#include "kernels/generic/rays_in_lanes.h"
#include "kernels/generic/list_together.h"
#include "kernels/generic/tree_together.h"
#include "kernels/generic/nearest.h"
// clang-format on
}  // namespace portable

const Kernels kPortable = {"portable",
                           portable::prefersBlocks,
                           portable::closest,
                           portable::any,
                           portable::anyWithin,
                           portable::closestTogether,
                           portable::anyTogether,
                           portable::anyOfSegmentsTogether,
                           portable::anyWithinTogether,
                           portable::all,
                           portable::nearest,
                           nullptr,
                           nullptr,
                           nullptr,
                           nullptr,
                           nullptr,
                           nullptr,
                           nullptr};

}  // namespace box_query::kernels
