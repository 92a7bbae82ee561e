// SPDX-License-Identifier: BSD-3-Clause
// The distance of a segment from an oriented box, and where it is nearest, in double-double, the
// three axes of the box side by side: the steps of geometry/distance_refine.cpp, with its bounds.
//
// In its terms, sums that are not normalized (generic/wide.h) add to the error of the start seen
// from a face up to 77u^2 n (S + E), of the direction 42u^2 n D (bounds::kRow), and of what
// normalizes them 20u^2 n (S + E + D), where a second part may be larger than the first: less than
// eta = 128u^2 n (S + E + D) and, of an excess, 2.4 eta. g is within 3 eta (|v|_1 + |ex|_1).
//
// All that it is told is a parameter t near the nearest point. Which faces the segment is outside
// of there it sees for itself, and takes no box where it may have other sides on the way to the
// nearest point: an excess moves by |change v_i|, and is off by 2.4 eta, and where the middle of
// the box is so close that it is taken from the wrong side, it says inside if 2.4 eta lie between
// the middle and the face.

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
  const Double4 extents = lanes4(query.half_extents);
  const Double4 t = all4(query.t);
  const Double4 zero = all4(0.0);
  const WideFrame frame = wideFrame(query.quaternion);
  const Wide4 n = normalized(frame.n);
  const Wide4 from_center = twoSum(start, negated(center));
  const Wide4 from_start = twoSum(lanes4(query.end), negated(start));
  const Double4 length = magnitude(from_start.hi);
  const Double4 scale = sumOf3(magnitude(from_center.hi) + extents + length);
  const Double4 eta = all4(exact::bounds::kRow) * scale * n.hi;

  // The excess at t, and how it changes, along the axes where it is not 0.
  const Wide4 position = frame.along(from_center);
  const Wide4 along = normalized(frame.along(from_start));
  const Wide4 moved = along * t;
  const Double4 side = normalized(position + moved).hi;
  const Wide4 beyond = normalized((position - withSignOf(frame.n * extents, side)) + moved);
  const Double4 room = withSignOf(beyond.hi, side);
  const auto outsideOnly = [&](const Wide4& a) {
    const Double4 outside = larger(room, zero);
    return Wide4{orZeroWhereZero(a.hi, outside), orZeroWhereZero(a.lo, outside)};
  };
  const Wide4 excess = outsideOnly(beyond);
  const Wide4 v = outsideOnly(along);

  // f, g, A: the squared distance there, half its slope, half its curvature.
  const Wide4 f = wideSumOf3(product(excess, excess));
  const Wide4 g = wideSumOf3(product(v, excess));
  const Double4 curvature = sumOf3(v.hi * v.hi);
  const Double4 excess_sum = sumOf3(magnitude(excess.hi));
  const Double4 slope_error = all4(4.0) * eta * (sumOf3(magnitude(v.hi)) + excess_sum);

  // t* = t - g / A, or one of the ends.
  const double slope = firstLane(g.hi);
  const double slope_slack = firstLane(slope_error);
  const bool at_start = query.t == 0.0 && (slope > slope_slack || firstLane(sumOf3(length)) == 0.0);
  const bool at_end = query.t == 1.0 && -slope > slope_slack;
  const bool is_inside = !at_start && !at_end;
  const Double4 inside = all4(is_inside ? 1.0 : 0.0);
  const Double4 inverse = all4(1.0) / curvature;
  const Double4 change = orZeroWhereZero(negated(g.hi * inverse), inside);
  const Double4 curvature_error = orZeroWhereZero(
      fused(all4(4.0) * eta, squareRoot(inverse), all4(16.0 * exact::bounds::kUnit)), inside);
  const Double4 t_error =
      orZeroWhereZero(slope_error * inverse, inside) + magnitude(change) * curvature_error;
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

  const Double4 margin = all4(2.0) * (magnitude(change) * magnitude(along.hi)) + all4(8.0) * eta;
  const double stretch = firstLane(n.hi);
  const double size = firstLane(scale);
  refined.inside = is_inside;
  refined.t[0] = firstLane(nearest.hi);
  refined.t[1] = firstLane(nearest.lo);
  refined.t_error = firstLane(t_error);
  refined.distance[0] = firstLane(distance.hi);
  refined.distance[1] = firstLane(distance.lo);
  refined.distance_error = firstLane(distance_error);
  return notBelow3(magnitude(room), margin) == 7U && stretch >= exact::bounds::kSmallestStretch &&
         stretch <= exact::bounds::kLargestStretch && size >= exact::bounds::kSmallestScale &&
         size <= exact::bounds::kLargestScale;
}
