// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The oracle: what every query of the library means, computed exactly with GMP. It shares nothing
/// with the library but the public types, rounds nothing and takes a few microseconds a query.
///
///     const oracle::Interval exact = oracle::interval(ray, box);
///     EXPECT_EQ(found.num_points, exact.num_points);
///     EXPECT_TRUE(oracle::isCorrectlyRounded(found.t_enter, exact.enter));
#pragma once

#include "reference/oracle/distance.h"
#include "reference/oracle/interval.h"
#include "reference/oracle/points.h"
#include "reference/oracle/rounding.h"
