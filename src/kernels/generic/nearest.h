// SPDX-License-Identifier: BSD-3-Clause
// A segment in float, against sixteen bounds at once: how far away they are at least.
//
// The distance g(t) of the point o + t d from a box is convex, so that from any t0 in [0, 1]
//   g(t) >= g(t0) + min(-t0 g'(t0), (1 - t0) g'(t0)),  g' = d . w / |w|,  w the excess at t0.
// The closer t0 is to the nearest point, the better: it is where the segment is nearest to the
// middle of the bounds, improved by one step of Newton's method.
//
// With o relative to the center of the scene and u = 2^-24, o and d are off by u (|o|_1 + |d|_1) as
// floats, points by twice as much again, and |w|, g' |.| and their sum by at most 16u of what they
// are made of: kLoss covers them, relative to |w| and to |o|_1 + |d|_1.

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

/// Lower bounds of the distance to sixteen bounds; +inf for an empty slot.
/// @param upper receives an upper bound of the distance to anything that fills its bounds
static inline Float16 distances(const Bounds& bounds, const FloatSegment& s, Float16* upper) {
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
  t = larger(smaller(t - dotWith(s.direction) / curvature, one), zero);
  for (int i = 0; i < 3; ++i) {
    w[i] = excess(i);
  }
  const Float16 length = squareRoot(dotWith(w) + all16(shortest * shortest));
  const Float16 slope = dotWith(s.direction) / length;
  const Float16 fall = smaller(zero - t * slope, (one - t) * slope);
  if (upper != nullptr) {
    Float16 diagonal = zero;
    for (int i = 0; i < 3; ++i) {
      const Float16 side = hi[i] - lo[i];
      diagonal = multiplyAdd(side, side, diagonal);
    }
    *upper = (length + squareRoot(diagonal)) * all16(1.0F + loss) + s.slack;
  }
  return (length * all16(1.0F - loss) + fall) - s.slack;
}

/// The smallest lane that is no NaN, or +inf.
static inline float smallestLane(const Float16& a) {
  alignas(64) float lanes[kSlots];
  store16(lanes, a);
  float least = std::numeric_limits<float>::infinity();
  for (int i = 0; i < kSlots; ++i) {
    least = lanes[i] < least ? lanes[i] : least;
  }
  return least;
}
/// Nodes and records that are still to be looked at, nearest first as far as possible.
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
    const Level& level = view_.levels[top];
    for (std::uint32_t node = 0; node < level.nodes; ++node) {
      if (!look(top, node, query_.mask == nullptr && query_.shrinks)) {
        return;
      }
    }
    sortFrom(0);
    while (count_ > 0) {
      const Entry next = entries_[--count_];
      if (next.lower <= bound_ && !look(next.level, next.node, false)) {
        return;
      }
    }
  }

 private:
  struct Entry {
    float lower;
    std::int32_t level;
    std::uint32_t node;
  };
  /// Of every level but the lowest one node's children wait, and the roots' before them.
  static constexpr int kWaiting = kSlots * kSlots + kSlots * kMaxLevels;

  void setBound(double bound) {
    // Rounded up; infinity stays.
    bound_ = static_cast<float>(bound * bounds::kUp) + static_cast<float>(bounds::kFloatUnderflow);
  }

  /// Looks at the sixteen slots of a node.
  /// @return false to end the search
  bool look(int level, std::uint32_t node, bool bound_by_node) {
    const Level& here = view_.levels[level];
    ++work_.nodes;
    alignas(64) float lower[kSlots];
    const int before = count_;
    Float16 upper;
    const Float16 all = distances(here.bounds[node], segment_, bound_by_node ? &upper : nullptr);
    if (bound_by_node) {
      const float least = smallestLane(upper);
      bound_ = least < bound_ ? least : bound_;
    }
    store16(lower, all);
    std::uint32_t bits = notAbove(all, all16(bound_));
    const std::uint32_t first = here.first[node];
    Entry* entries = level > 0 ? entries_ : boxes_;
    int count = level > 0 ? count_ : 0;
    for (; bits != 0; bits &= bits - 1) {
      const int slot = lowestBit(bits);
      entries[count++] = {lower[slot], level - 1, first + static_cast<std::uint32_t>(slot)};
    }
    if (level > 0) {
      count_ = count;
      if (!bound_by_node && level < view_.depth - 1) {
        sortFrom(before);
      }
      return true;
    }
    sort(boxes_, count);
    while (count > 0) {
      const Entry& next = boxes_[--count];
      if (next.lower <= bound_ && !visit(next)) {
        return false;
      }
    }
    return true;
  }

  bool visit(const Entry& entry) {
    const std::uint32_t box = view_.box_of_record[entry.node];
    if (query_.mask != nullptr && ((query_.mask[box / 64] >> (box % 64)) & 1U) == 0) {
      return true;
    }
    ++work_.boxes;
    const double bound = approach_(context_, box);
    if (bound < 0.0) {
      return false;
    }
    const float before = bound_;
    setBound(bound);
    bound_ = before < bound_ ? before : bound_;
    return true;
  }

  void sortFrom(int first) { sort(entries_ + first, count_ - first); }

  /// The nearest last.
  static void sort(Entry* entries, int count) {
    for (int i = 1; i < count; ++i) {
      const Entry entry = entries[i];
      int k = i;
      for (; k > 0 && entries[k - 1].lower < entry.lower; --k) {
        entries[k] = entries[k - 1];
      }
      entries[k] = entry;
    }
  }

  const SceneView& view_;
  const SegmentQuery& query_;
  Approach approach_;
  void* context_;
  Work& work_;
  FloatSegment segment_;
  float bound_;
  int count_ = 0;
  Entry entries_[kWaiting];
  Entry boxes_[kSlots];
};

static void nearest(const SceneView& view, const SegmentQuery& query, Approach approach,
                    void* context, Work& work) {
  work = Work();
  if (view.depth > 0) {
    NearestSearch(view, query, approach, context, work).run();
  }
}
