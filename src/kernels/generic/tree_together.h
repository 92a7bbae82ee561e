// SPDX-License-Identifier: BSD-3-Clause
// Sixteen rays in lanes against the roots of a tree, then each against the nodes that it may meet,
// a level at a time. Most rays are done in their first stretch; the rest of others goes down the
// tree as in together.h. In a large tree two sixteens take turns: what one has to wait for comes
// from memory while the other is compared.

/// How many nodes a tree has where most are not in the cache of a core: these take 384 bytes each.
constexpr std::uint32_t kManyNodes = 2500;

/// The rays that are not done yet.
struct Unfinished {
  static constexpr std::size_t kMost = 80;
  RestOfRay rests[kMost];
  std::size_t count = 0;

  bool hasRoomFor(std::size_t more) const { return count + more <= kMost; }
};

template <typename What>
static void finish(const SceneView& view, const RayQueries& queries, Unfinished& unfinished,
                   const Delivery& to) {
  searchRests<What>(view, queries, unfinished.rests, unfinished.count, to);
  unfinished.count = 0;
}

/// @param kIsLarge whether most of the tree has to come from memory
template <typename What, bool kIsLarge>
class TreeSearch : LaneSearch<What> {
  using Base = LaneSearch<What>;
  using Base::begun_;
  using Base::lanes_;
  using Base::rays_;
  using Base::to_;
  using Base::view_;
  using Base::visit;
  using typename Base::Visit;

 public:
  using Base::Base;

  /// Lists the nodes below roots that rays may meet.
  void begin(std::size_t first, int count) {
    const std::uint32_t fit = Base::takeUp(first, count);
    unfit_ = ((1U << count) - 1) & ~fit;
    active_ = beginStretch() & fit;
    in_memory_ = RaysOfLanes(lanes_);
    searchRoots();
  }

  /// Lists what is below the nodes of a level, which come after those of the level above.
  void descend(int level) {
    const std::uint32_t* nodes = lists_[level + 1];
    const int count = listed_[level + 1];
    const Level& here = view_.levels[level];
    to_.work.nodes += static_cast<std::uint64_t>(count);
    int listed = 0;
    for (int k = 0; k < count; ++k) {
      const std::uint32_t node = nodes[k] & kLargestNumber;
      const std::uint32_t ray = nodes[k] >> kNumberBits;
      if (Visit::kWithin && in_memory_.end[ray] < 0.0F) {
        continue;  // it is done
      }
      Float16 near;
      if (k + kNodesAhead < count) {
        fetchNode(here.bounds[nodes[k + kNodesAhead] & kLargestNumber]);
      }
      const std::uint32_t bits = meets(here.bounds[node], in_memory_, ray, near);
      const std::uint32_t children = here.first[node] | ray << kNumberBits;
      listed = level > 0 ? append(bits, children, lists_[level], listed)
                         : append(bits, children, near, lists_[0], nears_, listed);
      if (listed > kListedTogether - kSlots) {
        goOnBelow(level, listed);
        listed = 0;
      }
    }
    setListed(level, listed);
  }

  /// @param unfinished has room for as many as were begun
  void end(Unfinished& unfinished) {
    visitAll();
    for (std::uint32_t bits = active_; bits != 0; bits &= bits - 1) {
      const int ray = lowestBit(bits);
      const bool is_begun = (begun_ >> ray & 1) != 0;
      if (!isDone(ray, is_begun)) {
        // (What was found is found again, with its first stretch.)
        const bool is_empty = !is_begun || rays_[ray].visit.isEmpty();
        unfinished.rests[unfinished.count++] = {
            static_cast<std::uint32_t>(Base::first_) + static_cast<std::uint32_t>(ray),
            is_empty ? in_memory_.end[ray] : 0.0F};
      } else if (is_begun) {
        Base::deliver(ray);
      }
    }
    Base::askEachAlone(unfit_);
  }

 private:
  /// Of the records that are listed, so many are fetched at once; others as many ahead.
  static constexpr int kFetched = kIsLarge ? 4 * kAhead : kAhead;

  /// Whether nothing that matters lies behind the first stretch of a ray.
  bool isDone(int ray, bool is_begun) {
    const float end = in_memory_.end[ray];
    return whole_[ray] <= end ||
           (is_begun && (rays_[ray].in_float.end_s < 0.0F || rays_[ray].visit.end() <= end));
  }

  /// Ends the rays one stretch behind where they enter the bounds of the scene.
  /// @return a bit for each that enters them
  std::uint32_t beginStretch() {
    float scene[6];  // as it was found from floats
    for (int i = 0; i < 3; ++i) {
      scene[i] = static_cast<float>(view_.around[0][i]);
      scene[3 + i] = static_cast<float>(view_.around[1][i]);
    }
    Float16 begin;
    Float16 end;
    const std::uint32_t enter = meets(OneBound(scene), lanes_, begin, end);
    store16(whole_, end);
    // (As long as those of single rays, in the mean, which are measured along an axis.)
    const Float16 length = overRoot(all16(1.4F * firstStretch(view_)), lanes_.squared_length);
    lanes_.end = smaller(end, begin + length);
    return enter;
  }

  void searchRoots() {
    const int top = view_.depth - 1;
    const Level& roots = view_.levels[top];
    to_.work.nodes += roots.nodes * static_cast<std::uint64_t>(__builtin_popcount(active_));
    const RaysInLanes lanes = lanes_;  // to stay in registers
    std::uint32_t* list = lists_[top];
    int listed = 0;
    const auto toNodes = [&] {
      for (int i = 0; i < listed; ++i) {
        list[i] = list[i] / kSlots | (list[i] % kSlots) << kNumberBits;
      }
    };
    for (std::uint32_t n = 0; n < roots.nodes; ++n) {
      const Bounds& node = roots.bounds[n];
      // (An empty slot would have its planes the wrong way round.)
      std::uint32_t slots = notAbove(load16(node.plane[0][0]), load16(node.plane[1][0]));
      for (; slots != 0; slots &= slots - 1) {
        const int slot = lowestBit(slots);
        Float16 near;
        const std::uint32_t rays = meets(OneBound(node, slot), lanes, near) & active_;
        listed = append(rays, (roots.first[n] + static_cast<std::uint32_t>(slot)) * kSlots, list,
                        listed);
        if (listed > kListedTogether - kSlots) {
          toNodes();
          goOnBelow(top, listed);
          listed = 0;
        }
      }
    }
    toNodes();
    setListed(top, listed);
  }

  /// @param level of the nodes above, that the listed ones are below
  void setListed(int level, int listed) {
    listed_[level] = listed;
    if (level == 0) {
      fetchRecords<kFetched>(view_, lists_[0], listed);
      for (int i = 0; kIsLarge && i < listed && i < kFetched; ++i) {
        prefetch(view_.box_of_record + (lists_[0][i] & kLargestNumber));
      }
    }
  }

  /// All the way down, where a list is full.
  [[gnu::noinline]] void goOnBelow(int level, int listed) {
    setListed(level, listed);
    while (level > 0) {
      descend(--level);
    }
    visitAll();
  }

  void visitAll() {
    forEachRecord<kFetched>(view_, lists_[0], listed_[0], [&](std::uint32_t entry, int i) {
      const auto ray = static_cast<int>(entry >> kNumberBits);
      visit(ray, entry & kLargestNumber, nears_[i]);
      if (Visit::kWithin && rays_[ray].in_float.end_s < 0.0F) {
        in_memory_.end[ray] = -1.0F;  // it meets no other node
      }
    });
  }

  std::uint32_t unfit_ = 0;   ///< a bit for each ray that is to be asked alone
  std::uint32_t active_ = 0;  ///< and for each that enters the bounds of the scene
  RaysOfLanes in_memory_;
  alignas(64) float whole_[kSlots];  ///< where rays end
  /// Of each level what is listed below its nodes: nodes, or records, with their rays.
  alignas(64) std::uint32_t lists_[kMaxLevels][kListedTogether + kSlots];
  int listed_[kMaxLevels];
  alignas(64) float nears_[kListedTogether + kSlots];  ///< where records are entered
};

/// How many rays there are for lanes.
static inline int raysFrom(const RayQueries& queries, std::size_t first) {
  const std::size_t left = queries.count > first ? queries.count - first : 0;
  return left < kSlots ? static_cast<int>(left) : kSlots;
}

template <typename What>
static void searchInLanes(const SceneView& view, const RayQueries& queries, const Delivery& to) {
  TreeSearch<What, false> search(view, queries, to);
  Unfinished unfinished;
  for (std::size_t first = 0; first < queries.count; first += kSlots) {
    if (!unfinished.hasRoomFor(kSlots)) {
      finish<What>(view, queries, unfinished, to);
    }
    search.begin(first, raysFrom(queries, first));
    for (int level = view.depth - 2; level >= 0; --level) {
      search.descend(level);
    }
    search.end(unfinished);
  }
  finish<What>(view, queries, unfinished, to);
}

template <typename What>
static void searchInTurns(const SceneView& view, const RayQueries& queries, const Delivery& to) {
  using Search = TreeSearch<What, true>;
  Search one(view, queries, to);
  Search other(view, queries, to);
  Unfinished unfinished;
  for (std::size_t first = 0; first < queries.count; first += 2 * kSlots) {
    if (!unfinished.hasRoomFor(2 * kSlots)) {
      finish<What>(view, queries, unfinished, to);
    }
    one.begin(first, raysFrom(queries, first));
    const int others = raysFrom(queries, first + kSlots);
    if (others > 0) {
      other.begin(first + kSlots, others);
    }
    for (int level = view.depth - 2; level >= 0; --level) {
      one.descend(level);
      if (others > 0) {
        other.descend(level);
      }
    }
    one.end(unfinished);
    if (others > 0) {
      other.end(unfinished);
    }
  }
  finish<What>(view, queries, unfinished, to);
}

template <typename What>
static void askTogether(const SceneView& view, const RayQueries& queries, const Delivery& to) {
  // (In a heap a ray meets the bounds of most boxes, and few of the boxes.)
  const bool is_heap = view.is_heap && view.boxes_in_blocks > 0;
  if (view.depth == 1 && !is_heap) {
    searchListTogether<What>(view, queries, to);
  } else if (view.depth > 1 && !is_heap && view.levels[0].nodes <= kLargestNumber / kSlots) {
    if (view.levels[0].nodes < kManyNodes) {
      searchInLanes<What>(view, queries, to);
    } else {
      searchInTurns<What>(view, queries, to);
    }
  } else {
    for (std::size_t i = 0; i < queries.count; ++i) {
      askAlone<What>(view, queries, i, to);
    }
  }
}

static void closestTogether(const SceneView& view, const RayQueries& queries, Deliver deliver,
                            void* context, Work& work) {
  askTogether<Ask<ClosestVisit, false>>(view, queries, {deliver, context, work});
}

static void anyTogether(const SceneView& view, const RayQueries& queries, Deliver deliver,
                        void* context, Work& work) {
  askTogether<Ask<AnyVisit, false>>(view, queries, {deliver, context, work});
}

static void anyWithinTogether(const SceneView& view, const RayQueries& queries, Deliver deliver,
                              void* context, Work& work) {
  askTogether<Ask<WithinVisit, true>>(view, queries, {deliver, context, work});
}

static void anyOfSegmentsTogether(const SceneView& view, const RayQueries& queries, Deliver deliver,
                                  void* context, Work& work) {
  askTogether<Ask<AnyVisit, true>>(view, queries, {deliver, context, work});
}
