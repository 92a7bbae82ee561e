// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The ten listings of D. Eberly, "Intersection of a Line and a Box" (Geometric Tools, 2018, CC BY
/// 4.0), under their numbers: what the library is compared with and measured against.
///
/// They stay what they are: plain double arithmetic. Corrected is only what was misprinted, and
/// each such place says what the paper prints (listings_as_printed.h has the faults themselves).
/// That they round, overflow and take a zero direction for a line is theirs, and shown in
/// unit/test_errata*.cpp.
#pragma once

#include "reference/listings_find.h"
#include "reference/listings_test.h"
