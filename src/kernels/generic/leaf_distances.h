// SPDX-License-Identifier: BSD-3-Clause
// A segment in float and the boxes of a leaf, turned as they are, sixteen at once: how far away
// they are at least and at most.
//
// The bounds are those of geometry/distance_filter.h: with w the excess at any t, the distance is
// at most |w|, and at least that of the nearer end of the segment from the plane across w that
// touches the box. The closer t is to the nearest point, the closer are the bounds.
//
// With o, c relative to the center of the scene, o = p + c, S = |o|_1 + |c|_1 + |e|_1 + |d|_1 and u
// = 2^-24: o, c and p are off by 2u (|o|_1 + |c|_1) together, the axes by u, a dot product by 3u: y
// = R^T p by 6u S, v = R^T d by 5u S, x = y + t v by 8u S, an excess by 9u S, and its length by 16u
// S. A plane is off by sqrt(3) times what y and v are, and by 5u S of dot products and sums: 16u S.
// kLoss covers that, and kRoughRoot the quotient by |w|.

/// Of boxes that may be the nearest.
struct LeafDistances {
  Float16 lower;  ///< NaN for an empty slot
  Float16 upper;  ///< +inf for an empty slot
  Float16 t;      ///< about where it is nearest
};

static inline LeafDistances leafDistances(const LeafBoxes& boxes, const FloatSegment& segment) {
  const auto shortest = static_cast<float>(bounds::kShortest);
  const auto rough = static_cast<float>(bounds::kRoughRoot);
  const Float16 zero = all16(0.0F);
  const Float16 one = all16(1.0F);
  const Float16 tiny = all16(shortest * shortest);
  const auto dot = [](const Float16* a, const Float16* b) {
    return multiplyAdd(a[2], b[2], multiplyAdd(a[1], b[1], a[0] * b[0]));
  };
  Float16 p[3];
  Float16 d[3];
  for (int j = 0; j < 3; ++j) {
    p[j] = all16(segment.origin[j]) - load16(boxes.center[j]);
    d[j] = all16(segment.direction[j]);
  }
  Float16 y[3];
  Float16 v[3];
  Float16 e[3];
  for (int i = 0; i < 3; ++i) {
    const Float16 axis[3] = {load16(boxes.axis[i][0]), load16(boxes.axis[i][1]),
                             load16(boxes.axis[i][2])};
    y[i] = dot(axis, p);
    v[i] = dot(axis, d);
    e[i] = load16(boxes.extent[i]);
  }
  const auto excess = [&](const Float16& x, int i) {
    return x - smaller(larger(x, zero - e[i]), e[i]);
  };
  Float16 w[3];
  // From the point nearest to the center of a box, one step of Newton's method.
  Float16 t = larger(smaller(dot(p, d) * all16(segment.minus_inverse), one), zero);
  for (int step = 0; step < 2; ++step) {
    for (int i = 0; i < 3; ++i) {
      w[i] = excess(multiplyAdd(t, v[i], y[i]), i);
    }
    if (step == 0) {
      Float16 curvature = tiny;
      for (int i = 0; i < 3; ++i) {
        curvature = curvature + orZeroWhereZero(v[i] * v[i], w[i]);
      }
      t = larger(smaller(t - roughQuotient(dot(v, w), curvature), one), zero);
    }
  }
  const Float16 squared = dot(w, w) + tiny;
  const Float16 size[3] = {magnitude(w[0]), magnitude(w[1]), magnitude(w[2])};
  const Float16 least = (dot(w, y) - dot(size, e)) + smaller(dot(w, v), zero);
  const Float16 error = all16(segment.slack) + load16(boxes.error);
  const Float16 nowhere = all16(std::numeric_limits<float>::infinity());
  return {roughOverRoot(least, squared) * all16(1.0F - rough) - error,
          smaller(roughOverRoot(squared, squared) * all16(1.0F + rough) + error, nowhere), t};
}
