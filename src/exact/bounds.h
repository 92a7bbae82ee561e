// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Every error bound of the library, in one place: tests replace this file by one with smaller
/// bounds and expect wrong answers.
///
/// u = 2^-53, |v|_1 the sum of absolute values. P, D: origin and direction; C, e, R: center, half
/// extents and exact rotation of a box; S = |P - C|_1, E = |e|_1. Second-order terms are covered by
/// rounding every sum up to the next power of two.
#pragma once

namespace box_query::exact::bounds {

constexpr double kUnit = 0x1p-53;

/// Oriented slab in double: eta = kSlab (S + E) is more than the distance, along a box axis,
/// between the computed and the exact point of the component wherever either lies in the box.
///
/// - An entry of R: squares and three sums 4u, |q|^2 4u, reciprocal u, product u: within 10u.
/// - y = R^T (P - C): 10u S from R, u S from the difference, 3u S from the dot product: 14u S.
/// - d = R^T D likewise 14u |D|_1 (the direction of a segment is a rounded difference).
/// - In the box |t| |D|_1 <= sqrt(3) |t D|_2 <= 1.74 (S + E), so that t d is off by 25u (S + E).
/// - Slab: reciprocal, two products and a sum: 3u |y| + 4u e.
/// Together 42u S + 29u E.
constexpr double kSlab = 64 * kUnit;

/// Aligned slab in double: (bound - P) * (1 / D), of which every factor and the product is off by u
/// (the direction of a segment by another u): 4u relative.
constexpr double kAlignedSlab = 8 * kUnit;
/// More than underflow can add to eta.
constexpr double kUnderflow = 0x1p-960;

/// Double-double rows of the unnormalised frame (n = |q|^2, M = n R). Where every sum is
/// normalised, n and M are within 12u^2 n, a dot product of three adds 22u^2 n |v|_1, so that d is
/// within 34u^2 n |D|_1; +-n e - y adds 14u^2 n e and 3u^2 n (S + e). Where sums are not
/// (kernels/generic/wide.h), n and M are within 8u^2 n and their second parts below 3u n, a dot
/// product adds 34u^2 n |v|_1, +-n e - y another 12u^2 n e and 23u^2 n (S + E): together 77u^2.
constexpr double kRow = 128 * kUnit * kUnit;
/// Coordinates along axes of kernels/generic/box_frame.h, relative to what they are made of. Those
/// of a quaternion: 128u^2, a dot product 40u^2, what is added to it 40u^2. Those of a record: what
/// a float takes from the rest, which is below 10u.
constexpr double kFrame = 512 * kUnit * kUnit;
constexpr double kRests = 16 * 0x1p-24 * kUnit;
/// Quotient, product or square root of double-doubles, relative, including the final sum of Ziv's
/// test: at most 32u^2.
constexpr double kOperation = 64 * kUnit * kUnit;

/// Relative safety of bounds that are themselves computed in double, and of sums of relative errors
/// below 2^-30.
constexpr double kRelative = 1.0 + 0x1p-20;
/// Relative safety for bounds that are themselves computed in double.
constexpr double kInflate = 1.0 + 0x1p-40;

/// Magnitudes that the stages in double take; the exact stage takes the rest. No product of the
/// filter overflows.
constexpr double kLargest = 0x1p100;
/// And the smallest ones but 0: differences of them are multiples of 2^-852, and the aligned slab
/// never underflows.
constexpr double kTiniest = 0x1p-800;
/// Smallest non-zero component of a direction, and smallest largest one, that a filter takes.
constexpr double kSmallestComponent = 0x1p-200;
constexpr double kSmallestDirection = 0x1p-100;
/// Double-double needs more: where every input is 0 or at least this, all values of the frame are
/// multiples of 2^-456, products of two of them of 2^-912, and no error term underflows.
constexpr double kSmallest = 0x1p-100;
/// Raising |d_i| to this moves a point in the box by less than 2^-199 (S + E).
constexpr double kFlattest = 0x1p-300;

}  // namespace box_query::exact::bounds
