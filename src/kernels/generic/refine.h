// SPDX-License-Identifier: BSD-3-Clause
// The distance of a segment from an oriented box, and where it is nearest, in double-double, the
// three axes of the box side by side: the steps of geometry/distance_refine.cpp, with its bounds,
// in the frame of the box itself (n = 1).
//
// With eta = error (S + E + D), an excess c + t v and the direction v are within eta of the exact
// ones, f within 2 eta |ex|_1 + 35u^2 f, g within eta (|v|_1 + |ex|_1), A within (5u + 3.5 eta /
// |v|_2) A. Where the sides are certain g^2 / A is off by 2 |g / A| times the error of g, which is
// less than 3 eta |ex|_1, and the root of f(t*) by 4.4 eta.
//
// All that it is told is a parameter t near the nearest point. Which faces the segment is outside
// of there it sees for itself, and takes no box where it may have other sides on the way to the
// nearest point: an excess moves by |change v_i|. On which side of its middle the segment is it
// sees in double, within 3u (S + D). Where that is wrong the segment is inside, and is seen to be
// unless a face is as close.

/// The sum of the first three lanes, of each half if there are two, in the first.
template <typename Lanes>
static inline Wide<Lanes> wideSumOf3(const Wide<Lanes>& a) {
  const Wide<Lanes> two = twoSum(a.hi, turned(a.hi));
  const Wide<Lanes> three = twoSum(two.hi, turnedTwice(a.hi));
  const Lanes rest = (a.lo + turned(a.lo)) + turnedTwice(a.lo);
  return fastTwoSum(three.hi, (two.lo + three.lo) + rest);
}

/// a b, the second part of what is not normalized and their product left out.
template <typename Lanes>
static inline Wide<Lanes> product(const Wide<Lanes>& a, const Wide<Lanes>& b) {
  const Wide<Lanes> p = twoProduct(a.hi, b.hi);
  return {p.hi, fused(a.hi, b.lo, fused(a.lo, b.hi, p.lo))};
}

template <int k, typename Lanes>
static inline Wide<Lanes> spread(const Wide<Lanes>& a) {
  return {spread<k>(a.hi), spread<k>(a.lo)};
}

template <typename Lanes>
static inline Wide<Lanes> repeated(const Wide4& a, const Wide<Lanes>& like) {
  return {repeated(a.hi, like.hi), repeated(a.lo, like.lo)};
}
template <typename Lanes>
static inline Wide<Lanes> wide(const Lanes& hi, const Lanes& lo) {
  return {hi, lo};
}

/// Two vectors, and what is done with both: at once, or one after the other.
struct TwoVectors {
  Wide4 first;
  Wide4 second;
};

template <typename Two, typename Work>
static inline TwoVectors ofBoth(const Two& v, const Work& work) {
  if constexpr (kTwoAtOnce) {
    const auto done = work(wide(joined(v.first.hi, v.second.hi), joined(v.first.lo, v.second.lo)));
    return {{firstHalf(done.hi), firstHalf(done.lo)}, {secondHalf(done.hi), secondHalf(done.lo)}};
  } else {
    return {work(v.first), work(v.second)};
  }
}

/// In the frame of a box.
static inline TwoVectors along(const BoxFrame& frame, const TwoVectors& vectors) {
  return ofBoth(vectors, [&](const auto& v) {
    const auto column = [&](int j) { return repeated(frame.column[j], v); };
    return normalized(
        sumOfProducts(column(0), spread<0>(v), column(1), spread<1>(v), column(2), spread<2>(v)));
  });
}

/// The squared distance f + 2 g s + A s^2 at t + s, as long as no side changes: of one segment, or
/// of each lane.
template <typename Lanes>
struct SquaredDistance {
  Wide<Lanes> f;
  Wide<Lanes> g;
  Lanes curvature;    ///< A
  Lanes root;         ///< of f
  Lanes steepness;    ///< the root of A
  Lanes slope_error;  ///< of g

  template <typename All>
  SquaredDistance(const Wide<Lanes>& f_, const Wide<Lanes>& g_, const Lanes& curvature_,
                  const Lanes& eta, const All& all)
      : f(f_),
        g(g_),
        curvature(curvature_),
        root(squareRoot(f.hi)),
        steepness(squareRoot(curvature)),
        slope_error(all(4.0) * eta * (steepness + root)) {}
};

/// Where it is lowest, and how low.
template <typename Lanes>
struct Lowest {
  Lanes change;  ///< from t
  Wide<Lanes> t;
  Lanes t_error;
  Wide<Lanes> distance;
  Lanes distance_error;
};

/// @param inverse of the curvature, or 0 where it is lowest at t: an end
/// @param all all(x): x in all lanes
template <typename Lanes, typename All>
[[gnu::always_inline]] static inline Lowest<Lanes> lowestOf(const SquaredDistance<Lanes>& squared,
                                                            const Lanes& inverse, const Lanes& t,
                                                            const Lanes& eta, const All& all) {
  // t* = t - g / A.
  Lowest<Lanes> lowest;
  const Lanes change = negated(squared.g.hi * inverse);
  const Lanes curvature_error =
      fused(all(4.0) * eta * squared.steepness, inverse, all(16.0 * exact::bounds::kUnit));
  lowest.change = change;
  lowest.t = twoSum(t, change);
  lowest.t_error = squared.slope_error * inverse + magnitude(change) * curvature_error;

  // f(t*) = f - g^2 / A, and its root from that of f: by r = (f(t*) - root^2) / (2 root) and
  // - r^2 / (2 root), off by r^3 / (2 root^2) and more.
  const Wide<Lanes>& f = squared.f;
  const Lanes& root = squared.root;
  const Lanes factor = all(0.5) / root;
  const Lanes fall = change * change * squared.curvature;
  const Wide<Lanes> square = twoProduct(root, root);
  const Lanes rest = ((f.hi - square.hi) + ((f.lo - square.lo) - fall)) * factor;
  const Lanes bend = rest * rest * factor;
  lowest.distance = fastTwoSum(root, rest - bend);
  lowest.distance_error =
      (all(6.0) * eta + all(8.0) * curvature_error * (fall * factor)) +
      (all(2.0 * exact::bounds::kOperation) * root +
       magnitude(rest) * (all(8.0 * exact::bounds::kUnit) + all(4.0) * (bend * factor)));
  return lowest;
}

/// @return whether the box is taken, and its sides are certain
[[gnu::always_inline]] static inline bool refineIn(const BoxFrame& frame, Double4 center,
                                                   Double4 extents, Double4 start, Double4 end,
                                                   double at, Refined& refined) {
  const Double4 t = all4(at);
  const Double4 zero = all4(0.0);
  const Wide4 from_center = twoSum(start, negated(center));
  const Wide4 from_start = twoSum(end, negated(start));
  const auto [position, direction] = along(frame, {from_center, from_start});
  const Double4 length = magnitude(from_start.hi);
  const Double4 scale = sumOf3((magnitude(from_center.hi) + extents) + length);
  const Double4 eta = all4(frame.error) * scale;

  // The excess at t, and how it changes, along the axes where it is not 0.
  const Wide4 moved = direction * t;
  const Double4 side = position.hi + moved.hi;
  const Wide4 start_beyond = twoSum(position.hi, negated(withSignOf(extents, side)));
  const Wide4 beyond = normalized(Wide4{start_beyond.hi, start_beyond.lo + position.lo} + moved);
  const Double4 room = withSignOf(beyond.hi, side);
  const auto outsideOnly = [&](const Wide4& a) {
    const Double4 outside = larger(room, zero);
    return Wide4{orZeroWhereZero(a.hi, outside), orZeroWhereZero(a.lo, outside)};
  };
  const Wide4 excess = outsideOnly(beyond);
  const Wide4 v = outsideOnly(direction);

  // f, g, A: the squared distance there, half its slope, half its curvature.
  const auto [f, g] = ofBoth(TwoVectors{excess, v}, [&](const auto& a) {
    return wideSumOf3(product(a, repeated(excess, a)));
  });
  const auto all = [](double x) { return all4(x); };
  const SquaredDistance<Double4> squared(f, g, sumOf3(v.hi * v.hi), eta, all);

  const double slope = firstLane(g.hi);
  const double slope_slack = firstLane(squared.slope_error);
  const bool at_start = at == 0.0 && (slope > slope_slack || firstLane(sumOf3(length)) == 0.0);
  const bool at_end = at == 1.0 && -slope > slope_slack;
  const bool is_inside = !at_start && !at_end;
  const Double4 inverse =
      orZeroWhereZero(all4(1.0) / squared.curvature, all4(is_inside ? 1.0 : 0.0));
  const Lowest<Double4> lowest = lowestOf(squared, inverse, t, eta, all);

  const Double4 margin = all4(2.0) * (magnitude(lowest.change) * magnitude(direction.hi)) +
                         (all4(8.0) * eta + all4(16.0 * exact::bounds::kUnit) * scale);
  const double size = firstLane(scale);
  refined.inside = is_inside;
  refined.t[0] = firstLane(lowest.t.hi);
  refined.t[1] = firstLane(lowest.t.lo);
  refined.t_error = firstLane(lowest.t_error);
  refined.distance[0] = firstLane(lowest.distance.hi);
  refined.distance[1] = firstLane(lowest.distance.lo);
  refined.distance_error = firstLane(lowest.distance_error);
  return notBelow3(magnitude(room), margin) == 7U && size >= exact::bounds::kSmallestScale &&
         size <= exact::bounds::kLargestScale;
}

static bool refine(const RefineQuery& query, Refined& refined) {
  return refineIn(boxFrame(query.quaternion), lanes4(query.center), lanes4(query.half_extents),
                  lanes4(query.start), lanes4(query.end), query.t, refined);
}
