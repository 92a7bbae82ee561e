// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Whether a double is the correctly rounded value of an exact one (nearest, ties to even; too
/// large rounds to infinity, too small to zero), and how far away it is.
#pragma once

#include "reference/oracle/distance.h"
#include "reference/oracle/interval.h"

namespace box_query::oracle {

bool isCorrectlyRounded(double x, const Fraction& value);
/// Of an end of an interval, which may be infinite.
bool isCorrectlyRounded(double x, const Bound& value);
/// Of sqrt(square), square >= 0.
bool isCorrectlyRoundedSqrt(double x, const Fraction& square);

/// |x - exact| in units of the gap between |x| and the next larger double: at most 0.5 if x is
/// correctly rounded. An infinity is 0 away where it is right, +inf where it is not; so is NaN.
double ulpError(double x, const Fraction& value);
double ulpError(double x, const Bound& value);
double ulpErrorSqrt(double x, const Fraction& square);

/// How many doubles follow x up to the exact root, counted up to `limit`; -1 if x is greater than
/// the root, or NaN.
int stepsBefore(double x, const Root& root, int limit);

}  // namespace box_query::oracle
