// SPDX-License-Identifier: BSD-3-Clause
// Many segments down one tree, each to the box that is nearest to it. First all go straight to a
// leaf, by way of the nearest nodes, a level at a time: what one waits for comes from memory while
// others are compared, and nothing branches on what was compared. Then what of the nodes that were
// passed by may be nearer still makes one list a level, of all segments.

constexpr int kSegmentsTogether = 16;
constexpr int kListedNear = kSegmentsTogether * kMostRootNodes * kSlots;

/// A segment under way.
struct NearCompanion {
  const SegmentQuery* query;
  std::size_t number;
  FloatSegment segment;
  NearestList list;
  std::uint32_t at;  ///< the node that it goes to
  int lowest;        ///< the lowest level where it was at a node
  std::uint32_t node[kMaxLevels + 1];
  /// Lower bounds of the slots that it passed by, of roots and of each node below.
  alignas(64) float roots[kMostRootNodes * kSlots];
  alignas(64) float below[kMaxLevels + 1][kSlots];
};

/// An Approach of one segment of many.
struct OneApproach {
  ApproachEach approach;
  void* context;
  std::size_t number;

  static double take(void* self, std::uint32_t box, const NearBox& near) {
    const OneApproach& one = *static_cast<const OneApproach*>(self);
    return one.approach(one.context, one.number, box, near);
  }
};

class NearestTogether {
 public:
  NearestTogether(const SceneView& view, ApproachEach approach, void* context, NearestOne* ones,
                  Work& work)
      : view_(view),
        top_(view.depth_together - 1),
        roots_(static_cast<int>(view.levels[top_].nodes)),
        approach_(approach),
        context_(context),
        ones_(ones),
        work_(work) {}

  bool isFull() const { return count_ == kSegmentsTogether; }
  /// The next segment, to be set where it is: a copy of what has just been written would be waited
  /// for.
  FloatSegment& next() { return segments_[count_].segment; }
  void add(std::size_t number, const SegmentQuery& query) {
    NearCompanion& c = segments_[count_++];
    c.query = &query;
    c.number = number;
    c.list.clear();
  }

  void run() {
    if (top_ == 0) {
      for (int k = 0; k < count_; ++k) {
        for (int n = 0; n < roots_; ++n) {
          visit(segments_[k], static_cast<std::uint32_t>(n));
        }
      }
    } else {
      goDown();
    }
    for (int k = 0; k < count_; ++k) {
      finish(segments_[k]);
    }
    count_ = 0;
  }

 private:
  void goDown() {
    for (int k = 0; k < count_; ++k) {
      passRoots(segments_[k]);
    }
    for (int level = top_ - 1; level > 0; --level) {
      for (int k = 0; k < count_; ++k) {
        if (segments_[k].lowest == level + 1) {
          passNode(segments_[k], level);
        }
      }
    }
    for (int k = 0; k < count_; ++k) {
      if (segments_[k].lowest == 1) {
        visit(segments_[k], segments_[k].at);
      }
    }
    for (int level = 1; level <= top_; ++level) {
      lookBack(level);
    }
  }

  void fetch(int level, std::uint32_t child) const {
    if (level == 1) {
      const LeafBoxes& leaf = view_.leaves[child];
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          prefetch(leaf.axis[i][j]);
        }
        prefetch(leaf.center[i]);
        prefetch(leaf.extent[i]);
      }
      prefetch(leaf.error);
    } else {
      fetchNode(view_.levels[level - 1].bounds[child]);
    }
  }

  /// On to a child. (A node may be empty whose boxes are gone: there it ends.)
  void goTo(NearCompanion& c, int level, std::uint32_t node, int slot, float nearest) const {
    if (nearest <= std::numeric_limits<float>::max()) {
      c.lowest = level;
      c.at = view_.levels[level].first[node] + static_cast<std::uint32_t>(slot);
      fetch(level, c.at);
    }
  }

  void passRoots(NearCompanion& c) {
    c.lowest = top_ + 1;
    const LaneSegment<0> segment(c.segment);
    const Float16 nowhere = all16(std::numeric_limits<float>::infinity());
    Float16 least = nowhere;
    for (int n = 0; n < roots_; ++n) {
      const Float16 lower = smaller(segment.distances(view_.levels[top_].bounds[n]), nowhere);
      store16(c.roots + n * kSlots, lower);
      least = smaller(least, lower);
    }
    work_.nodes += static_cast<std::uint64_t>(roots_);
    const float nearest = smallestLane(least);
    int at = 0;
    for (int n = roots_ - 1; n >= 0; --n) {
      const std::uint32_t bits = notAbove(load16(c.roots + n * kSlots), all16(nearest));
      at = bits != 0 ? n * kSlots + lowestBit(bits) : at;
    }
    c.roots[at] = std::numeric_limits<float>::infinity();
    goTo(c, top_, static_cast<std::uint32_t>(at / kSlots), at % kSlots, nearest);
  }

  void passNode(NearCompanion& c, int level) {
    const LaneSegment<0> segment(c.segment);
    const std::uint32_t node = c.at;
    const Float16 lower = smaller(segment.distances(view_.levels[level].bounds[node]),
                                  all16(std::numeric_limits<float>::infinity()));
    ++work_.nodes;
    const float nearest = smallestLane(lower);
    const int slot = lowestBit(notAbove(lower, all16(nearest)));
    c.node[level] = node;
    store16(c.below[level], withInfinity(lower, slot));
    goTo(c, level, node, slot, nearest);
  }

  /// At what was passed by on a level, and may be nearer than what was found since.
  void lookBack(int level) {
    alignas(64) std::uint32_t list[kListedNear + kSlots];
    int listed = 0;
    const std::uint32_t* first = view_.levels[level].first;
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(count_); ++k) {
      const NearCompanion& c = segments_[k];
      const Float16 bound = all16(c.list.bound());
      const auto listNear = [&](std::uint32_t node, const float* waiting) {
        listed = append(notAbove(load16(waiting), bound), first[node] | (k << kNumberBits), list,
                        listed);
      };
      if (level < top_ && c.lowest <= level) {
        listNear(c.node[level], c.below[level]);
      }
      for (int n = 0; level == top_ && n < roots_; ++n) {
        listNear(static_cast<std::uint32_t>(n), c.roots + n * kSlots);
      }
    }
    goOn(level, list, listed);
  }

  /// Looks at children of a level.
  void goOn(int level, const std::uint32_t* children, int count) {
    if (level > 1) {
      descend(level - 1, children, count);
      return;
    }
    // (Which are near nobody can foretell: without a branch on it.)
    alignas(64) std::uint32_t near[kListedNear + kSlots];
    int listed = 0;
    for (int i = 0; i < count; ++i) {
      if (i + 1 < count) {
        fetchNode(view_.levels[0].bounds[children[i + 1] & kLargestNumber]);
      }
      const NearCompanion& c = segments_[children[i] >> kNumberBits];
      near[listed] = children[i];
      listed += mayBeNearer(c, children[i] & kLargestNumber) ? 1 : 0;
    }
    for (int i = 0; i < listed; ++i) {
      visit(segments_[near[i] >> kNumberBits], near[i] & kLargestNumber);
    }
  }

  void descend(int level, const std::uint32_t* nodes, int count) {
    alignas(64) std::uint32_t list[kListedTogether + kSlots];
    int listed = 0;
    for (int i = 0; i < count; ++i) {
      if (i + 1 < count) {
        fetch(level + 1, nodes[i + 1] & kLargestNumber);
      }
      const std::uint32_t node = nodes[i] & kLargestNumber;
      const NearCompanion& c = segments_[nodes[i] >> kNumberBits];
      ++work_.nodes;
      const Float16 lower = LaneSegment<0>(c.segment).distances(view_.levels[level].bounds[node]);
      listed = append(notAbove(lower, all16(c.list.bound())),
                      view_.levels[level].first[node] | (nodes[i] & ~kLargestNumber), list, listed);
      if (listed > kListedTogether - kSlots) {
        goOn(level, list, listed);
        listed = 0;
      }
    }
    if (listed > 0) {
      goOn(level, list, listed);
    }
  }

  /// Whether the bounds of boxes of a leaf, which are less to read than the boxes, are near enough.
  bool mayBeNearer(const NearCompanion& c, std::uint32_t leaf) {
    ++work_.nodes;
    const Float16 lower = LaneSegment<0>(c.segment).distances(view_.levels[0].bounds[leaf]);
    return notAbove(lower, all16(c.list.bound())) != 0;
  }

  void visit(NearCompanion& c, std::uint32_t leaf) {
    ++work_.nodes;
    c.list.add(view_, c.segment, leaf);
  }

  [[gnu::noinline]] void finish(NearCompanion& c) {
    OneApproach one{approach_, context_, c.number};
    decide(view_, *c.query, c.list, OneApproach::take, &one,
           ones_ != nullptr ? ones_ + c.number : nullptr, work_);
  }

  const SceneView& view_;
  int top_;
  int roots_;
  ApproachEach approach_;
  void* context_;
  NearestOne* ones_;
  Work& work_;
  int count_ = 0;
  NearCompanion segments_[kSegmentsTogether];
};

static void nearestTogether(const SceneView& view, const SegmentQuery* queries, std::size_t count,
                            ApproachEach approach, void* context, NearestOne* ones, Work& work) {
  if (view.depth == 0) {
    return;
  }
  const bool is_short_enough = view.levels[0].nodes <= kLargestNumber / kSlots;
  NearestTogether together(view, approach, context, ones, work);
  for (std::size_t i = 0; i < count; ++i) {
    together.next().set(view, queries[i]);
    if (is_short_enough && queries[i].mask == nullptr && isShort(view, together.next())) {
      together.add(i, queries[i]);
      if (together.isFull()) {
        together.run();
      }
      continue;
    }
    // What is looked at of a long segment, or of few boxes, differs too much from one to the next.
    OneApproach one{approach, context, i};
    if (queries[i].mask == nullptr) {
      nearestOne(view, queries[i], OneApproach::take, &one, ones != nullptr ? ones + i : nullptr,
                 work);
    } else {
      nearest(view, queries[i], OneApproach::take, &one, work);
    }
  }
  together.run();
}
