// SPDX-License-Identifier: BSD-3-Clause
// A segment and one box in double, the three axes of the box side by side: the estimate of
// geometry/distance_query.h, with the bounds of geometry/distance_filter.h. Fused operations round
// less often, so that its derivation covers them.

/// A segment in the frame of a box; the fourth lanes are nothing.
struct LaneSlabs {
  Double4 below;
  Double4 above;
  Double4 direction;
};

static inline LaneSlabs laneSlabs(const BoxRecord& box, const SegmentQuery& query) {
  if (box.isAligned()) {
    const Double4 start = lanes4(query.start);
    return {load4(box.column[0]) - start, load4(box.column[1]) - start, lanes4(query.end) - start};
  }
  Double4 from_center[3];
  Double4 from_start[3];
  for (int j = 0; j < 3; ++j) {
    from_center[j] = all4(query.start[j]) - all4(box.column[j][3]);
    from_start[j] = all4(query.end[j]) - all4(query.start[j]);
  }
  const auto along = [&](const Double4* v) {
    return fused(load4(box.column[2]), v[2],
                 fused(load4(box.column[1]), v[1], load4(box.column[0]) * v[0]));
  };
  const Double4 y = along(from_center);
  const Double4 extent = load4(box.extent);
  return {negated(extent) - y, extent - y, along(from_start)};
}

static inline Double4 excessAt(const LaneSlabs& s, double t) {
  const Double4 x = all4(t) * s.direction;
  return x - smaller(larger(x, s.below), s.above);
}

/// What errors are relative to.
static inline double scaleOf(const LaneSlabs& s) {
  return sum3(larger(magnitude(s.below), magnitude(s.above)) + magnitude(s.direction));
}
static inline bool isInRange(double scale) {
  return scale >= exact::bounds::kSmallestScale && scale <= exact::bounds::kLargestScale;
}

/// Whether the point at t in [0, 1] is certainly in the box.
static inline bool isInBox(const LaneSlabs& s, double scale, double t) {
  const Double4 x = all4(t) * s.direction;
  const Double4 error = all4(exact::bounds::kDistance * scale);
  return isInRange(scale) && notBelow3(smaller(x - s.below, s.above - x), error) == 7U;
}

/// A parameter near the one where the distance is smallest.
static inline double guessNearest(const LaneSlabs& s, double scale) {
  const Double4 d = s.direction;
  const double start_slope = sum3(d * excessAt(s, 0.0));
  const double end_slope = sum3(d * excessAt(s, 1.0));
  if (static_cast<int>(start_slope >= 0.0) | static_cast<int>(end_slope <= 0.0)) {  // one jump
    return start_slope >= 0.0 ? 0.0 : 1.0;
  }
  // The slope g = d.ex rises, linearly between break points, from negative to positive: Newton's
  // method, kept in its bracket. The first guess is right where no break point lies between.
  const Double4 squares = d * d;
  const double noise = 4.0 * exact::bounds::kUnit * scale * sum3(magnitude(d));
  double lower = 0.0;
  double upper = 1.0;
  double t = start_slope / (start_slope - end_slope);
  for (int step = 0; step < 12; ++step) {
    const Double4 excess = excessAt(s, t);
    const double slope = sum3(d * excess);
    if (!(std::fabs(slope) > noise)) {
      break;
    }
    (slope < 0.0 ? lower : upper) = t;
    t -= slope / sum3(orZeroWhereZero(squares, excess));
    if (!(t > lower && t < upper)) {
      t = 0.5 * (lower + upper);
    }
  }
  return t;
}

static inline void estimate(const BoxRecord& box, const SegmentQuery& query, NearBox& near) {
  const LaneSlabs s = laneSlabs(box, query);
  near.scale = scaleOf(s);
  near.t = guessNearest(s, near.scale);
  const Double4 excess = excessAt(s, near.t);
  store4(near.below, s.below);
  store4(near.above, s.above);
  store4(near.direction, s.direction);
  store4(near.excess, excess);

  const Double4 face = choose(s.above, s.below, excess);
  const double length = std::sqrt(sum3(excess * excess));
  const double at_start = -sum3(excess * face);
  const double at_end = at_start + sum3(excess * s.direction);
  const double least = at_start < at_end ? at_start : at_end;
  const double error = exact::bounds::kDistance * near.scale;
  near.lower = length > 0.0 ? least / length - error : 0.0;
  near.upper = isInBox(s, near.scale, near.t) ? 0.0 : length + error;
  if (!isInRange(near.scale)) {
    near.lower = 0.0;
    near.upper = std::numeric_limits<double>::infinity();
  }
}
