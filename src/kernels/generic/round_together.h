// SPDX-License-Identifier: BSD-3-Clause
// The distances of eight segments, each from the box of a record of its own, correctly rounded,
// with the points: the steps of generic/refine.h and generic/round_nearest.h, a pair in each lane
// instead of an axis.

/// Eight boxes: axis[i][j] is coordinate j of axis i, as in a BoxFrame.
struct BoxesInLanes {
  Wide<Double8> axis[3][3];
  Double8 center[3];
  Double8 extents[3];
  Mask8 oriented;

  BoxesInLanes(const SceneView& view, const std::uint32_t* records) {
    Double4 rows[kRoundLanes];
    Double8 columns[4];
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < kRoundLanes; ++k) {
        rows[k] = load4(view.records[records[k]].column[j]);
      }
      transpose(rows, columns);
      for (int i = 0; i < 3; ++i) {
        axis[i][j].hi = columns[i];
      }
      center[j] = columns[3];
      for (int k = 0; k < kRoundLanes; ++k) {
        rows[k] = asDoubles(view.rests[records[k]].column[j]);
      }
      transpose(rows, columns);
      for (int i = 0; i < 3; ++i) {
        axis[i][j].lo = columns[i];
      }
    }
    for (int k = 0; k < kRoundLanes; ++k) {
      rows[k] = load4(view.records[records[k]].extent);
    }
    transpose(rows, columns);
    for (int i = 0; i < 3; ++i) {
      extents[i] = columns[i];
    }
    oriented = columns[3] > all8(0.0);  // see BoxRecord
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

/// Eight segments.
struct SegmentsInLanes {
  Double8 start[3];
  Double8 end[3];

  explicit SegmentsInLanes(const double* const* segments) {
    Double4 rows[kRoundLanes];
    Double8 columns[4];
    for (int k = 0; k < kRoundLanes; ++k) {
      rows[k] = loadAny4(segments[k]);
    }
    transpose(rows, columns);
    for (int j = 0; j < 3; ++j) {
      start[j] = columns[j];
    }
    for (int k = 0; k < kRoundLanes; ++k) {
      rows[k] = loadAny4(segments[k] + 2);
    }
    transpose(rows, columns);
    for (int j = 0; j < 3; ++j) {
      end[j] = columns[j + 1];
    }
  }
};

/// @param numbers of each eight
static inline void storeEach(const Double8* numbers, double* const* to) {
  Double4 rows[kRoundLanes];
  for (int half = 0; half < 2; ++half) {
    transpose(numbers + 4 * half, rows);
    for (int k = 0; k < kRoundLanes; ++k) {
      storeAny4(to[k] + 4 * half, rows[k]);
    }
  }
}

/// The points as setClosestPoints() has them, operation for operation.
static inline void setClosestPoints(const BoxesInLanes& boxes, const SegmentsInLanes& segments,
                                    const Double8& t, Double8* on_segment, Double8* on_box) {
  Double8 from_center[3];
  for (int j = 0; j < 3; ++j) {
    on_segment[j] = (all8(1.0) - t) * segments.start[j] + t * segments.end[j];
    from_center[j] = on_segment[j] - boxes.center[j];
  }
  Double8 local[3];
  Mask8 inside = boxes.oriented;
  for (int i = 0; i < 3; ++i) {
    const Double8 along = boxes.axis[i][0].hi * from_center[0] +
                          boxes.axis[i][1].hi * from_center[1] +
                          boxes.axis[i][2].hi * from_center[2];
    local[i] = smaller(boxes.extents[i], larger(negated(boxes.extents[i]), along));
    inside = inside & (local[i] == along);
  }
  for (int j = 0; j < 3; ++j) {
    const Double8 outside =
        boxes.center[j] + (boxes.axis[0][j].hi * local[0] + boxes.axis[1][j].hi * local[1] +
                           boxes.axis[2][j].hi * local[2]);
    on_box[j] = either(inside, on_segment[j], outside);
  }
}

static std::uint32_t roundTogether(const SceneView& view, const RoundQueries& queries) {
  using W = Wide<Double8>;
  const BoxesInLanes boxes(view, queries.record);
  const SegmentsInLanes segments(queries.segment);
  const Double8 zero = all8(0.0);
  const Double8 one = all8(1.0);
  const Double8 t = load8(queries.t);

  W from_center[3];
  W from_start[3];
  Double8 sizes[3];
  Double8 lengths[3];
  for (int j = 0; j < 3; ++j) {
    from_center[j] = twoSum(segments.start[j], negated(boxes.center[j]));
    from_start[j] = twoSum(segments.end[j], negated(segments.start[j]));
    lengths[j] = magnitude(from_start[j].hi);
    sizes[j] = magnitude(from_center[j].hi) + boxes.extents[j] + lengths[j];
  }
  const Double8 scale = sumOf3(sizes);
  const Double8 eta = all8(exact::bounds::kRests) * scale;

  // The excess at t, and how it changes, along the axes where it is not 0.
  W excess[3];
  W v[3];
  Double8 room[3];   // how far it is outside, or, negative, inside
  Double8 drift[3];  // how far it goes along the axis as t goes to 1
  for (int i = 0; i < 3; ++i) {
    const W position = normalized(boxes.along(i, from_center));
    const W direction = normalized(boxes.along(i, from_start));
    const W moved = direction * t;
    const Double8 side = position.hi + moved.hi;
    const W start_beyond = twoSum(position.hi, negated(withSignOf(boxes.extents[i], side)));
    const W beyond = normalized(W{start_beyond.hi, start_beyond.lo + position.lo} + moved);
    room[i] = withSignOf(beyond.hi, side);
    drift[i] = magnitude(direction.hi);
    const Mask8 outside = room[i] > zero;
    excess[i] = {onlyWhere(outside, beyond.hi), onlyWhere(outside, beyond.lo)};
    v[i] = {onlyWhere(outside, direction.hi), onlyWhere(outside, direction.lo)};
  }

  // f, g, A: the squared distance there, half its slope, half its curvature.
  W squares[3];
  W slopes[3];
  Double8 curvatures[3];
  for (int i = 0; i < 3; ++i) {
    squares[i] = product(excess[i], excess[i]);
    slopes[i] = product(v[i], excess[i]);
    curvatures[i] = v[i].hi * v[i].hi;
  }
  const auto all = [](double x) { return all8(x); };
  const SquaredDistance<Double8> squared(sumOf3(squares), sumOf3(slopes), sumOf3(curvatures), eta,
                                         all);

  const Double8& slope = squared.g.hi;
  const Mask8 at_start = (t == zero) & ((slope > squared.slope_error) | (sumOf3(lengths) == zero));
  const Mask8 at_end = (t == one) & (negated(slope) > squared.slope_error);
  const Mask8 at_an_end = at_start | at_end;
  const Double8 inverse = zeroWhere(at_an_end, one / squared.curvature);
  const Lowest<Double8> lowest = lowestOf(squared, inverse, t, eta, all);

  Double8 rounded[8];
  Double8& rounded_t = rounded[1];
  Mask8 certain = isRounded(lowest.t, lowest.t_error, rounded_t) &
                  isRounded(lowest.distance, lowest.distance_error, rounded[0]) & boxes.oriented;
  certain = certain & (at_an_end | ((rounded_t > zero) & (one > rounded_t)));
  certain = certain & (scale > all8(exact::bounds::kSmallestScale)) &
            (all8(exact::bounds::kLargestScale) > scale);
  const Double8 slack = all8(8.0) * eta + all8(16.0 * exact::bounds::kUnit) * scale;
  for (int i = 0; i < 3; ++i) {
    const Double8 margin = all8(2.0) * (magnitude(lowest.change) * drift[i]) + slack;
    certain = certain & (magnitude(room[i]) > margin);
  }
  setClosestPoints(boxes, segments, rounded_t, rounded + 2, rounded + 5);
  storeEach(rounded, queries.rounded);
  return bitsOf(certain);
}
