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
