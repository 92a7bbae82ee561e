// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// All methods, in the order in which they are shown.
#pragma once

#include "benchmark/methods_library.h"
#include "benchmark/methods_paper.h"
#include "benchmark/methods_slab.h"

namespace box_query::benchmark {

template <typename... Methods>
struct MethodList {};

using PairMethods =
    MethodList<FloatSlab, DoubleSlab, PaddedSlab, TestInWorldFrame, TestInBoxFrame, Find,
               LibraryTest, LibraryEnclosed, LibraryRounded, DoubleDoubleAlways, ExactAlways>;

/// Where the first box that is hit ends the search.
using AnyMethods = MethodList<FloatSlab, DoubleSlab, PaddedSlab, TestInWorldFrame, TestInBoxFrame,
                              DoubleDoubleAlways, ExactAlways>;

/// Those that say where.
using ClosestMethods = MethodList<FloatSlab, DoubleSlab, PaddedSlab, Find>;

}  // namespace box_query::benchmark
