// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Many boxes at once, once for every instruction set. Which is used never changes an answer: all
/// they say is certain, and what they leave open is decided exactly.
#pragma once

#include "kernels/scene_view.h"

#include <cstdint>

namespace box_query::kernels {

using Together = void (*)(const SceneView&, const RayQueries&, Deliver deliver, void* context,
                          Work& work);

/// The functions of one instruction set.
struct Kernels {
  const char* name;

  /// Whether a ray is sooner compared with all boxes of a scene than with their bounds.
  /// @pre boxes <= kMostInBlocks
  bool (*prefers_blocks)(std::size_t boxes, const Density& density);

  /// Finds all boxes that may be the first that is entered: whatever is not left in `found`, or
  /// was not taken, is certainly not entered before the one of them that is.
  Answer (*closest)(const SceneView&, const RayQuery&, Found& found);

  /// Whether a box is certainly met within the range. If that is undecided, the boxes that may be
  /// are left in `found`, or were taken.
  Answer (*any)(const SceneView&, const RayQuery&, Found& found);

  /// Whether a box is within the radius of a segment, certainly. Where that is not clear, or takes
  /// more than a few boxes, the segment is not taken.
  ///
  /// @pre 0 < radius <= kLargestRadius
  Answer (*any_within)(const SceneView&, const RayQuery&, Found& found);

  /// The same of many rays, several of them at a time: what one waits for, or looks up, serves
  /// others. They call deliver() once for each that meets a box or may, in any order, and for no
  /// other.
  Together closest_together;
  Together any_together;
  /// Of segments: their parameter ends at 1.
  Together any_of_segments_together;
  Together any_within_together;

  /// Finds all boxes that may be met.
  Answer (*all)(const SceneView&, const RayQuery&, Found& found);

  /// Offers all boxes that may be within the bound of a segment, near ones first where it can tell.
  void (*nearest)(const SceneView&, const SegmentQuery&, Approach approach, void* context,
                  Work& work);

  /// Says which box is the nearest, if that is clear, or else offers all that may be it. Null where
  /// it is faster to offer all, and to go on from a double.
  ///
  /// @pre shrinks, no mask
  /// @param one null where it is to be offered too
  /// @return whether it is clear
  bool (*nearest_one)(const SceneView&, const SegmentQuery&, Approach approach, void* context,
                      NearestOne* one, Work& work);

  /// The same of many segments, several of them at a time; some may have masks.
  ///
  /// @pre shrinks, of each
  /// @param ones for those where it is clear; null where they are to be offered too
  void (*nearest_together)(const SceneView&, const SegmentQuery* queries, std::size_t count,
                           ApproachEach approach, void* context, NearestOne* ones, Work& work);

  /// Where a component enters and leaves a box, if it is clear which faces it crosses there. Null
  /// where it is faster to work out one face after the other.
  Crossed (*cross)(const CrossingQuery&, Crossing& enter, Crossing& exit);

  /// Refines where a segment is nearest to a box. Null where it is faster to work out one axis
  /// after the other.
  /// @return whether the box is taken, and its sides are certain
  bool (*refine)(const RefineQuery&, Refined&);

  /// Sets what the axes of the record of an oriented box lack. Null where kernels do not round.
  /// @param quaternion x, y, z, w
  void (*find_rests)(const double* quaternion, const BoxRecord&, AxisRests&);

  /// Works out the distance to the box of a record from a parameter near the one where it is
  /// nearest.
  /// @return whether it is certain; if not, as of each box that is met, it is nothing
  bool (*round_nearest)(const SceneView&, const SegmentQuery&, const NearestOne&, RoundedNearest&);

  /// Works out eight distances at once.
  /// @return a bit for each that is certain; of others the parameter may be a better guess
  std::uint32_t (*round_together)(const SceneView&, const RoundQueries&);
};

extern const Kernels kPortable;
#if defined(__x86_64__)
extern const Kernels kAvx2;
extern const Kernels kAvx512;
#endif

/// Those in use: the widest that the CPU has, or the one that the environment variable
/// BOX_QUERY_KERNEL names ("portable", "avx2", "avx512") if the CPU has it. Chosen at the first
/// call.
const Kernels& active();

/// Whether BOX_QUERY_KERNEL named something that is not to be had here.
bool isChoiceRefused();

/// The table of that name, if the CPU has it, or null.
const Kernels* byName(const char* name);

}  // namespace box_query::kernels
