// SPDX-License-Identifier: BSD-3-Clause
// The kernels for CPUs with AVX2 and FMA.
#include "kernels/kernels.h"

#if defined(__x86_64__)
#include "exact/bounds.h"
#include "exact/distance_bounds.h"
#include "exact/float_model.h"
#include "kernels/float_bounds.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include <immintrin.h>

// Everything from here on is compiled for that CPU, and nothing before: no function that other
// files share.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,fma,bmi,lzcnt,popcnt"))), \
                             apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma,bmi,lzcnt,popcnt")
#endif

namespace box_query::kernels {
namespace avx2 {
// Each needs those before it.
// clang-format off
#include "kernels/generic/lanes_x86.h"
#include "kernels/generic/lanes_avx2.h"
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
#include "kernels/generic/leaf_distances.h"
#include "kernels/generic/nearest_one.h"
#include "kernels/generic/nearest_together.h"
#include "kernels/generic/wide.h"
#include "kernels/generic/cross.h"
#include "kernels/generic/box_frame.h"
#include "kernels/generic/refine.h"
#include "kernels/generic/round_nearest.h"
#include "kernels/generic/round_together.h"
// clang-format on
}  // namespace avx2

const Kernels kAvx2 = {"avx2",
                       avx2::prefersBlocks,
                       avx2::closest,
                       avx2::any,
                       avx2::anyWithin,
                       avx2::closestTogether,
                       avx2::anyTogether,
                       avx2::anyOfSegmentsTogether,
                       avx2::anyWithinTogether,
                       avx2::all,
                       avx2::nearest,
                       avx2::nearestOne,
                       avx2::nearestTogether,
                       avx2::cross,
                       avx2::refine,
                       avx2::findRests,
                       avx2::roundNearest,
                       avx2::roundTogether};

}  // namespace box_query::kernels

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif
