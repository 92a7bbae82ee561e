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
bool descend(const SceneView& view, int level, const std::uint32_t* nodes, int count, FloatRay& ray,
             Work& work, Visit& visit) {
  alignas(64) std::uint32_t list[kListed + kSlots];
  const Level& here = view.levels[level];
  work.nodes += static_cast<std::uint32_t>(count);
  int listed = 0;
  if (level > 0) {
    for (int k = 0; k < count; ++k) {
      Float16 near;
      const std::uint32_t bits = meets(here.bounds[nodes[k]], ray, near);
      listed = append(bits, here.first[nodes[k]], list, listed);
      if (listed > kListed - kSlots) {
        if (!descend(view, level - 1, list, listed, ray, work, visit)) {
          return false;
        }
        listed = 0;
      }
    }
    return listed == 0 || descend(view, level - 1, list, listed, ray, work, visit);
  }
  alignas(64) float nears[kListed + kSlots];
  const auto visitListed = [&] {
    for (int i = 0; i < listed; ++i) {
      if (nears[i] <= ray.end_s * static_cast<float>(bounds::kFarther) && !visit(list[i])) {
        return false;
      }
    }
    return true;
  };
  for (int k = 0; k < count; ++k) {
    Float16 near;
    const std::uint32_t bits = meets(here.bounds[nodes[k]], ray, near);
    listed = append(bits, here.first[nodes[k]], near, list, nears, listed);
    if (listed > kListed - kSlots) {
      if (!visitListed()) {
        return false;
      }
      listed = 0;
    }
  }
  return visitListed();
}

/// Of a tree that is one list: all bounds, or all boxes in float, are compared before any in
/// double.
template <typename Visit>
bool visitList(const SceneView& view, FloatRay& ray, Work& work, Visit& visit) {
  constexpr int kWords = 64 / kSlots;  // nodes a word
  constexpr int kLongest = 8;          // nodes of the longest list
  alignas(64) float nears[kLongest * kSlots];
  std::uint64_t words[kLongest / kWords] = {0, 0};
  if (ray.for_blocks) {
    work.nodes += view.num_blocks;
    for (std::uint32_t k = 0; k < view.num_blocks; ++k) {
      Float8 near;
      const std::uint64_t bits = meets(view.blocks[k], ray, near);
      store8(nears + k * kBlockSlots, near);
      words[0] |= bits << (k * kBlockSlots);
    }
  } else {
    const Level& list = view.levels[0];
    const auto count = static_cast<int>(list.nodes);
    work.nodes += list.nodes;
    for (int k = 0; k < count; ++k) {
      Float16 near;
      const std::uint64_t bits = meets(list.bounds[k], ray, near);
      store16(nears + k * kSlots, near);
      words[k / kWords] |= bits << (k % kWords * kSlots);
    }
  }
  // Nodes of a list, and blocks, are full, but for the last: slot number and record are the same.
  for (int w = 0; w < kLongest / kWords; ++w) {
    for (std::uint64_t bits = words[w]; bits != 0; bits &= bits - 1) {
      const int record = 64 * w + __builtin_ctzll(bits);
      if (nears[record] <= ray.end_s * static_cast<float>(bounds::kFarther) &&
          !visit(static_cast<std::uint32_t>(record))) {
        return false;
      }
    }
  }
  return true;
}

template <typename Visit>
bool descend(const SceneView& view, FloatRay& ray, Work& work, Visit& visit) {
  if (view.depth == 1) {
    return visitList(view, ray, work, visit);
  }
  const int top = view.depth - 1;
  return descend(view, top, kRoots, static_cast<int>(view.levels[top].nodes), ray, work, visit);
}

/// Visits records from near to far, a stretch of the ray at a time, as long as visit.end() [s] lies
/// beyond. A record may be visited in more than one stretch.
template <typename Visit>
void descendInStretches(const SceneView& view, FloatRay& ray, Work& work, Visit& visit) {
  if (view.depth == 1) {
    visitList(view, ray, work, visit);
    return;
  }
  float begin = ray.begin_s;
  auto length = static_cast<float>(view.mean_free_path);
  for (;;) {
    const float whole = visit.end();
    const float end = begin + length;
    ray.setRange(begin, end < whole ? end : whole);
    if (!descend(view, ray, work, visit) || !(end < visit.end())) {
      return;
    }
    begin = end;
    length *= 2.0F;
  }
}
