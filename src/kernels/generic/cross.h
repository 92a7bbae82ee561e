// SPDX-License-Identifier: BSD-3-Clause
// Where a component enters and leaves an oriented box, in double-double, the three axes of the box
// side by side: the frame and the clipping of exact/clip.h.

/// Whether one axis alone may bound the interval; where the others certainly do not, it does.
static inline bool isOne(unsigned bits) {
  return (bits & (bits - 1)) == 0;
}

static Crossed cross(const CrossingQuery& query, Crossing& enter, Crossing& exit) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Double4 origin = lanes4(query.origin);
  const Double4 center = lanes4(query.center);
  const Double4 direction = lanes4(query.direction);
  const Double4 half_extents = lanes4(query.half_extents);

  const WideFrame frame = wideFrame(query.quaternion);
  const Wide4& n = frame.n;
  const Wide4 offset = twoSum(origin, negated(center));
  const Wide4 position = frame.along(offset);
  const Wide4 den = normalized(frame.along({direction, lanes4(query.direction_low)}));
  const Wide4 extent = n * half_extents;

  // num and den are off by less than bounds::kRow n times what they are made of.
  const Double4 unit = all4(exact::bounds::kRow) * n.hi;
  const Double4 num_error = unit * (sumOf3(magnitude(offset.hi)) + sumOf3(half_extents));
  const Double4 den_error = unit * sumOf3(magnitude(direction));

  // With s the sign of d, (-s E - y) / d and (s E - y) / d: first in double, off by 3u, which is
  // enough to see which of them count.
  const Double4 inverse = all4(1.0) / den.hi;
  const Wide4 half = withSignOf(extent, den.hi);
  const Wide4 num_far = normalized(half - position);
  const Wide4 minus_num_near = normalized(half + position);
  const Double4 far_double = num_far.hi * inverse;
  const Double4 minus_near_double = minus_num_near.hi * inverse;

  // The error of num / den is (num_error + |t| den_error) / |den| and the quotient's own.
  const Double4 steepness = magnitude(inverse);
  const Double4 constant_error = all4(exact::bounds::kRelative) * (num_error * steepness);
  const Double4 relative_error =
      all4(exact::bounds::kRelative) * fused(den_error, steepness, all4(exact::bounds::kOperation));

  // Enclosures in double. What hardly moves along an axis, |d| <= 2^30 den_error, moves by less
  // than 2^32 num_error within the box: it stays between the planes, or outside, or nothing is
  // clear. What extent and position have in their second parts, up to 12u n (S + E) in the terms of
  // bounds::kRow, is below 2^50 num_error.
  const Double4 is_flat = isNotBelow(all4(0x1p30) * den_error, magnitude(den.hi));
  const Double4 room = extent.hi - magnitude(position.hi);
  const Double4 drift = all4(0x1p50) * num_error;
  const unsigned flat = signs3(is_flat);
  const unsigned inside = notBelow3(room, drift);
  if ((flat & ~inside) != 0) {
    return (flat & notBelow3(negated(room), drift)) != 0 ? Crossed::kMiss : Crossed::kUnclear;
  }
  constexpr double kWidth = 0x1p-50;  // more than what the double lacks, and what sums lose
  const Double4 constant_width = constant_error + constant_error;
  const Double4 relative_width = (relative_error + relative_error) + all4(kWidth);
  const auto widthOf = [&](Double4 t) {
    return fused(magnitude(t), relative_width, constant_width);
  };
  const Double4 near_double = negated(minus_near_double);
  const Double4 near_width = widthOf(near_double);
  const Double4 far_width = widthOf(far_double);
  const Double4 minus_infinity = all4(-kInfinity);
  const Double4 plus_infinity = all4(kInfinity);
  const Double4 near_lo = choose(near_double - near_width, minus_infinity, is_flat);
  const Double4 near_hi = choose(near_double + near_width, minus_infinity, is_flat);
  const Double4 far_lo = choose(far_double - far_width, plus_infinity, is_flat);
  const Double4 far_hi = choose(far_double + far_width, plus_infinity, is_flat);
  const Pair last_near = largest3(near_lo, near_hi);
  const Pair first_far = smallest3(far_lo, far_hi);
  const double start = query.has_start ? 0.0 : -kInfinity;
  const double end = query.has_end ? 1.0 : kInfinity;
  const auto larger = [](double a, double b) { return a > b ? a : b; };
  const auto smaller = [](double a, double b) { return a < b ? a : b; };
  if (larger(last_near.first, start) > smaller(first_far.second, end)) {
    return Crossed::kMiss;
  }
  const unsigned may_enter = notBelow3(near_hi, all4(last_near.first));
  const unsigned may_leave = notBelow3(all4(first_far.second), far_lo);
  const bool from_start = last_near.second < start;
  const bool to_end = first_far.first > end;
  const bool certain = larger(last_near.second, start) < smaller(first_far.first, end) &&
                       (from_start || (isOne(may_enter) && last_near.first > start)) &&
                       (to_end || (isOne(may_leave) && first_far.second < end));
  if (!certain) {
    return Crossed::kUnclear;
  }

  const Wide4 minus_near = quotient(minus_num_near, den, minus_near_double, inverse);
  const Wide4 far = quotient(num_far, den, far_double, inverse);
  const auto errorOf = [&](Double4 t) {
    return fused(magnitude(t), relative_error, constant_error);
  };
  alignas(32) double lanes[6][4];
  store4(lanes[0], negated(minus_near.hi));
  store4(lanes[1], negated(minus_near.lo));
  store4(lanes[2], errorOf(minus_near_double));
  store4(lanes[3], far.hi);
  store4(lanes[4], far.lo);
  store4(lanes[5], errorOf(far_double));
  const unsigned goes_down = signs3(den.hi);
  if (from_start) {
    enter = {Crossing::kOwn, false, {0.0, 0.0}, 0.0};
  } else {
    const int axis = lowestBit(may_enter);
    enter = {
        axis, ((goes_down >> axis) & 1U) != 0, {lanes[0][axis], lanes[1][axis]}, lanes[2][axis]};
  }
  if (to_end) {
    exit = {Crossing::kOwn, false, {1.0, 0.0}, 0.0};
  } else {
    const int axis = lowestBit(may_leave);
    exit = {
        axis, ((goes_down >> axis) & 1U) == 0, {lanes[3][axis], lanes[4][axis]}, lanes[5][axis]};
  }
  return Crossed::kHit;
}
