// SPDX-License-Identifier: BSD-3-Clause
// Sixteen rays in lanes against the roots of a tree, then each against the nodes that it may meet,
// a level at a time. Most rays are done in their first stretch; the rest of others goes down the
// tree as in together.h.

/// The rays that are not done yet.
struct Unfinished {
  static constexpr std::size_t kMost = 64;
  RestOfRay rests[kMost];
  std::size_t count = 0;

  bool hasRoomForAll() const { return count + kSlots <= kMost; }
};

template <typename What>
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

  /// @param unfinished has room for as many
  void run(std::size_t first, int count, Unfinished& unfinished) {
    const std::uint32_t fit = Base::takeUp(first, count);
    alignas(64) float whole[kSlots];
    const std::uint32_t active = beginStretch(whole) & fit;
    in_memory_ = RaysOfLanes(lanes_);
    searchRoots(active);
    for (std::uint32_t bits = active; bits != 0; bits &= bits - 1) {
      const int ray = lowestBit(bits);
      const bool is_begun = (begun_ >> ray & 1) != 0;
      if (!isDone(ray, is_begun, whole[ray])) {
        // (What was found is found again, with its first stretch.)
        const bool is_empty = !is_begun || rays_[ray].visit.isEmpty();
        unfinished.rests[unfinished.count++] = {
            static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(ray),
            is_empty ? in_memory_.end[ray] : 0.0F};
      } else if (is_begun) {
        Base::deliver(ray);
      }
    }
    Base::askEachAlone(((1U << count) - 1) & ~fit);
  }

 private:
  /// Whether nothing that matters lies behind the first stretch of a ray.
  /// @param whole the end of the ray
  bool isDone(int ray, bool is_begun, float whole) {
    const float end = in_memory_.end[ray];
    return whole <= end ||
           (is_begun && (rays_[ray].in_float.end_s < 0.0F || rays_[ray].visit.end() <= end));
  }

  /// Ends the rays one stretch behind where they enter the bounds of the scene.
  /// @param whole where they end, or leave these bounds
  /// @return a bit for each that enters them
  std::uint32_t beginStretch(float* whole) {
    float scene[6];  // as it was found from floats
    for (int i = 0; i < 3; ++i) {
      scene[i] = static_cast<float>(view_.around[0][i]);
      scene[3 + i] = static_cast<float>(view_.around[1][i]);
    }
    Float16 begin;
    Float16 end;
    const std::uint32_t enter = meets(OneBound(scene), lanes_, begin, end);
    store16(whole, end);
    // (As long as those of single rays, in the mean, which are measured along an axis.)
    const Float16 length = overRoot(all16(1.4F * firstStretch(view_)), lanes_.squared_length);
    lanes_.end = smaller(end, begin + length);
    return enter;
  }

  void searchRoots(std::uint32_t active) {
    const int top = view_.depth - 1;
    const Level& roots = view_.levels[top];
    to_.work.nodes += roots.nodes * static_cast<std::uint64_t>(__builtin_popcount(active));
    const RaysInLanes lanes = lanes_;  // to stay in registers
    alignas(64) std::uint32_t list[kListedTogether + kSlots];
    int listed = 0;
    const auto goOn = [&] {
      for (int i = 0; i < listed; ++i) {  // to what they are below
        list[i] = list[i] / kSlots | (list[i] % kSlots) << kNumberBits;
      }
      descend(top - 1, list, listed);
      listed = 0;
    };
    for (std::uint32_t n = 0; n < roots.nodes; ++n) {
      const Bounds& node = roots.bounds[n];
      // (An empty slot would have its planes the wrong way round.)
      std::uint32_t slots = notAbove(load16(node.plane[0][0]), load16(node.plane[1][0]));
      for (; slots != 0; slots &= slots - 1) {
        const int slot = lowestBit(slots);
        Float16 near;
        const std::uint32_t rays = meets(OneBound(node, slot), lanes, near) & active;
        listed = append(rays, (roots.first[n] + static_cast<std::uint32_t>(slot)) * kSlots, list,
                        listed);
        if (listed > kListedTogether - kSlots) {
          goOn();
        }
      }
    }
    if (listed > 0) {
      goOn();
    }
  }

  void descend(int level, const std::uint32_t* nodes, int count) {
    alignas(64) std::uint32_t list[kListedTogether + kSlots];
    alignas(64) float nears[kListedTogether + kSlots];
    const Level& here = view_.levels[level];
    to_.work.nodes += static_cast<std::uint64_t>(count);
    int listed = 0;
    const auto goOn = [&] {
      if (level > 0) {
        descend(level - 1, list, listed);
      } else {
        visitAll(list, nears, listed);
      }
      listed = 0;
    };
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
      listed = append(bits, here.first[node] | ray << kNumberBits, near, list, nears, listed);
      if (listed > kListedTogether - kSlots) {
        goOn();
      }
    }
    if (listed > 0) {
      goOn();
    }
  }

  void visitAll(const std::uint32_t* records, const float* nears, int count) {
    forEachRecord(view_, records, count, [&](std::uint32_t entry, int i) {
      const auto ray = static_cast<int>(entry >> kNumberBits);
      visit(ray, entry & kLargestNumber, nears[i]);
      if (Visit::kWithin && rays_[ray].in_float.end_s < 0.0F) {
        in_memory_.end[ray] = -1.0F;  // it meets no other node
      }
    });
  }

  RaysOfLanes in_memory_;
};

template <typename What>
static void searchInLanes(const SceneView& view, const RayQueries& queries, const Delivery& to) {
  TreeSearch<What> search(view, queries, to);
  Unfinished unfinished;
  for (std::size_t first = 0; first < queries.count; first += kSlots) {
    if (!unfinished.hasRoomForAll()) {
      searchRests<What>(view, queries, unfinished.rests, unfinished.count, to);
      unfinished.count = 0;
    }
    const std::size_t left = queries.count - first;
    search.run(first, left < kSlots ? static_cast<int>(left) : kSlots, unfinished);
  }
  searchRests<What>(view, queries, unfinished.rests, unfinished.count, to);
}

template <typename What>
static void askTogether(const SceneView& view, const RayQueries& queries, const Delivery& to) {
  // (In a heap a ray meets the bounds of most boxes, and few of the boxes.)
  const bool is_heap = view.is_heap && view.boxes_in_blocks > 0;
  if (view.depth == 1 && !is_heap) {
    searchListTogether<What>(view, queries, to);
  } else if (view.depth > 1 && !is_heap && view.levels[0].nodes <= kLargestNumber / kSlots) {
    searchInLanes<What>(view, queries, to);
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
