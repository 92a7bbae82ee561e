// SPDX-License-Identifier: BSD-3-Clause
// A segment in float, against sixteen bounds at once: how far away they are at least.
//
// The distance g(t) of the point o + t d from a box is convex, so that from any t0 in [0, 1]
//   g(t) >= g(t0) + min(-t0 g'(t0), (1 - t0) g'(t0)),  g' = d . w / |w|,  w the excess at t0.
// The closer t0 is to the nearest point, the better: it is where the segment is nearest to the
// middle of the bounds, improved by one step of Newton's method.
//
// With o relative to the center of the scene and u = 2^-24, o and d are off by u (|o|_1 + |d|_1) as
// floats, points by twice as much again, and |w|^2, d . w |.| and their sum by at most 16u of what
// they are made of, its quotient by |w| by 8u: kLoss covers them, relative to |w| and to
// |o|_1 + |d|_1.

struct FloatSegment {
  Float16 origin[3];
  Float16 direction[3];
  Float16 inverse_squared;  ///< 1 / |d|^2, or 0
  Float16 slack;
};

static inline FloatSegment floatSegment(const SceneView& view, const SegmentQuery& query) {
  const auto loss = static_cast<float>(bounds::kLoss);
  const auto shortest = static_cast<float>(bounds::kShortest);
  FloatSegment s;
  float squared = 0.0F;
  float size = 0.0F;
  for (int i = 0; i < 3; ++i) {
    const auto o = static_cast<float>(query.start[i] - view.center[i]);
    const auto d = static_cast<float>(query.end[i] - query.start[i]);
    s.origin[i] = all16(o);
    s.direction[i] = all16(d);
    squared += d * d;
    size += std::fabs(o) + std::fabs(d);
  }
  // A segment that is too short for its square is nearest wherever.
  s.inverse_squared = all16(squared > 0x1p-100F ? 1.0F / squared : 0.0F);
  s.slack = all16(size * loss + 2.0F * shortest);
  return s;
}

/// Lower bounds of the distance to sixteen bounds; NaN for an empty slot.
static inline Float16 distances(const Bounds& bounds, const FloatSegment& s) {
  const auto loss = static_cast<float>(bounds::kLoss);
  const auto shortest = static_cast<float>(bounds::kShortest);
  const Float16 zero = all16(0.0F);
  const Float16 one = all16(1.0F);
  Float16 lo[3];
  Float16 hi[3];
  Float16 projection = zero;
  for (int i = 0; i < 3; ++i) {
    lo[i] = load16(bounds.plane[0][i]) - s.origin[i];
    hi[i] = load16(bounds.plane[1][i]) - s.origin[i];
    projection = multiplyAdd(lo[i] + hi[i], s.direction[i], projection);
  }
  // (The middle of an empty slot is NaN, and smaller(NaN, 1) is 1.)
  Float16 t = larger(smaller(projection * (all16(0.5F) * s.inverse_squared), one), zero);
  // The excess is negative below the bounds, positive above, 0 between.
  const auto excess = [&](int i) {
    const Float16 x = t * s.direction[i];
    return larger(x - hi[i], zero) + smaller(x - lo[i], zero);
  };
  Float16 w[3] = {excess(0), excess(1), excess(2)};
  const auto dotWith = [&](const Float16* v) {
    return multiplyAdd(v[2], w[2], multiplyAdd(v[1], w[1], v[0] * w[0]));
  };
  Float16 curvature = all16(shortest);
  for (int i = 0; i < 3; ++i) {
    curvature = curvature + orZeroWhereZero(s.direction[i] * s.direction[i], w[i]);
  }
  t = larger(smaller(t - roughQuotient(dotWith(s.direction), curvature), one), zero);
  for (int i = 0; i < 3; ++i) {
    w[i] = excess(i);
  }
  const Float16 squared = dotWith(w) + all16(shortest * shortest);
  const Float16 slope = dotWith(s.direction);
  const Float16 fall = smaller(zero - t * slope, (one - t) * slope);
  return overRoot(squared + fall, squared) * all16(1.0F - loss) - s.slack;
}

/// Nodes and records that are still to be looked at: where only the nearest box matters nearest
/// first, of each node's children, or else all that are within the bound.
class NearestSearch {
 public:
  NearestSearch(const SceneView& view, const SegmentQuery& query, Approach approach, void* context,
                Work& work)
      : view_(view),
        query_(query),
        approach_(approach),
        context_(context),
        work_(work),
        segment_(floatSegment(view, query)) {
    setBound(query.bound);
  }

  void run() {
    const int top = view_.depth - 1;
    const auto roots = static_cast<int>(view_.levels[top].nodes);
    if (query_.shrinks) {
      searchNearest<kMostRootNodes>(top, 0, roots);
    } else {
      for (int root = 0; root < roots && searchAll(top, static_cast<std::uint32_t>(root)); ++root) {
      }
    }
  }

 private:
  void setBound(double bound) {
    // Rounded up, and finite, so that no empty slot is within it.
    constexpr float kMost = std::numeric_limits<float>::max();
    const float up =
        static_cast<float>(bound * bounds::kUp) + static_cast<float>(bounds::kFloatUnderflow);
    bound_ = up < kMost ? up : kMost;
  }

  Float16 lowerBounds(int level, std::uint32_t node) {
    ++work_.nodes;
    return distances(view_.levels[level].bounds[node], segment_);
  }

  /// Looks at up to kNodes neighbouring nodes.
  /// @return false to end the search
  template <int kNodes>
  bool searchNearest(int level, std::uint32_t node, int nodes) {
    alignas(64) float waiting[kNodes * kSlots];
    const Float16 nowhere = all16(std::numeric_limits<float>::infinity());
    for (int i = 0; i < nodes; ++i) {
      const Float16 lower = lowerBounds(level, node + static_cast<std::uint32_t>(i));
      store16(waiting + i * kSlots, smaller(lower, nowhere));
    }
    while (true) {
      Float16 least = load16(waiting);
      for (int i = 1; i < nodes; ++i) {
        least = smaller(least, load16(waiting + i * kSlots));
      }
      const float nearest = smallestLane(least);
      if (!(nearest <= bound_)) {
        return true;
      }
      float* at = waiting;
      while (notAbove(load16(at), all16(nearest)) == 0) {
        at += kSlots;
      }
      const int slot = lowestBit(notAbove(load16(at), all16(nearest)));
      store16(at, withInfinity(load16(at), slot));
      const auto owner = node + static_cast<std::uint32_t>((at - waiting) / kSlots);
      const std::uint32_t child =
          view_.levels[level].first[owner] + static_cast<std::uint32_t>(slot);
      if (!(level > 0 ? searchNearest<1>(level - 1, child, 1) : visit(child))) {
        return false;
      }
    }
  }

  bool searchAll(int level, std::uint32_t node) {
    const std::uint32_t first = view_.levels[level].first[node];
    std::uint32_t bits = notAbove(lowerBounds(level, node), all16(bound_));
    for (; bits != 0; bits &= bits - 1) {
      const std::uint32_t child = first + static_cast<std::uint32_t>(lowestBit(bits));
      if (!(level > 0 ? searchAll(level - 1, child) : visit(child))) {
        return false;
      }
    }
    return true;
  }

  bool visit(std::uint32_t record) {
    const std::uint32_t box = view_.box_of_record[record];
    if (query_.mask != nullptr && ((query_.mask[box / 64] >> (box % 64)) & 1U) == 0) {
      return true;
    }
    ++work_.boxes;
    work_.turned_boxes += view_.records[record].isAligned() ? 0 : 1;
    NearBox near;
    estimate(view_.records[record], query_, near);
    const double bound = approach_(context_, box, near);
    if (bound < 0.0) {
      return false;
    }
    const float before = bound_;
    setBound(bound);
    bound_ = before < bound_ ? before : bound_;
    return true;
  }

  const SceneView& view_;
  const SegmentQuery& query_;
  Approach approach_;
  void* context_;
  Work& work_;
  FloatSegment segment_;
  float bound_;
};

static void nearest(const SceneView& view, const SegmentQuery& query, Approach approach,
                    void* context, Work& work) {
  work = Work();
  if (view.depth > 0) {
    NearestSearch(view, query, approach, context, work).run();
  }
}
