// SPDX-License-Identifier: BSD-3-Clause
// The box that is nearest to a segment: down the tree to the nearest leaf, and to all others that
// may have a nearer box, where floats say which boxes may be the nearest. If it is one, that is it;
// if there are more, double says.

/// Boxes of leaves that may be the nearest one.
class NearestList {
 public:
  NearestList() { clear(); }

  void clear() {
    bound_ = kNoBound;
    lower_ = 0.0F;
    best_ = 0;
    is_full_ = false;
    count_ = 0;
  }
  float bound() const { return bound_; }
  bool isBounded() const { return bound_ < kNoBound; }

  void add(const SceneView& view, const FloatSegment& segment, std::uint32_t node) {
    const LeafDistances distances = leafDistances(view.leaves[node], segment);
    const std::uint32_t first = view.levels[0].first[node];
    const float nearest = smallestLane(distances.upper);
    if (nearest < bound_) {
      bound_ = nearest;
      const int slot = lowestBit(notAbove(distances.upper, all16(nearest)));
      best_ = first + static_cast<std::uint32_t>(slot);
      t_ = lane(distances.t, slot);
      lower_ = lane(distances.lower, slot);
    }
    if (count_ > kCapacity - kSlots) {
      tidy();
    }
    if (count_ <= kCapacity - kSlots) {
      count_ = append(notAbove(distances.lower, all16(bound_)), first, distances.lower, list_,
                      nears_, count_);
    } else {
      is_full_ = true;
    }
  }

  /// Leaves those that may be the nearest.
  void tidy() {
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      list_[kept] = list_[i];
      nears_[kept] = nears_[i];
      kept += nears_[i] <= bound_ ? 1 : 0;
    }
    count_ = kept;
  }

  /// How many may be the nearest.
  int countNear() const { return countUpTo(bound_); }
  /// The one of the least upper bound, and about where it is nearest.
  std::uint32_t best() const { return best_; }
  float t() const { return t_; }
  /// Whether it is certainly not met.
  bool isBestApart() const { return lower_ > 0.0F; }
  /// Whether it may be met, and no other.
  bool isOnlyBestMet() const { return lower_ <= 0.0F && countUpTo(0.0F) == 1; }
  bool isFull() const { return is_full_; }
  int count() const { return count_; }
  std::uint32_t record(int i) const { return list_[i]; }
  float lower(int i) const { return nears_[i]; }

 private:
  int countUpTo(float near) const {
    int count = 0;
    for (int i = 0; i < count_; i += kSlots) {
      const std::uint32_t listed = count_ - i < kSlots ? (1U << (count_ - i)) - 1 : kAllSlots;
      count += __builtin_popcount(notAbove(load16(nears_ + i), all16(near)) & listed);
    }
    return count;
  }

  static constexpr int kCapacity = 64;
  static constexpr std::uint32_t kAllSlots = (1U << kSlots) - 1;
  static constexpr float kNoBound = std::numeric_limits<float>::max();

  float bound_;
  float lower_;  ///< of the one of the least upper bound, and more of it
  float t_;
  std::uint32_t best_;
  bool is_full_;
  int count_;
  alignas(64) std::uint32_t list_[kCapacity + kSlots];
  alignas(64) float nears_[kCapacity + kSlots];
};

template <int kSteps>
class NearestOneSearch {
 public:
  NearestOneSearch(const SceneView& view, const FloatSegment& segment, Work& work)
      : view_(view), segment_(segment), lanes_(segment), work_(work) {}

  NearestList& run() {
    // Roots of a tree are compared at once: their bounds would have to be waited for.
    const int top = (view_.depth > 1 ? view_.depth : view_.depth_together) - 1;
    const std::uint32_t roots = view_.levels[top].nodes;
    if (top == 0) {
      for (std::uint32_t root = 0; root < roots; ++root) {
        visit(root);
      }
    } else if (roots == 1) {
      searchNode(top, 0);
    } else {
      searchRoots(top, static_cast<int>(roots));
    }
    return list_;
  }

 private:
  Float16 lowerBounds(int level, std::uint32_t node) {
    ++work_.nodes;
    return smaller(lanes_.distances(view_.levels[level].bounds[node]),
                   all16(std::numeric_limits<float>::infinity()));
  }
  void visit(std::uint32_t leaf) {
    ++work_.nodes;
    list_.add(view_, segment_, leaf);
    fetchBest();
  }
  /// What its distance will be rounded from comes from memory while other leaves are looked at.
  void fetchBest() const {
    const std::uint32_t best = list_.best();
    const BoxRecord& record = view_.records[best];
    prefetch(record.column[0]);
    prefetch(record.column[2]);
    if (view_.rests != nullptr) {  // as where the kernels in use round
      prefetch(view_.rests[best].column[0]);
    }
    prefetch(view_.box_of_record + best);
  }
  void goTo(int level, std::uint32_t child) {
    if (level > 1) {
      searchNode(level - 1, child);
    } else if (isNear(child)) {
      visit(child);
    }
  }

  /// Whether some box of a leaf may be as near as what was found: its bounds are less to read, and
  /// to compare, than itself. (Of a long segment they say too little.)
  bool isNear(std::uint32_t leaf) {
    return kSteps > 0 || !list_.isBounded() ||
           notAbove(lowerBounds(0, leaf), all16(list_.bound())) != 0;
  }

  void searchNode(int level, std::uint32_t node) {
    Float16 waiting = lowerBounds(level, node);
    while (true) {
      const float nearest = smallestLane(waiting);
      if (!(nearest <= list_.bound())) {
        return;
      }
      const int slot = lowestBit(notAbove(waiting, all16(nearest)));
      waiting = withInfinity(waiting, slot);
      goTo(level, view_.levels[level].first[node] + static_cast<std::uint32_t>(slot));
    }
  }

  void searchRoots(int level, int roots) {
    alignas(64) float waiting[kMostRootNodes * kSlots];
    for (int i = 0; i < roots; ++i) {
      store16(waiting + i * kSlots, lowerBounds(level, static_cast<std::uint32_t>(i)));
    }
    while (true) {
      Float16 least = load16(waiting);
      for (int i = 1; i < roots; ++i) {
        least = smaller(least, load16(waiting + i * kSlots));
      }
      const float nearest = smallestLane(least);
      if (!(nearest <= list_.bound())) {
        return;
      }
      float* at = waiting;
      while (notAbove(load16(at), all16(nearest)) == 0) {
        at += kSlots;
      }
      const int slot = lowestBit(notAbove(load16(at), all16(nearest)));
      store16(at, withInfinity(load16(at), slot));
      const auto root = static_cast<std::uint32_t>((at - waiting) / kSlots);
      goTo(level, view_.levels[level].first[root] + static_cast<std::uint32_t>(slot));
    }
  }

  const SceneView& view_;
  const FloatSegment& segment_;
  const LaneSegment<kSteps> lanes_;
  Work& work_;
  NearestList list_;
};

/// Offers what is left of a list.
[[gnu::noinline]] static void offerListed(const SceneView& view, const SegmentQuery& query,
                                          const NearestList& list, Approach approach, void* context,
                                          Work& work) {
  float bound = list.bound();
  for (int i = 0; i < list.count(); ++i) {
    if (list.lower(i) <= bound) {
      const std::uint32_t record = list.record(i);
      ++work.boxes;
      work.turned_boxes += view.records[record].isAligned() ? 0 : 1;
      NearBox near;
      estimate(view.records[record], query, near);
      near.record = record;
      const float next = boundInFloat(approach(context, view.box_of_record[record], near));
      bound = next < bound ? next : bound;
    }
  }
}

/// Where the segment certainly starts that may meet a box.
static NearestOne::Start startOf(const SceneView& view, const SegmentQuery& query,
                                 std::uint32_t record, float t, Work& work) {
  const BoxRecord& box = view.records[record];
  ++work.boxes;
  work.turned_boxes += box.isAligned() ? 0 : 1;
  const LaneSlabs slabs = laneSlabs(box, query);
  const double scale = scaleOf(slabs);
  return !isInBox(slabs, scale, t)    ? NearestOne::Start::kApart
         : isInBox(slabs, scale, 0.0) ? NearestOne::Start::kInside
                                      : NearestOne::Start::kOutside;
}

/// Says which is the nearest, if that is clear: the only one that may be, or may be met.
static bool isOne(const SceneView& view, const SegmentQuery& query, const NearestList& list,
                  NearestOne& one, Work& work) {
  NearestOne::Start start = NearestOne::Start::kApart;
  if (list.isOnlyBestMet()) {
    start = startOf(view, query, list.best(), list.t(), work);
  } else if (!list.isBestApart()) {
    return false;
  }
  if (start == NearestOne::Start::kApart && list.countNear() != 1) {
    return false;
  }
  one = {list.best(), list.t(), start};
  return true;
}

/// Says which is the nearest, or offers all that may be.
[[gnu::always_inline]] static inline bool decide(const SceneView& view, const SegmentQuery& query,
                                                 NearestList& list, Approach approach,
                                                 void* context, NearestOne* one, Work& work) {
  if (one != nullptr && !list.isFull() && isOne(view, query, list, *one, work)) {
    return true;
  }
  list.tidy();
  if (list.isFull()) {
    nearest(view, query, approach, context, work);
  } else {
    offerListed(view, query, list, approach, context, work);
  }
  return false;
}

template <int kSteps>
static bool nearestOneAfterSteps(const SceneView& view, const SegmentQuery& query,
                                 const FloatSegment& segment, Approach approach, void* context,
                                 NearestOne* one, Work& work) {
  NearestOneSearch<kSteps> search(view, segment, work);
  return decide(view, query, search.run(), approach, context, one, work);
}

static bool nearestOne(const SceneView& view, const SegmentQuery& query, Approach approach,
                       void* context, NearestOne* one, Work& work) {
  if (view.depth == 0) {
    return false;
  }
  const FloatSegment segment(view, query);
  const auto free = static_cast<float>(view.mean_free_path);
  if (isShort(view, segment)) {
    return nearestOneAfterSteps<0>(view, query, segment, approach, context, one, work);
  }
  if (segment.squared_length < 2.0F * free * free) {
    return nearestOneAfterSteps<1>(view, query, segment, approach, context, one, work);
  }
  return nearestOneAfterSteps<3>(view, query, segment, approach, context, one, work);
}
