// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the error bounds rest on: IEEE 754 double, evaluated as written.
#pragma once

#include <cfloat>
#include <limits>

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__)
#error \
    "box_query needs floating point evaluated as written: build without -ffast-math, -fassociative-math and -freciprocal-math, or its answers are wrong without notice."
#endif
#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
#error \
    "box_query computes with infinities: build without -ffinite-math-only (a part of -ffast-math and -Ofast)."
#endif
#if FLT_EVAL_METHOD != 0
#error \
    "box_query needs double arithmetic without excess precision: on 32-bit x86 build with -msse2 -mfpmath=sse."
#endif

namespace box_query::exact {

static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<double>::digits == 53,
              "box_query needs IEEE 754 double");

}  // namespace box_query::exact
