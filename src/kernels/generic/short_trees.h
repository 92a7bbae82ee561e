// SPDX-License-Identifier: BSD-3-Clause
// Trees of one level or two: all roots are compared, then all leaves that the ray may meet, and
// what is left is a bit each, in words of four nodes.

constexpr int kNodesAWord = 64 / kSlots;
constexpr int kRootWords = kMostRootNodes / kNodesAWord;

/// Compares the ray with up to kMostRootNodes nodes. (Inlined for the same
/// reason.)
/// @param nears where it enters each slot, as far as it does
/// @param met a bit for each slot that it may meet
[[gnu::always_inline]] static inline void meetsNodes(const Bounds* nodes, int count,
                                                     const RayLanes& ray, float* nears,
                                                     std::uint64_t* met) {
  for (int w = 0, k = 0; k < count; ++w) {
    std::uint64_t word = 0;
    for (int shift = 0; shift < 64 && k < count; shift += kSlots, ++k) {
      Float16 near;
      word |= static_cast<std::uint64_t>(meets(nodes[k], ray, near)) << shift;
      store16(nears + k * kSlots, near);
    }
    met[w] = word;
  }
}

/// Visits what lies before the end of the ray, of up to four nodes that it was compared with.
/// @param record record(slot)
template <typename Record, typename Visit>
[[gnu::always_inline]] static inline bool visitWord(std::uint64_t met, const float* nears,
                                                    const FloatRay& ray, const Record& record,
                                                    Visit& visit) {
  for (; met != 0; met &= met - 1) {
    const int slot = __builtin_ctzll(met);
    if (nears[slot] <= ray.end_s && !visit(record(slot))) {
      return false;
    }
  }
  return true;
}

/// Visits what a ray may meet of a list. Nodes of a list, and blocks, are full, but for the last:
/// the number of a slot among them is that of its record.
template <typename Visit, int kWords>
[[gnu::noinline]] static Answer visitList(const SceneView& view, const RayQuery& query,
                                          Found& found, FloatRay& ray, const std::uint64_t* met,
                                          const float* nears) {
  Visit visit(view, query, found, ray);
  if (visit.begin()) {
    for (int w = 0; w < kWords; ++w) {
      const auto record = [w](int slot) { return static_cast<std::uint32_t>(64 * w + slot); };
      if (!visitWord(met[w], nears + 64 * w, ray, record, visit)) {
        break;
      }
    }
  }
  return visit.answer();
}

/// Of a tree that is one list: all bounds are compared before any box in double.
template <typename Visit>
static Answer searchList(const SceneView& view, const RayQuery& query, Found& found,
                         FloatRay& ray) {
  alignas(64) float nears[kMostRootNodes * kSlots];
  std::uint64_t met[kRootWords] = {0, 0};
  const Level& list = view.levels[0];
  found.work->nodes += list.nodes;
  meetsNodes(list.bounds, static_cast<int>(list.nodes), RayLanes(ray), nears, met);
  return (met[0] | met[1]) == 0 ? Answer::kNone
                                : visitList<Visit, kRootWords>(view, query, found, ray, met, nears);
}

/// What is known in float of a ray among the boxes of blocks.
template <int kWords>
struct AmongBlocks {
  alignas(64) float nears[64 * kWords];  ///< where it enters each, as far as it does
  std::uint64_t met[kWords];             ///< a bit for each that it may meet
  float first_end;  ///< the first one is entered up to it: the end of the ray at most
  bool is_met;      ///< certainly, any of them, within its range
};

/// Compares a ray with up to 64 boxes.
/// @param Lanes the boxes that are compared at once
/// @return the boxes that it may meet, a bit each
template <typename Visit, typename Lanes, int kWords>
[[gnu::always_inline]] static inline std::uint64_t compareWithWord(const SceneView& view, int word,
                                                                   bool is_masked,
                                                                   const BlockRay& ray,
                                                                   AmongBlocks<kWords>& among) {
  constexpr std::uint32_t kLanes = sizeof(Lanes) / sizeof(float);
  const std::uint32_t before = 64 * static_cast<std::uint32_t>(word);
  const std::uint32_t left = view.boxes_in_blocks - before;
  const BoxBlock* blocks = view.blocks + before / kSlots;
  float* nears = among.nears + before;
  std::uint64_t met = 0;
  for (std::uint32_t first = 0; first < left && first < 64; first += kLanes) {
    const BoxBlock& block = blocks[first / kSlots];
    BlockTimes<Lanes> times;
    const std::uint64_t bits = meets(block, first % kSlots, ray, times);
    met |= bits << first;
    storeLanes(nears + first, times.near);
    // (Of one box the end of the ray is as good.)
    const std::uint64_t enough = Visit::kAnyWillDo ? bits : bits & (bits - 1);
    if (enough != 0 && !is_masked) {
      const CertainTimes<Lanes> certain(block, first % kSlots, ray, times);
      if constexpr (Visit::kAnyWillDo) {
        const Lanes inside = allLanes<Lanes>(certainEnd(ray.end));
        among.is_met = among.is_met || notAbove(certain.enter, smaller(certain.exit, inside)) != 0;
      } else {
        const float enter = smallestLane(orInfinity(certain.enter, certain.exit));
        among.first_end = enter < among.first_end ? enter : among.first_end;
      }
    }
  }
  return met;
}

/// Forgets boxes that are certainly entered after the first one. (Of many nobody can foretell which
/// are: to skip them one by one would cost mispredicted branches.)
template <typename Lanes, int kWords>
[[gnu::always_inline]] static inline void forgetLater(std::uint32_t boxes,
                                                      AmongBlocks<kWords>& among) {
  constexpr std::uint32_t kLanes = sizeof(Lanes) / sizeof(float);
  const Lanes end = allLanes<Lanes>(among.first_end);
  for (std::uint32_t w = 0; 64 * w < boxes; ++w) {
    std::uint64_t early = 0;
    for (std::uint32_t i = 0; i < 64 && 64 * w + i < boxes; i += kLanes) {
      const std::uint64_t bits = notAbove(loadLanes<Lanes>(among.nears + 64 * w + i), end);
      early |= bits << i;
    }
    among.met[w] &= early;
  }
}

template <typename Visit, typename Lanes, int kWords>
[[gnu::always_inline]] static inline Answer searchBlocks(const SceneView& view,
                                                         const RayQuery& query, Found& found,
                                                         const BlockRay& ray) {
  AmongBlocks<kWords> among;
  among.first_end = ray.end;
  among.is_met = false;
  std::uint64_t any = 0;
  for (int w = 0; w < kWords; ++w) {
    among.met[w] = 64U * static_cast<std::uint32_t>(w) < view.boxes_in_blocks
                       ? compareWithWord<Visit, Lanes>(view, w, query.mask != nullptr, ray, among)
                       : 0;
    any |= among.met[w];
    if (among.is_met) {
      return Answer::kYes;
    }
  }
  if (any == 0) {
    return Answer::kNone;
  }
  constexpr int kMany = 4;  // measured
  if (!Visit::kAnyWillDo && __builtin_popcountll(any) >= kMany) {
    forgetLater<Lanes>(view.boxes_in_blocks, among);
  }
  FloatRay range;
  range.scale = 1.0;
  range.certain_end = certainEnd(ray.end);
  range.setRange(0.0F, among.first_end);
  return visitList<Visit, kWords>(view, query, found, range, among.met, among.nears);
}

/// The same where all boxes are in blocks.
template <typename Visit>
[[gnu::always_inline]] static inline Answer searchBlocks(const SceneView& view,
                                                         const RayQuery& query, Found& found,
                                                         const BlockRay& ray) {
  found.work->nodes += (view.boxes_in_blocks + kSlots - 1) / kSlots;
  if (view.boxes_in_blocks <= 8) {
    return searchBlocks<Visit, Float8, 1>(view, query, found, ray);
  }
  if (view.boxes_in_blocks <= 64) {
    return searchBlocks<Visit, BlockLanes, 1>(view, query, found, ray);
  }
  return searchBlocks<Visit, BlockLanes, kBlockWords>(view, query, found, ray);
}

/// Visits the records of leaves that the ray may meet; four leaves are compared before any record
/// is looked at.
/// @param leaves a bit for each that is compared, by its slot among the roots
template <typename Visit>
[[gnu::always_inline]] static inline bool visitLeaves(const SceneView& view,
                                                      const std::uint64_t* leaves,
                                                      const RayLanes& lanes, FloatRay& ray,
                                                      Visit& visit) {
  const Level& top = view.levels[1];
  const Level& here = view.levels[0];
  alignas(64) float nears[kNodesAWord * kSlots];
  std::uint32_t first[kNodesAWord];
  const auto record = [&first](int slot) {
    return first[slot / kSlots] + static_cast<std::uint32_t>(slot % kSlots);
  };
  for (int w = 0; w < kRootWords; ++w) {
    for (std::uint64_t bits = leaves[w]; bits != 0;) {
      std::uint64_t met = 0;
      for (int shift = 0; shift < 64 && bits != 0; shift += kSlots, bits &= bits - 1) {
        const int slot = 64 * w + __builtin_ctzll(bits);
        const std::uint32_t leaf =
            top.first[slot / kSlots] + static_cast<std::uint32_t>(slot % kSlots);
        ++visit.found->work->nodes;
        Float16 near;
        met |= static_cast<std::uint64_t>(meets(here.bounds[leaf], lanes, near)) << shift;
        store16(nears + shift, near);
        first[shift / kSlots] = here.first[leaf];
      }
      if (met != 0 && (!visit.begin() || !visitWord(met, nears, ray, record, visit))) {
        return false;
      }
    }
  }
  return true;
}

/// Visits records from near to far, as long as visit.end() [s] lies beyond: leaves wait until the
/// stretch of the ray comes in which it enters them.
template <typename Visit>
static void visitTwoLevels(const SceneView& view, FloatRay& ray, Visit& visit) {
  const Level& top = view.levels[1];
  const auto roots = static_cast<int>(top.nodes);
  visit.found->work->nodes += top.nodes;
  alignas(64) float nears[kMostRootNodes * kSlots];
  std::uint64_t later[kRootWords] = {0, 0};
  RayLanes lanes(ray);
  meetsNodes(top.bounds, roots, lanes, nears, later);
  // (Where that can be foretold, or else the branch would cost more than it spares.)
  if (view.meets_few_leaves && (later[0] | later[1]) == 0) {
    return;
  }
  const float whole = ray.end_s;
  float length = ray.stretch_s;
  for (float end = ray.begin_s + length;; length *= 2.0F, end += length) {
    std::uint64_t due[kRootWords] = {later[0], later[1]};
    if (end < whole) {
      for (int w = 0, k = 0; k < roots; ++w) {
        std::uint64_t entered = 0;
        for (int shift = 0; shift < 64 && k < roots; shift += kSlots, ++k) {
          entered |= static_cast<std::uint64_t>(notAbove(load16(nears + k * kSlots), all16(end)))
                     << shift;
        }
        due[w] &= entered;
      }
    }
    later[0] &= ~due[0];
    later[1] &= ~due[1];
    if (!visitLeaves(view, due, lanes, ray, visit) || (later[0] | later[1]) == 0 ||
        !(end < visit.end())) {
      return;
    }
    lanes.end = kept16(ray.end_s);
  }
}
