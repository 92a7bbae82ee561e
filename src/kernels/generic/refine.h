// SPDX-License-Identifier: BSD-3-Clause
// The distance of a segment from an oriented box, and where it is nearest, in double-double, the
// three axes of the box side by side: the steps of geometry/distance_refine.cpp, with its bounds.
//
// In its terms, sums that are not normalized (generic/wide.h) add to the error of the start seen
// from a face up to 77u^2 n (S + E), of the direction 42u^2 n D (bounds::kRow), and of what
// normalizes them 20u^2 n (S + E + D), where a second part may be larger than the first: with
// S + E + D <= 1.74 s less than eta = 256u^2 n s and, of an excess, 2.4 eta.

/// The sum of the first three lanes, in the first.
static inline Wide4 wideSumOf3(const Wide4& a) {
  const Wide4 two = twoSum(a.hi, turned(a.hi));
  const Wide4 three = twoSum(two.hi, turnedTwice(a.hi));
  return fastTwoSum(three.hi, (two.lo + three.lo) + sumOf3(a.lo));
}

/// a b, the second part of what is not normalized and their product left out.
template <typename Lanes>
static inline Wide<Lanes> product(const Wide<Lanes>& a, const Wide<Lanes>& b) {
  const Wide<Lanes> p = twoProduct(a.hi, b.hi);
  return {p.hi, fused(a.hi, b.lo, fused(a.lo, b.hi, p.lo))};
}

static bool refine(const RefineQuery& query, Refined& refined) {
  const Double4 start = lanes4(query.start);
  const Double4 center = lanes4(query.center);
  const Double4 sides = lanes4(query.sides);
  const Double4 t = all4(query.t);
  const WideFrame frame = wideFrame(query.quaternion);
  const Wide4 n = normalized(frame.n);
  const double stretch = firstLane(n.hi);
  if (!(stretch >= exact::bounds::kSmallestStretch && stretch <= exact::bounds::kLargestStretch)) {
    return false;
  }

  // The excess at t, and how it changes, along the axes where it is not 0.
  const auto orZero = [&](const Wide4& a) {
    return Wide4{orZeroWhereZero(a.hi, sides), orZeroWhereZero(a.lo, sides)};
  };
  const Wide4 position = frame.along(twoSum(start, negated(center)));
  const Wide4 v = orZero(normalized(frame.along(twoSum(lanes4(query.end), negated(start)))));
  const Wide4 extent = frame.n * lanes4(query.half_extents);
  const Wide4 excess = orZero(normalized((position - withSignOf(extent, sides)) + v * t));

  // f, g, A: the squared distance there, half its slope, half its curvature.
  const Wide4 f = wideSumOf3(product(excess, excess));
  const Wide4 g = wideSumOf3(product(v, excess));
  const Double4 curvature = sumOf3(v.hi * v.hi);
  const Double4 excess_sum = sumOf3(magnitude(excess.hi));
  const Double4 direction_sum = sumOf3(magnitude(v.hi));

  // t* = t - g / A, or one of the ends.
  const Double4 eta = all4(exact::bounds::kRow * 2.0 * query.scale) * n.hi;
  const Double4 inside = all4(query.inside ? 1.0 : 0.0);
  const Double4 inverse = all4(1.0) / curvature;
  const Double4 change = orZeroWhereZero(negated(g.hi * inverse), inside);
  const Double4 curvature_error = orZeroWhereZero(
      fused(all4(4.0) * eta, squareRoot(inverse), all4(16.0 * exact::bounds::kUnit)), inside);
  const Double4 t_error =
      orZeroWhereZero(all4(4.0) * eta * (direction_sum + excess_sum) * inverse, inside) +
      magnitude(change) * curvature_error;
  const Wide4 nearest = twoSum(t, change);

  // f(t*) = f - g^2 / A, and one step of Newton's method for its root / n.
  const Double4 fall = change * change * orZeroWhereZero(curvature, inside);
  const Wide4 squared = fastTwoSum(f.hi, f.lo - fall);
  const Double4 inverse_n = all4(1.0) / n.hi;
  const Double4 stretched_root = squareRoot(squared.hi);
  const Double4 root = stretched_root * inverse_n;
  const Double4 factor = all4(0.5) * inverse_n / stretched_root;
  const Wide4 stretched = n * root;
  const Wide4 square = product(stretched, stretched);
  const Double4 rest = (squared.hi - square.hi) + (squared.lo - square.lo);
  const Wide4 distance = fastTwoSum(root, rest * factor);
  const Double4 distance_error =
      (all4(12.0) * eta * excess_sum + all4(8.0) * curvature_error * fall) * factor +
      all4(2.0 * exact::bounds::kOperation) * root;

  refined.change = firstLane(change);
  refined.t[0] = firstLane(nearest.hi);
  refined.t[1] = firstLane(nearest.lo);
  refined.t_error = firstLane(t_error);
  refined.distance[0] = firstLane(distance.hi);
  refined.distance[1] = firstLane(distance.lo);
  refined.distance_error = firstLane(distance_error);
  return true;
}
