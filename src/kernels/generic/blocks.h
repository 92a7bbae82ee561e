// SPDX-License-Identifier: BSD-3-Clause
// A ray in float, against eight whole boxes at once: for lists so short that bounds along the axes
// of the world would not pay.
//
// With o, c relative to the center of the scene, w = c - o, e the half extents, R the axes, |.|_1
// sums of absolute values, S = |o|_1 + |c|_1 + |e|_1 and u = 2^-24: where the ray is in the box,
// |t d|_2 <= |w|_2 + |e|_2 <= S. There, along a box axis, in metres,
// - y = R^T w is off by 2u (|o|_1 + |c|_1) of w, by u |w|_2 of R and 3u |w|_2 of the sum: 6u S,
// - t R^T d by u of d, u of R and 3u of the sum: 5u S, and by t 2^-59 < 2^-39 S where it is raised,
// - the difference, the reciprocal and the product of (y -+ e) / |R^T d| by 3u (|y| + e) and
//   e by u e as a float: 7u S.
// Together 18u S and what is left of second order: planes are moved outward by kBlock of each part
// of S, so that what is computed begins before the exact entry and ends behind the exact exit. No
// product overflows: |y| + e < 2^43, 1 / |R^T d| <= 2^60.

/// Below it, |R^T d| is raised.
constexpr float kFlattestInBlock = 0x1p-60F;

/// The slots whose boxes the ray may meet between its begin and its end, a bit each.
/// @param near where it enters them, not too late
static inline std::uint32_t meets(const BoxBlock& block, const FloatRay& ray, Float8& near) {
  const Float8 pad = all8(ray.pad);
  Float8 w[3];
  Float8 d[3];
  for (int j = 0; j < 3; ++j) {
    w[j] = load8(block.center[j]) - all8(ray.origin[j]);
    d[j] = all8(ray.direction[j]);
  }
  Float8 nears[3];
  Float8 fars[3];
  for (int i = 0; i < 3; ++i) {
    const auto along = [&](const Float8* v) {
      return multiplyAdd(
          load8(block.axis[i][2]), v[2],
          multiplyAdd(load8(block.axis[i][1]), v[1], load8(block.axis[i][0]) * v[0]));
    };
    const Float8 slope = along(d);
    const Float8 inverse = all8(1.0F) / larger(magnitude(slope), all8(kFlattestInBlock));
    const Float8 middle = withSignOf(along(w), slope);
    const Float8 extent = load8(block.extent[i]) + pad;
    nears[i] = (middle - extent) * inverse;
    fars[i] = (middle + extent) * inverse;
  }
  // The end of the ray is the last that is known: a root and a quotient.
  near = larger(larger(nears[0], nears[1]), larger(nears[2], all8(ray.begin_s)));
  const Float8 far = smaller(smaller(smaller(fars[0], fars[1]), fars[2]), all8(ray.end_s));
  return notAbove(near, far);
}
