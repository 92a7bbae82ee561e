// SPDX-License-Identifier: BSD-3-Clause
// The distances of eight segments, each from an oriented box of its own, correctly rounded, with
// the points: the steps of generic/refine.h, a pair in each lane instead of an axis.

/// A box stretched by n = |q|^2: axis[i][j] is coordinate j of axis i.
struct StretchedBoxes {
  Wide<Double8> n;
  Wide<Double8> axis[3][3];

  explicit StretchedBoxes(const double (*quaternion)[kRefineLanes]) {
    Double8 q[3];
    Wide<Double8> squares[3];
    for (int i = 0; i < 3; ++i) {
      q[i] = load8(quaternion[i]);
      squares[i] = twoProduct(q[i], q[i]);
    }
    const Double8 real = load8(quaternion[3]);
    const Wide<Double8> real_square = twoProduct(real, real);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      const Wide<Double8> along = real_square + squares[i];
      const Wide<Double8> across = squares[j] + squares[k];
      axis[i][i] = along - across;
      if (i == 0) {
        n = along + across;
      }
      const Double8 doubled = q[i] + q[i];
      const Wide<Double8> mixed = twoProduct(doubled, q[j]);
      const Wide<Double8> turning = twoProduct(q[k] + q[k], real);
      axis[i][j] = mixed + turning;
      axis[j][i] = mixed - turning;
    }
  }

  Wide<Double8> along(int i, const Wide<Double8>* v) const {
    return sumOfProducts(axis[i][0], v[0], axis[i][1], v[1], axis[i][2], v[2]);
  }
};

static inline Wide<Double8> sumOf3(const Wide<Double8>* a) {
  const Wide<Double8> two = twoSum(a[0].hi, a[1].hi);
  const Wide<Double8> three = twoSum(two.hi, a[2].hi);
  return fastTwoSum(three.hi, (two.lo + three.lo) + ((a[0].lo + a[1].lo) + a[2].lo));
}
static inline Double8 sumOf3(const Double8* a) {
  return (a[0] + a[1]) + a[2];
}

/// Where rounding up and down is the same: Ziv's test.
static inline Mask8 isRounded(const Wide<Double8>& x, const Double8& error, Double8& value) {
  value = x.hi + (x.lo + error);
  return value == x.hi + (x.lo - error);
}

/// The points as setClosestPoints() has them, operation for operation.
/// @return where it would not scale anything
static inline Mask8 closestPoints(const RefineQueries& queries, const Double8& t,
                                  RefinedEach& refined) {
  const Double8 one = all8(1.0);
  const Double8 two = all8(2.0);
  const Double8 x = load8(queries.quaternion[0]);
  const Double8 y = load8(queries.quaternion[1]);
  const Double8 z = load8(queries.quaternion[2]);
  const Double8 w = load8(queries.quaternion[3]);
  const Double8 ww = w * w;
  const Double8 xx = x * x;
  const Double8 yy = y * y;
  const Double8 zz = z * z;
  const Double8 n = (ww + xx) + (yy + zz);
  const Double8 r = one / n;
  const Double8 r2 = two * r;
  const Double8 xy = x * y;
  const Double8 xz = x * z;
  const Double8 yz = y * z;
  const Double8 wx = w * x;
  const Double8 wy = w * y;
  const Double8 wz = w * z;
  const Double8 axes[3][3] = {{((ww - zz) + (xx - yy)) * r, (xy + wz) * r2, (xz - wy) * r2},
                              {(xy - wz) * r2, ((ww - zz) - (xx - yy)) * r, (yz + wx) * r2},
                              {(xz + wy) * r2, (yz - wx) * r2, ((ww + zz) - (xx + yy)) * r}};

  Mask8 taken =
      (n > all8(exact::bounds::kSmallestStretch)) & (all8(exact::bounds::kLargestStretch) > n);
  Double8 on_segment[3];
  Double8 center[3];
  Double8 from_center[3];
  for (int j = 0; j < 3; ++j) {
    on_segment[j] = (one - t) * load8(queries.start[j]) + t * load8(queries.end[j]);
    center[j] = load8(queries.center[j]);
    from_center[j] = on_segment[j] - center[j];
    const Double8 far = all8(0x1p1000);
    taken = taken & (far > magnitude(on_segment[j])) & (far > magnitude(center[j]));
    store8(refined.on_segment[j], on_segment[j]);
  }
  Double8 local[3];
  Mask8 inside = taken;
  for (int i = 0; i < 3; ++i) {
    const Double8 along =
        axes[i][0] * from_center[0] + axes[i][1] * from_center[1] + axes[i][2] * from_center[2];
    const Double8 half = load8(queries.half_extents[i]);
    local[i] = smaller(half, larger(negated(half), along));
    inside = inside & (local[i] == along);
  }
  for (int j = 0; j < 3; ++j) {
    const Double8 on_box =
        center[j] + (axes[0][j] * local[0] + axes[1][j] * local[1] + axes[2][j] * local[2]);
    store8(refined.on_box[j], either(inside, on_segment[j], on_box));
  }
  return taken;
}

static std::uint32_t refineTogether(const RefineQueries& queries, RefinedEach& refined) {
  using W = Wide<Double8>;
  const StretchedBoxes boxes(queries.quaternion);
  const W n = normalized(boxes.n);
  const Double8 zero = all8(0.0);
  const Double8 one = all8(1.0);
  const Double8 t = load8(queries.t);

  W from_center[3];
  W from_start[3];
  Double8 sizes[3];
  Double8 lengths[3];
  for (int j = 0; j < 3; ++j) {
    const Double8 start = load8(queries.start[j]);
    from_center[j] = twoSum(start, negated(load8(queries.center[j])));
    from_start[j] = twoSum(load8(queries.end[j]), negated(start));
    lengths[j] = magnitude(from_start[j].hi);
    sizes[j] = magnitude(from_center[j].hi) + load8(queries.half_extents[j]) + lengths[j];
  }
  const Double8 scale = sumOf3(sizes);
  const Double8 eta = all8(exact::bounds::kRow) * scale * n.hi;

  // The excess at t, and how it changes, along the axes where it is not 0.
  W excess[3];
  W v[3];
  Double8 room[3];   // how far it is outside, or, negative, inside
  Double8 drift[3];  // how far it goes along the axis as t goes to 1
  for (int i = 0; i < 3; ++i) {
    const W position = boxes.along(i, from_center);
    v[i] = normalized(boxes.along(i, from_start));
    const W moved = v[i] * t;
    const Double8 side = normalized(position + moved).hi;
    const W extent = boxes.n * load8(queries.half_extents[i]);
    excess[i] = normalized((position - withSignOf(extent, side)) + moved);
    room[i] = withSignOf(excess[i].hi, side);
    drift[i] = magnitude(v[i].hi);
    const Mask8 outside = room[i] > zero;
    excess[i] = {onlyWhere(outside, excess[i].hi), onlyWhere(outside, excess[i].lo)};
    v[i] = {onlyWhere(outside, v[i].hi), onlyWhere(outside, v[i].lo)};
  }

  // f, g, A: the squared distance there, half its slope, half its curvature.
  W squares[3];
  W slopes[3];
  Double8 curvatures[3];
  Double8 excesses[3];
  Double8 directions[3];
  for (int i = 0; i < 3; ++i) {
    squares[i] = product(excess[i], excess[i]);
    slopes[i] = product(v[i], excess[i]);
    curvatures[i] = v[i].hi * v[i].hi;
    excesses[i] = magnitude(excess[i].hi);
    directions[i] = magnitude(v[i].hi);
  }
  const W f = sumOf3(squares);
  const W g = sumOf3(slopes);
  const Double8 curvature = sumOf3(curvatures);
  const Double8 excess_sum = sumOf3(excesses);
  const Double8 slope_error = all8(4.0) * eta * (sumOf3(directions) + excess_sum);

  // t* = t - g / A, or one of the ends.
  const Mask8 at_start = (t == zero) & ((g.hi > slope_error) | (sumOf3(lengths) == zero));
  const Mask8 at_end = (t == one) & (negated(g.hi) > slope_error);
  const Mask8 at_an_end = at_start | at_end;
  const Double8 inverse = one / curvature;
  const Double8 change = zeroWhere(at_an_end, negated(g.hi * inverse));
  const Double8 curvature_error = zeroWhere(
      at_an_end, fused(all8(4.0) * eta, squareRoot(inverse), all8(16.0 * exact::bounds::kUnit)));
  const Double8 t_error =
      zeroWhere(at_an_end, slope_error * inverse) + magnitude(change) * curvature_error;
  const W nearest = twoSum(t, change);

  // f(t*) = f - g^2 / A, and one step of Newton's method for its root / n.
  const Double8 fall = change * change * zeroWhere(at_an_end, curvature);
  const W squared = fastTwoSum(f.hi, f.lo - fall);
  const Double8 inverse_n = one / n.hi;
  const Double8 stretched_root = squareRoot(squared.hi);
  const Double8 root = stretched_root * inverse_n;
  const Double8 factor = all8(0.5) * inverse_n / stretched_root;
  const W stretched = n * root;
  const W square = product(stretched, stretched);
  const Double8 rest = (squared.hi - square.hi) + (squared.lo - square.lo);
  const W distance = fastTwoSum(root, rest * factor);
  const Double8 distance_error =
      (all8(12.0) * eta * excess_sum + all8(8.0) * curvature_error * fall) * factor +
      all8(2.0 * exact::bounds::kOperation) * root;

  Double8 rounded_t;
  Double8 rounded_distance;
  Mask8 certain = isRounded(nearest, t_error, rounded_t) &
                  isRounded(distance, distance_error, rounded_distance);
  certain = certain & (at_an_end | ((rounded_t > zero) & (one > rounded_t)));
  certain = certain & (scale > all8(exact::bounds::kSmallestScale)) &
            (all8(exact::bounds::kLargestScale) > scale);
  for (int i = 0; i < 3; ++i) {
    const Double8 margin = all8(2.0) * (magnitude(change) * drift[i]) + all8(8.0) * eta;
    certain = certain & (magnitude(room[i]) > margin);
  }
  store8(refined.t, rounded_t);
  store8(refined.distance, rounded_distance);
  return bitsOf(certain & closestPoints(queries, rounded_t, refined));
}
