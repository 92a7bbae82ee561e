// SPDX-License-Identifier: BSD-3-Clause
// Down the tree, a level at a time: all listed nodes are compared without a branch on what comes of
// it, and the children that may be met make the next list. Mispredicted branches and one load
// waiting for another cost more than the nodes that a depth-first search would have spared.

constexpr int kListed = 256;

/// Roots: they are all looked at.
alignas(64) constexpr std::uint32_t kRoots[kSlots] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                      8, 9, 10, 11, 12, 13, 14, 15};

/// Visits the records below `nodes` that the ray may meet.
/// @param visit visit(record) -> false to end; may shorten the ray
template <typename Visit>
static bool descend(const SceneView& view, int level, const std::uint32_t* nodes, int count,
                    FloatRay& ray, Visit& visit);

/// The same, in the function of its caller: only where a list overflows another is called.
template <typename Visit>
[[gnu::always_inline]] static inline bool descendHere(const SceneView& view, int level,
                                                      const std::uint32_t* nodes, int count,
                                                      FloatRay& ray, Visit& visit) {
  alignas(64) std::uint32_t lists[2][kListed + kSlots];
  const RayLanes lanes(ray);
  for (; level > 0; --level) {
    const Level& here = view.levels[level];
    std::uint32_t* list = lists[level % 2];
    visit.found->work->nodes += static_cast<std::uint32_t>(count);
    int listed = 0;
    for (int k = 0; k < count; ++k) {
      Float16 near;
      const std::uint32_t bits = meets(here.bounds[nodes[k]], lanes, near);
      listed = append(bits, here.first[nodes[k]], list, listed);
      if (listed > kListed - kSlots) {
        if (!descend(view, level - 1, list, listed, ray, visit)) {
          return false;
        }
        listed = 0;
      }
    }
    nodes = list;
    count = listed;
  }
  const Level& here = view.levels[0];
  std::uint32_t* list = lists[0];
  visit.found->work->nodes += static_cast<std::uint32_t>(count);
  int listed = 0;
  alignas(64) float nears[kListed + kSlots];
  const auto visitListed = [&] {
    if (!visit.begin()) {
      return false;
    }
    for (int i = 0; i < listed; ++i) {
      if (nears[i] <= ray.end_s && !visit(list[i])) {
        return false;
      }
    }
    return true;
  };
  for (int k = 0; k < count; ++k) {
    Float16 near;
    const std::uint32_t bits = meets(here.bounds[nodes[k]], lanes, near);
    listed = append(bits, here.first[nodes[k]], near, list, nears, listed);
    if (listed > kListed - kSlots) {
      if (!visitListed()) {
        return false;
      }
      listed = 0;
    }
  }
  return listed == 0 || visitListed();
}

template <typename Visit>
[[gnu::noinline]] static bool descend(const SceneView& view, int level, const std::uint32_t* nodes,
                                      int count, FloatRay& ray, Visit& visit) {
  return descendHere(view, level, nodes, count, ray, visit);
}

template <typename Visit>
[[gnu::always_inline]] static inline bool descend(const SceneView& view, FloatRay& ray,
                                                  Visit& visit) {
  const int top = view.depth - 1;
  return descendHere(view, top, kRoots, static_cast<int>(view.levels[top].nodes), ray, visit);
}

/// Visits records from near to far, a stretch of the ray at a time, as long as visit.end() [s] lies
/// beyond. A record may be visited in more than one stretch.
template <typename Visit>
[[gnu::always_inline]] static inline void descendInStretches(const SceneView& view, FloatRay& ray,
                                                             Visit& visit) {
  float begin = ray.begin_s;
  float length = ray.stretch_s;
  for (;;) {
    const float whole = visit.end();
    const float end = begin + length;
    ray.setRange(begin, end < whole ? end : whole);
    if (!descend(view, ray, visit) || !(end < visit.end())) {
      return;
    }
    begin = end;
    length *= 2.0F;
  }
}
