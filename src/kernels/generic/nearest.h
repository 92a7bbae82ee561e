// SPDX-License-Identifier: BSD-3-Clause
// A segment in float, against sixteen bounds at once: how far away they are at least.
//
// The distance g(t) of the point o + t d from a box is convex, so that from any t0 in [0, 1]
//   g(t) >= g(t0) + min(-t0 g'(t0), (1 - t0) g'(t0)),  g' = d . w / |w|,  w the excess at t0.
// The closer t0 is to the nearest point, the better: it is what one step of Newton's method makes
// of the middle of the segment; three steps, where it is so long that boxes lie beside other parts.
//
// With o relative to the center of the scene and u = 2^-24, o and d are off by u (|o|_1 + |d|_1) as
// floats, points by twice as much again, and |w|^2, d . w |.| and their sum by at most 16u of what
// they are made of, its quotient by |w| by 8u: kLoss covers them, relative to |w| and to
// |o|_1 + |d|_1.

struct FloatSegment {
  Float16 origin[3];
  Float16 direction[3];
  Float16 squares[3];  ///< of the direction
  Float16 slack;
  bool is_long;  ///< so that boxes lie beside all of its parts
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
    s.squares[i] = all16(d * d);
    squared += d * d;
    size += std::fabs(o) + std::fabs(d);
  }
  s.slack = all16(size * loss + 2.0F * shortest);
  const auto free = 1.5F * static_cast<float>(view.mean_free_path);
  s.is_long = squared > free * free;
  return s;
}

/// Lower bounds of the distance to sixteen bounds; NaN for an empty slot.
template <int kSteps>
static inline Float16 distances(const Bounds& bounds, const FloatSegment& s) {
  const auto loss = static_cast<float>(bounds::kLoss);
  const auto shortest = static_cast<float>(bounds::kShortest);
  const Float16 zero = all16(0.0F);
  const Float16 one = all16(1.0F);
  Float16 lo[3];
  Float16 hi[3];
  for (int i = 0; i < 3; ++i) {
    lo[i] = load16(bounds.plane[0][i]) - s.origin[i];
    hi[i] = load16(bounds.plane[1][i]) - s.origin[i];
  }
  // The excess is negative below the bounds, positive above, 0 between.
  Float16 w[3];
  const auto setExcess = [&](const Float16& t) {
    for (int i = 0; i < 3; ++i) {
      const Float16 x = t * s.direction[i];
      w[i] = larger(x - hi[i], zero) + smaller(x - lo[i], zero);
    }
  };
  const auto dotWith = [&](const Float16* v) {
    return multiplyAdd(v[2], w[2], multiplyAdd(v[1], w[1], v[0] * w[0]));
  };
  Float16 t = all16(0.5F);
  setExcess(t);
  for (int step = 0; step < kSteps; ++step) {
    Float16 curvature = all16(shortest);
    for (int i = 0; i < 3; ++i) {
      curvature = curvature + orZeroWhereZero(s.squares[i], w[i]);
    }
    t = larger(smaller(t - roughQuotient(dotWith(s.direction), curvature), one), zero);
    setExcess(t);
  }
  const Float16 squared = dotWith(w) + all16(shortest * shortest);
  const Float16 slope = dotWith(s.direction);
  const Float16 fall = smaller(zero - t * slope, (one - t) * slope);
  return overRoot(squared + fall, squared) * all16(1.0F - loss) - s.slack;
}

/// Nodes and records that are still to be looked at: where only the nearest box matters nearest
/// first, of each node's children, or else all that are within the bound.
template <int kSteps>
class NearestSearch {
 public:
  NearestSearch(const SceneView& view, const SegmentQuery& query, const FloatSegment& segment,
                Approach approach, void* context, Work& work)
      : view_(view),
        query_(query),
        segment_(segment),
        approach_(approach),
        context_(context),
        work_(work) {
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
    return distances<kSteps>(view_.levels[level].bounds[node], segment_);
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
  const FloatSegment& segment_;
  Approach approach_;
  void* context_;
  Work& work_;
  float bound_;
};

static void nearest(const SceneView& view, const SegmentQuery& query, Approach approach,
                    void* context, Work& work) {
  work = Work();
  if (view.depth > 0) {
    const FloatSegment segment = floatSegment(view, query);
    if (segment.is_long) {
      NearestSearch<3>(view, query, segment, approach, context, work).run();
    } else {
      NearestSearch<1>(view, query, segment, approach, context, work).run();
    }
  }
}
