// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Correct rounding of exact values: to nearest, ties to even, over the whole range of double.
/// Too large becomes infinite, too small becomes 0; zero is always +0.
#pragma once

#include "exact/dyadic.h"

namespace box_query::exact {

/// num / den, correctly rounded.
/// @pre den != 0
double roundedQuotient(const Dyadic& num, const Dyadic& den);

/// sqrt(num / den), correctly rounded.
/// @pre num >= 0, den > 0
double roundedSqrt(const Dyadic& num, const Dyadic& den);

/// A coordinate of a point; the largest double of its sign where none can hold it.
double finiteCoordinate(double x);

}  // namespace box_query::exact
