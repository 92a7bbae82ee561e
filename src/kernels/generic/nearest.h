// SPDX-License-Identifier: BSD-3-Clause
// A segment in float, against sixteen bounds at once: how far away they are at least.
//
// The distance g(t) of the point o + t d from a box is convex, so that from any t0 in [0, 1]
//   g(t) >= g(t0) + min(-t0 g'(t0), (1 - t0) g'(t0)),  g' = d . w / |w|,  w the excess at t0.
// The closer t0 is to the nearest point, the better: it is the middle of the segment where that is
// short, what one step of Newton's method makes of it where it is as long as boxes are apart, and
// three steps, where it is so long that boxes lie beside other parts.
//
// With o relative to the center of the scene and u = 2^-24, o and d are off by u (|o|_1 + |d|_1) as
// floats, points by twice as much again, and |w|^2, d . w |.| and their sum by at most 16u of what
// they are made of: kLoss covers them, relative to |w| and to |o|_1 + |d|_1. The quotient by |w| is
// an estimate, within kRoughRoot of it.

/// A segment relative to the center of the scene.
struct FloatSegment {
  float origin[3];
  float direction[3];
  float middle[3];
  float half[3];  ///< of the direction
  float slack;
  float squared_length;
  float minus_inverse;

  FloatSegment() = default;
  FloatSegment(const SceneView& view, const SegmentQuery& query) { set(view, query); }

  void set(const SceneView& view, const SegmentQuery& query) {
    squared_length = 0.0F;
    float size = 0.0F;
    for (int i = 0; i < 3; ++i) {
      origin[i] = static_cast<float>(query.start[i] - view.center[i]);
      direction[i] = static_cast<float>(query.end[i] - query.start[i]);
      half[i] = 0.5F * direction[i];
      middle[i] = origin[i] + half[i];
      squared_length += direction[i] * direction[i];
      size += std::fabs(origin[i]) + std::fabs(direction[i]);
    }
    minus_inverse =
        -1.0F / (squared_length + static_cast<float>(bounds::kShortest * bounds::kShortest));
    slack = size * static_cast<float>(bounds::kLoss) + 2.0F * static_cast<float>(bounds::kShortest);
  }
};

/// The same in lanes, as it is compared with bounds after so many steps of Newton's method.
template <int kSteps>
class LaneSegment {
 public:
  explicit LaneSegment(const FloatSegment& s) : slack_(all16(s.slack)) {
    for (int i = 0; i < 3; ++i) {
      origin_[i] = all16(s.origin[i]);
      direction_[i] = all16(s.direction[i]);
      squares_[i] = all16(s.direction[i] * s.direction[i]);
    }
  }

  /// Lower bounds of the distance to sixteen bounds; NaN for an empty slot.
  Float16 distances(const Bounds& bounds) const {
    const auto loss = static_cast<float>(bounds::kLoss);
    const auto shortest = static_cast<float>(bounds::kShortest);
    const Float16 zero = all16(0.0F);
    const Float16 one = all16(1.0F);
    Float16 lo[3];
    Float16 hi[3];
    for (int i = 0; i < 3; ++i) {
      lo[i] = load16(bounds.plane[0][i]) - origin_[i];
      hi[i] = load16(bounds.plane[1][i]) - origin_[i];
    }
    // The excess is negative below the bounds, positive above, 0 between.
    Float16 w[3];
    const auto setExcess = [&](const Float16& t) {
      for (int i = 0; i < 3; ++i) {
        const Float16 x = t * direction_[i];
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
        curvature = curvature + orZeroWhereZero(squares_[i], w[i]);
      }
      t = larger(smaller(t - roughQuotient(dotWith(direction_), curvature), one), zero);
      setExcess(t);
    }
    const Float16 squared = dotWith(w) + all16(shortest * shortest);
    const Float16 slope = dotWith(direction_);
    const Float16 fall = smaller(zero - t * slope, (one - t) * slope);
    return roughOverRoot(squared + fall, squared) *
               all16((1.0F - loss) * static_cast<float>(1.0 - bounds::kRoughRoot)) -
           slack_;
  }

 private:
  Float16 origin_[3];
  Float16 direction_[3];
  Float16 squares_[3];
  Float16 slack_;
};

/// Of its middle only.
template <>
class LaneSegment<0> {
 public:
  explicit LaneSegment(const FloatSegment& s) : slack_(all16(s.slack)) {
    for (int i = 0; i < 3; ++i) {
      middle_[i] = all16(s.middle[i]);
      half_[i] = all16(s.half[i]);
    }
  }

  Float16 distances(const Bounds& bounds) const {
    const auto loss = static_cast<float>(bounds::kLoss);
    const auto shortest = static_cast<float>(bounds::kShortest);
    const Float16 zero = all16(0.0F);
    Float16 squared = all16(shortest * shortest);
    Float16 slope = zero;
    for (int i = 0; i < 3; ++i) {
      const Float16 w = larger(middle_[i] - load16(bounds.plane[1][i]), zero) +
                        smaller(middle_[i] - load16(bounds.plane[0][i]), zero);
      squared = multiplyAdd(w, w, squared);
      slope = multiplyAdd(w, half_[i], slope);
    }
    const Float16 fall = smaller(slope, zero - slope);
    return roughOverRoot(squared + fall, squared) *
               all16((1.0F - loss) * static_cast<float>(1.0 - bounds::kRoughRoot)) -
           slack_;
  }

 private:
  Float16 middle_[3];
  Float16 half_[3];
  Float16 slack_;
};

/// Rounded up, and finite, so that no empty slot is within it.
static inline float boundInFloat(double bound) {
  constexpr float kMost = std::numeric_limits<float>::max();
  const float up =
      static_cast<float>(bound * bounds::kUp) + static_cast<float>(bounds::kFloatUnderflow);
  return up < kMost ? up : kMost;
}

/// Whether boxes lie beside all of a segment as beside its middle.
static inline bool isShort(const SceneView& view, const FloatSegment& segment) {
  const auto free = static_cast<float>(view.mean_free_path);
  return segment.squared_length < 0.2F * free * free;
}

/// Nodes and records that are still to be looked at: where only the nearest box matters nearest
/// first, of each node's children, or else all that are within the bound.
template <int kSteps>
class NearestSearch {
 public:
  NearestSearch(const SceneView& view, const SegmentQuery& query,
                const LaneSegment<kSteps>& segment, Approach approach, void* context, Work& work)
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
    if (query_.shrinks && roots == 1) {
      searchNode(top, 0);
    } else if (query_.shrinks) {
      searchNearest<kMostRootNodes>(top, 0, roots);
    } else {
      for (int root = 0; root < roots && searchAll(top, static_cast<std::uint32_t>(root)); ++root) {
      }
    }
  }

 private:
  void setBound(double bound) { bound_ = boundInFloat(bound); }

  Float16 lowerBounds(int level, std::uint32_t node) {
    ++work_.nodes;
    return segment_.distances(view_.levels[level].bounds[node]);
  }

  /// @return false to end the search
  bool searchNode(int level, std::uint32_t node) {
    Float16 waiting =
        smaller(lowerBounds(level, node), all16(std::numeric_limits<float>::infinity()));
    while (true) {
      const float nearest = smallestLane(waiting);
      if (!(nearest <= bound_)) {
        return true;
      }
      const int slot = lowestBit(notAbove(waiting, all16(nearest)));
      waiting = withInfinity(waiting, slot);
      const std::uint32_t child =
          view_.levels[level].first[node] + static_cast<std::uint32_t>(slot);
      if (!(level > 0 ? searchNode(level - 1, child) : visit(child))) {
        return false;
      }
    }
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
      if (!(level > 0 ? searchNode(level - 1, child) : visit(child))) {
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
    near.record = record;
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
  const LaneSegment<kSteps>& segment_;
  Approach approach_;
  void* context_;
  Work& work_;
  float bound_;
};

template <int kSteps>
static void searchAfterSteps(const SceneView& view, const SegmentQuery& query,
                             const FloatSegment& s, Approach approach, void* context, Work& work) {
  const LaneSegment<kSteps> segment(s);
  NearestSearch<kSteps>(view, query, segment, approach, context, work).run();
}

static void nearest(const SceneView& view, const SegmentQuery& query, Approach approach,
                    void* context, Work& work) {
  if (view.depth > 0) {
    const FloatSegment segment(view, query);
    const auto free = static_cast<float>(view.mean_free_path);
    if (isShort(view, segment)) {
      searchAfterSteps<0>(view, query, segment, approach, context, work);
    } else if (segment.squared_length < 2.0F * free * free) {
      searchAfterSteps<1>(view, query, segment, approach, context, work);
    } else {
      searchAfterSteps<3>(view, query, segment, approach, context, work);
    }
  }
}
