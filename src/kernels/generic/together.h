// SPDX-License-Identifier: BSD-3-Clause
// Many rays down one tree, a level at a time: the nodes that all of them may meet make one list. It
// is long enough that a mispredicted end of it hardly counts, and that what a node or a record has
// to wait for comes from memory while others are compared. For each ray the same is compared as if
// it were alone, but for the order.

constexpr int kRaysTogether = 16;
/// Of an entry of a list, bits for the node or record; those above are for the ray.
constexpr int kNumberBits = 28;
constexpr std::uint32_t kLargestNumber = (1U << kNumberBits) - 1;
constexpr int kListedTogether = 1024;
/// How many entries ahead what they need is fetched, of records and of nodes.
constexpr int kAhead = 4;
constexpr int kNodesAhead = 8;

/// A ray under way.
template <typename Visit>
struct Companion {
  FloatRay in_float;
  Found found;
  Visit visit;
  RayQuery query;
  std::size_t number;  ///< of the query
  float begin;
  float length;

  /// The end of the stretch that it is on.
  float end() const { return begin + length; }
};

static inline void fetchNode(const Bounds& node) {
  for (const auto& side : node.plane) {
    for (const float* slots : side) {
      prefetch(slots);
    }
  }
}

static inline void fetchRecord(const SceneView& view, std::uint32_t entry) {
  const BoxRecord& record = view.records[entry & kLargestNumber];
  prefetch(&record);
  prefetch(&record.column[2]);
}

/// Has the first records of a list fetched.
template <int kFetched>
[[gnu::always_inline]] static inline void fetchRecords(const SceneView& view,
                                                       const std::uint32_t* list, int count) {
  for (int i = 0; i < count && i < kFetched; ++i) {
    fetchRecord(view, list[i]);
  }
}

/// Calls visit(entry, i) for all entries of a list of records, of which the first are fetched;
/// others are, as many ahead.
template <int kFetched, typename VisitEntry>
[[gnu::always_inline]] static inline void forEachRecord(const SceneView& view,
                                                        const std::uint32_t* list, int count,
                                                        const VisitEntry& visit) {
  for (int i = 0; i < count; ++i) {
    if (i + kFetched < count) {
      fetchRecord(view, list[i + kFetched]);
    }
    visit(list[i], i);
  }
}

template <typename Visit>
struct Company {
  const SceneView& view;
  Companion<Visit>* rays;

  Companion<Visit>& rayOf(std::uint32_t entry) const { return rays[entry >> kNumberBits]; }
  static std::uint32_t rayBits(std::uint32_t entry) { return entry & ~kLargestNumber; }
  static std::uint32_t numberOf(std::uint32_t entry) { return entry & kLargestNumber; }

  void descend(int level, const std::uint32_t* nodes, int count) const {
    alignas(64) std::uint32_t list[kListedTogether + kSlots];
    alignas(64) float nears[kListedTogether + kSlots];
    const Level& here = view.levels[level];
    int listed = 0;
    const auto goOn = [&] {
      if (level > 0) {
        descend(level - 1, list, listed);
      } else {
        fetchRecords<kAhead>(view, list, listed);
        forEachRecord<kAhead>(view, list, listed, [&](std::uint32_t entry, int i) {
          Companion<Visit>& c = rayOf(entry);
          if (nears[i] <= c.in_float.end_s && !c.visit(numberOf(entry))) {
            c.in_float.end_s = -1.0F;  // nothing lies before it
          }
        });
      }
      listed = 0;
    };
    for (int k = 0; k < count; ++k) {
      const std::uint32_t node = numberOf(nodes[k]);
      Companion<Visit>& c = rayOf(nodes[k]);
      ++c.found.work->nodes;
      Float16 near;
      const std::uint32_t bits = meets(here.bounds[node], RayLanes(c.in_float), near);
      listed = append(bits, here.first[node] | rayBits(nodes[k]), near, list, nears, listed);
      if (listed > kListedTogether - kSlots) {
        goOn();
      }
    }
    if (listed > 0) {
      goOn();
    }
  }
};

/// What is asked of each ray.
template <typename HowToVisit, bool kOfSegments>
struct Ask {
  using Visit = HowToVisit;
  static constexpr bool kAreSegments = kOfSegments;
};

/// Where what is found goes.
struct Delivery {
  Deliver deliver;
  void* context;
  Work& work;

  template <typename Visit>
  void begin(const SceneView& view, const RayQuery& query, std::size_t number,
             Companion<Visit>& c) const {
    c.number = number;
    c.query = query;
    c.found.count = 0;
    c.found.work = &work;
    c.found.take = nullptr;
    c.visit = Visit(view, c.query, c.found, c.in_float);
  }

  void take(std::size_t number, Answer answer, const Found& found) const {
    if (answer == Answer::kNotTaken) {
      deliver(context, number, Answer::kNotTaken, nullptr);
    } else if (answer != Answer::kNone) {
      deliver(context, number, answer, &found);
    }
  }
};

template <typename What>
static void askAlone(const SceneView& view, const RayQueries& queries, std::size_t number,
                     const Delivery& to) {
  Found found(&to.work);
  const RayQuery query = queries.query(number, What::kAreSegments);
  const Answer answer = search<typename What::Visit>(view, query, found);
  to.take(number, answer, found);
}

/// The rest of a ray.
struct RestOfRay {
  std::uint32_t number;  ///< of the query
  float begin;           ///< [t] before it no box is met
};

/// Down a tree.
template <typename What>
static void searchRests(const SceneView& view, const RayQueries& queries, const RestOfRay* rests,
                        std::size_t count, const Delivery& to) {
  using Visit = typename What::Visit;
  Companion<Visit> rays[kRaysTogether];
  const Company<Visit> company{view, rays};
  const int top = view.depth - 1;
  const std::uint32_t roots = view.levels[top].nodes;
  std::size_t next = 0;
  std::uint32_t under_way = 0;  // a bit for each of the rays
  for (;;) {
    alignas(64) std::uint32_t nodes[kRaysTogether * kSlots];
    int listed = 0;
    for (std::uint32_t i = 0; i < kRaysTogether; ++i) {
      Companion<Visit>& c = rays[i];
      while ((under_way & (1U << i)) == 0 && next < count) {
        const RestOfRay& rest = rests[next++];
        const RayQuery query = queries.query(rest.number, What::kAreSegments);
        const Outcome outcome = prepare<Visit::kWithin>(view, query, c.in_float, true);
        to.begin(view, query, rest.number, c);
        if (outcome == Outcome::kReady && c.visit.begin()) {
          const float begun =
              rest.begin * static_cast<float>(c.in_float.scale * (2.0 - bounds::kUp));
          c.begin = begun > c.in_float.begin_s ? begun : c.in_float.begin_s;
          c.length = c.in_float.stretch_s * (rest.begin > 0.0F ? 2.0F : 1.0F);
          under_way |= 1U << i;
        } else if (outcome != Outcome::kMiss) {
          to.take(rest.number, Answer::kNotTaken, c.found);
        }
      }
      if ((under_way & (1U << i)) != 0) {
        const float whole = c.visit.end();
        c.in_float.setRange(c.begin, c.end() < whole ? c.end() : whole);
        for (std::uint32_t root = 0; root < roots; ++root) {
          nodes[listed++] = root | (i << kNumberBits);
        }
      }
    }
    if (listed == 0) {
      return;
    }
    company.descend(top, nodes, listed);
    for (std::uint32_t bits = under_way; bits != 0; bits &= bits - 1) {
      const int i = lowestBit(bits);
      Companion<Visit>& c = rays[i];
      if (c.in_float.end_s >= 0.0F && c.end() < c.visit.end()) {
        c.begin = c.end();
        c.length *= 2.0F;
      } else {
        under_way &= ~(1U << i);
        to.take(c.number, c.visit.answer(), c.found);
      }
    }
  }
}
