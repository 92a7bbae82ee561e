// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Every error bound of the stages in float, in one place: tests replace this file by one with
/// smaller bounds and expect wrong answers. u = 2^-24.
#pragma once

namespace box_query::kernels::bounds {

/// Rays against bounds: how far the planes are moved apart, relative to |o|_1 of the ray and the
/// size of the scene: 9u. See generic/ray.h.
constexpr double kApart = 0x1p-20;
/// Unusual rays: what the shifts of their planes lack, relative to |o_i r_i|: 5.3u. See
/// generic/unusual_ray.h.
constexpr double kShiftError = 0x1p-20;
/// And the parameters at the planes, relative to the end of the ray: 4.2u.
constexpr double kAlongError = 0x1p-20;
/// How far the planes of an axis are moved apart along which a ray hardly goes, times its end: more
/// than 2.
constexpr double kFlat = 2.1;
/// Rays against whole boxes: how far their planes are moved outward, relative to |P - M|_1 of the
/// ray, and to |C - M|_1 + |e|_1 of the box, M the center of the scene: 19u. See generic/blocks.h.
constexpr double kBlock = 0x1p-19;
/// And how far inward, so that what is in between is certainly in the box: 41u.
constexpr double kInBlock = 0x1p-18;
/// Radii, as planes are moved outward by them: three of one are added to S, and 27u of one to the
/// error of bounds, 57u to that of blocks, and what a float rounds it by.
constexpr double kWithin = 1.0 + 0x1p-16;
/// Numbers that are rounded to float upward by it.
constexpr double kUp = 1.0 + 0x1p-20;
/// More than what is lost where floats underflow.
constexpr double kFloatUnderflow = 0x1p-100;

/// Segments: distances, relative to themselves and to |o|_1 + |d|_1: 24u. See generic/nearest.h.
constexpr double kLoss = 0x1p-19;
/// Estimates of a quotient by a root, relative.
constexpr double kRoughRoot = 0x1p-11;
/// More than a distance whose square a float cannot hold.
constexpr double kShortest = 0x1p-60;

}  // namespace box_query::kernels::bounds
