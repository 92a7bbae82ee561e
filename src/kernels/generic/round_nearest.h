// SPDX-License-Identifier: BSD-3-Clause
// The distance of a segment to the box of a record, correctly rounded, with the points.

/// The points as setClosestPoints() has them, operation for operation.
/// @pre nothing is so large that it would scale it
static inline void setClosestPoints(const BoxRecord& box, Double4 center, Double4 start,
                                    Double4 end, RoundedNearest& nearest) {
  const Double4 t = all4(nearest.t);
  const Double4 on_segment = (all4(1.0) - t) * start + t * end;
  const Double4 from_center = on_segment - center;
  Double4 axis[3];  // as it is in the record: coordinate j of the axes
  for (int j = 0; j < 3; ++j) {
    axis[j] = load4(box.column[j]);
  }
  const Double4 along = (axis[0] * spread<0>(from_center) + axis[1] * spread<1>(from_center)) +
                        axis[2] * spread<2>(from_center);
  const Double4 half = load4(box.extent);
  const Double4 local = smaller(half, larger(negated(half), along));
  transpose3(axis);
  const Double4 from_middle =
      (axis[0] * spread<0>(local) + axis[1] * spread<1>(local)) + axis[2] * spread<2>(local);
  const bool is_inside = isSame3(local, along);
  store4(nearest.on_segment, on_segment);
  store4(nearest.on_box, is_inside ? on_segment : center + from_middle);
}

/// Ziv's test: the double that every number within `error` of x[0] + x[1] rounds to, if there is
/// one.
static inline bool roundTo(const double* x, double error, double& value) {
  value = x[0] + (x[1] - error);
  return value == x[0] + (x[1] + error);
}

/// Both, if that is certain.
static inline bool isRounded(const Refined& refined, RoundedNearest& nearest) {
  return roundTo(refined.t, refined.t_error, nearest.t) &&
         roundTo(refined.distance, refined.distance_error, nearest.distance) &&
         (!refined.inside || (nearest.t > 0.0 && nearest.t < 1.0));
}

static bool roundNearest(const SceneView& view, const SegmentQuery& query, const NearestOne& one,
                         RoundedNearest& nearest) {
  const BoxRecord& box = view.records[one.record];
  if (box.isAligned()) {
    return false;
  }
  const Double4 start = lanes4(query.start);
  const Double4 end = lanes4(query.end);
  const Double4 center = lanes4(box.column[0][3], box.column[1][3], box.column[2][3]);
  const BoxFrame frame = boxFrame(box, view.rests[one.record]);
  double t = one.t;
  for (int guess = 0; guess < kGuesses; ++guess) {
    Refined refined;
    if (refineIn(frame, center, load4(box.extent), start, end, t, refined) &&
        isRounded(refined, nearest)) {
      setClosestPoints(box, center, start, end, nearest);
      return true;
    }
    const double next = refined.t[0] < 0.0 ? 0.0 : refined.t[0] > 1.0 ? 1.0 : refined.t[0];
    if (next == t) {
      return false;
    }
    t = next;
  }
  return false;
}
