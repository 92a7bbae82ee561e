// SPDX-License-Identifier: BSD-3-Clause
// A ray among the boxes of blocks: all of them are compared in float, then as few as can be in
// double.

/// Compares a ray with up to 64 boxes.
/// @param Lanes the boxes that are compared at once
/// @param nears where it enters each, as far as it does
/// @param see see(block, slot, times, bits) after as many from a slot of a block on
/// @return the boxes that it may meet, a bit each
template <typename Lanes, typename See>
[[gnu::always_inline]] static inline std::uint64_t compareWithWord(const SceneView& view,
                                                                   std::uint32_t word,
                                                                   const BlockRay& ray,
                                                                   float* nears, const See& see) {
  constexpr std::uint32_t kLanes = sizeof(Lanes) / sizeof(float);
  const std::uint32_t left = view.boxes_in_blocks - 64 * word;
  const BoxBlock* blocks = view.blocks + word * (64 / kSlots);
  std::uint64_t met = 0;
  for (std::uint32_t first = 0; first < left && first < 64; first += kLanes) {
    const BoxBlock& block = blocks[first / kSlots];
    BlockTimes<Lanes> times;
    const std::uint64_t bits = meets(block, first % kSlots, ray, times);
    met |= bits << first;
    storeLanes(nears + first, times.near);
    see(block, first % kSlots, times, bits);
  }
  return met;
}

/// Of up to 64 boxes, those that a ray enters up to a parameter, a bit each.
template <typename Lanes>
[[gnu::always_inline]] static inline std::uint64_t enteredUpTo(float end, const float* nears,
                                                               std::uint32_t boxes) {
  constexpr std::uint32_t kLanes = sizeof(Lanes) / sizeof(float);
  std::uint64_t entered = 0;
  for (std::uint32_t i = 0; i < 64 && i < boxes; i += kLanes) {
    const std::uint64_t bits = notAbove(loadLanes<Lanes>(nears + i), allLanes<Lanes>(end));
    entered |= bits << i;
  }
  return entered;
}

/// The range of a ray among boxes.
static inline FloatRay rangeOf(const BlockRay& ray) {
  FloatRay range;
  range.scale = 1.0;
  range.certain_end = certainEnd(ray.end);
  range.setRange(0.0F, ray.end);
  return range;
}

/// Up to 64 kWords boxes.
template <typename Visit, typename Lanes, int kWords>
[[gnu::always_inline]] static inline Answer searchFewBlocks(const SceneView& view,
                                                            const RayQuery& query, Found& found,
                                                            const BlockRay& ray) {
  alignas(64) float nears[64 * kWords];
  std::uint64_t met[kWords] = {};
  std::uint64_t any = 0;
  float first_end = ray.end;  // the first box is entered up to it
  bool is_met = false;
  const bool is_masked = query.mask != nullptr;
  const auto see = [&](const BoxBlock& block, std::uint32_t slot, const BlockTimes<Lanes>& times,
                       std::uint64_t bits) {
    // (Of one box the end of the ray is as good.)
    const std::uint64_t enough = Visit::kAnyWillDo ? bits : bits & (bits - 1);
    if (enough != 0 && !is_masked) {
      const CertainTimes<Lanes> certain(block, slot, ray, times);
      if constexpr (Visit::kAnyWillDo) {
        is_met = is_met || certain.isMetBefore(certainEnd(ray.end));
      } else {
        const float enter = smallestLane(orInfinity(certain.enter, certain.exit));
        first_end = enter < first_end ? enter : first_end;
      }
    }
  };
  const std::uint32_t boxes = view.boxes_in_blocks;
  for (std::uint32_t w = 0; w < kWords && 64 * w < boxes; ++w) {
    met[w] = compareWithWord<Lanes>(view, w, ray, nears + 64 * w, see);
    any |= met[w];
    if (is_met) {
      return Answer::kYes;
    }
  }
  if (any == 0) {
    return Answer::kNone;
  }
  // Those that are certainly entered after the first one are forgotten. (Of many nobody can
  // foretell which they are: to skip them one by one would cost mispredicted branches.)
  constexpr int kMany = 4;  // measured
  if (!Visit::kAnyWillDo && __builtin_popcountll(any) >= kMany) {
    for (std::uint32_t w = 0; w < kWords && 64 * w < boxes; ++w) {
      met[w] &= enteredUpTo<Lanes>(first_end, nears + 64 * w, boxes - 64 * w);
    }
  }
  FloatRay range = rangeOf(ray);
  range.end_s = first_end;
  return visitList<Visit, kWords>(view, query, found, range, met, nears);
}

/// What is known in float of a ray among many boxes.
struct AmongMany {
  std::uint64_t met[kMostInBlocks / 64];   ///< a bit for each that it may meet
  alignas(64) float nears[kMostInBlocks];  ///< where it enters each, as far as it does

  /// Of the boxes of a word, those that it may enter up to a parameter.
  template <typename Lanes>
  [[gnu::always_inline]] std::uint64_t metUpTo(float end, std::uint32_t word,
                                               std::uint32_t boxes) const {
    return met[word] & enteredUpTo<Lanes>(end, nears + 64 * word, boxes - 64 * word);
  }
};

/// Visits the first box that a ray may enter, at `least`, then those that it may enter before that
/// one: most others are not.
template <typename Visit, typename Lanes>
[[gnu::noinline]] static Answer visitFirstFirst(const SceneView& view, const RayQuery& query,
                                                Found& found, FloatRay range, AmongMany& among,
                                                float least) {
  Visit visit(view, query, found, range);
  if (!visit.begin()) {
    return visit.answer();
  }
  const std::uint32_t boxes = view.boxes_in_blocks;
  std::uint64_t met = 0;
  std::uint32_t word = 0;
  for (std::uint32_t w = 0; 64 * w < boxes; ++w) {  // without a branch on what comes of it
    const std::uint64_t bits = among.metUpTo<Lanes>(least, w, boxes);
    word = bits != 0 ? w : word;
    met = bits != 0 ? bits : met;
  }
  met ^= met & (met - 1);  // its lowest bit
  among.met[word] &= ~met;
  std::uint32_t next = 0;
  const auto record = [&word](int slot) { return 64 * word + static_cast<std::uint32_t>(slot); };
  while (visitWord(met, among.nears + 64 * word, range, record, visit) && 64 * next < boxes) {
    word = next++;
    met = among.metUpTo<Lanes>(range.end_s, word, boxes);
  }
  return visit.answer();
}

template <typename Visit, typename Lanes>
[[gnu::noinline]] static Answer searchManyBlocks(const SceneView& view, const RayQuery& query,
                                                 Found& found, const BlockRay& in_memory) {
  const BlockRay ray = in_memory;  // to stay in registers
  const FloatRay range = rangeOf(ray);
  const bool is_masked = query.mask != nullptr;
  AmongMany among;
  Lanes least = allLanes<Lanes>(std::numeric_limits<float>::infinity());
  bool is_met = false;
  std::uint64_t any = 0;
  for (std::uint32_t word = 0; 64 * word < view.boxes_in_blocks; ++word) {
    among.met[word] =
        compareWithWord<Lanes>(view, word, ray, among.nears + 64 * word,
                               [&](const BoxBlock& block, std::uint32_t slot,
                                   const BlockTimes<Lanes>& times, std::uint64_t bits) {
                                 if constexpr (!Visit::kAnyWillDo) {
                                   least = smaller(least, orInfinity(times.near, times.far));
                                 } else if (bits != 0 && !is_masked) {
                                   const CertainTimes<Lanes> certain(block, slot, ray, times);
                                   is_met = is_met || certain.isMetBefore(range.certain_end);
                                 }
                               });
    any |= among.met[word];
    if (is_met) {
      return Answer::kYes;
    }
  }
  return any == 0
             ? Answer::kNone
             : visitFirstFirst<Visit, Lanes>(view, query, found, range, among, smallestLane(least));
}

/// All boxes of a scene whose boxes are in blocks.
template <typename Visit>
[[gnu::always_inline]] static inline Answer searchBlocks(const SceneView& view,
                                                         const RayQuery& query, Found& found,
                                                         const BlockRay& ray) {
  found.work->nodes += (view.boxes_in_blocks + kSlots - 1) / kSlots;
  if (view.boxes_in_blocks <= 8) {
    return searchFewBlocks<Visit, Float8, 1>(view, query, found, ray);
  }
  if (view.boxes_in_blocks <= 64) {
    return searchFewBlocks<Visit, BlockLanes, 1>(view, query, found, ray);
  }
  if (view.boxes_in_blocks <= 192) {
    return searchFewBlocks<Visit, BlockLanes, 3>(view, query, found, ray);
  }
  FloatRay in_scene;  // a ray that passes all of them is sooner told so than compared
  return prepareUsual<Visit::kWithin>(view, query, in_scene, true) == Outcome::kMiss
             ? Answer::kNone
             : searchManyBlocks<Visit, BlockLanes>(view, query, found, ray);
}
