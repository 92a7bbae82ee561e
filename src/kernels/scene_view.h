// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the kernels see of a scene: plain numbers behind plain pointers, no Eigen, no containers,
/// so that code for one instruction set shares no inline function with code for another.
///
/// A tree of fixed depth and sixteen children a node. Its planes are floats, relative to `center`
/// and rounded outward: they only say where a box cannot be. What is certain about a box its
/// record in double says, and what that leaves open is the caller's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace box_query::kernels {

constexpr int kSlots = 16;
constexpr int kMaxLevels = 7;
/// Of the last level.
constexpr int kMostRootNodes = 8;

/// Bounds of sixteen boxes, or of sixteen nodes of the level below. An empty slot is nowhere: its
/// minimum is +inf, its maximum -inf.
struct alignas(64) Bounds {
  float plane[2][3][kSlots];  ///< [minimum or maximum][axis][slot]
};

/// A box in double, four lanes wide: three axes, and what belongs to none of them.
struct alignas(64) BoxRecord {
  /// Oriented: column j has coordinate j of the three box axes and of the center. Aligned: column
  /// 0 has the minimum, column 1 the maximum.
  double column[3][4];
  /// Half extents, and their padded sum (see geometry/slabs.h); negative for an aligned box.
  double extent[4];

  bool isAligned() const { return extent[3] < 0.0; }
};

/// What the axes of a record of an oriented box lack of the exact ones, a column each: NaN where
/// that cannot be told. Of an aligned one it is nothing.
struct alignas(16) AxisRests {
  float column[3][4];
};

/// Sixteen boxes in float, relative to the center of the scene, all as oriented ones. An empty slot
/// has extents of -inf.
struct alignas(64) BoxBlock {
  float axis[3][3][kSlots];  ///< [axis of the box][coordinate][slot]
  float center[3][kSlots];
  float extent[3][kSlots];   ///< half extents, padded: see generic/blocks.h
  float certain[3][kSlots];  ///< and those of what is certainly in the box
};

/// So many are in blocks at most.
constexpr std::uint32_t kMostInBlocks = 1024;

/// Of boxes, met by a ray through all of a scene, where the scene is a heap.
constexpr double kManyBounds = 8.0;

/// How many bounds of boxes a ray meets.
struct Density {
  double bounds_met;  ///< a ray along the longest side of the scene
  double in_vain;     ///< a ray at random: those whose box it does not meet
};

/// Center and half extents of a box in a block: at most this far away.
constexpr double kFarthestInBlocks = 0x1p40;

/// The boxes of a leaf in float, relative to the center of the scene, all as oriented ones. The
/// center of an empty slot is NaN.
struct alignas(64) LeafBoxes {
  float axis[3][3][kSlots];  ///< [axis of the box][coordinate][slot]
  float center[3][kSlots];
  float extent[3][kSlots];  ///< half extents
  float error[kSlots];      ///< what it adds to that of a distance: see generic/leaf_distances.h
};

/// Nodes of one level: the children of node n are first[n], first[n] + 1, ... of the level below,
/// of the lowest level records.
struct Level {
  const Bounds* bounds;
  const std::uint32_t* first;
  std::uint32_t nodes;
};

struct SceneView {
  /// Level 0 is the lowest. All nodes of the last one are roots.
  Level levels[kMaxLevels + 1];
  int depth;  ///< how many levels there are; 0: no box is in the tree
  /// The same for many segments: where there are several roots there is one more, around them.
  int depth_together;
  /// Where a ray is sooner compared with all boxes than with their bounds: slot i % kSlots of block
  /// i / kSlots is record i. Or else none are in blocks.
  const BoxBlock* blocks;
  std::uint32_t boxes_in_blocks;
  bool is_heap;  ///< a ray through all of it meets the bounds of many boxes
  /// Of a tree of two levels: most rays meet no leaf, even if they go through all of the scene.
  bool meets_few_leaves;
  /// Slot n is around all of root n.
  const Bounds* around_nodes;
  const LeafBoxes* leaves;  ///< of each node of the lowest level
  const BoxRecord* records;
  const AxisRests* rests;  ///< of each record, where kernels round
  std::uint32_t num_records;
  /// Number of the box in the scene.
  const std::uint32_t* box_of_record;
  alignas(32) double center[4];
  /// Around all boxes, relative to the center: [minimum or maximum][axis].
  alignas(16) float around[2][4];
  /// How far its planes are moved apart for a ray in float that starts at the center: see
  /// generic/ray.h.
  float apart;
  bool has_aligned;  ///< some records are of aligned boxes
  /// How far a ray goes in the mean before it meets a box.
  double mean_free_path;
  /// Bounds that are moved outward by a larger radius reach too much of the scene to be worth it.
  double most_radius;
};

/// The part of a component that a query is about: origin + t * direction, t in [0, 1] or [0, inf).
///
/// The numbers must be finite. Where they are not moderate, as DoubleComponent has it, or the
/// origin is farther than kFarthestOrigin from the center of the scene, the kernels do not take it.
struct RayQuery {
  const double* origin;
  const double* direction;  ///< or the end of a segment
  bool is_segment;
  double max_range;  ///< [m] a box that is certainly entered beyond it is none
  /// Boxes to look at, a bit each by their number in the scene, or null.
  const std::uint64_t* mask;
  double radius;  ///< [m] of a segment: see Kernels::any_within
};

/// Of a query about a radius, at most.
constexpr double kLargestRadius = 0x1p40;

constexpr double kFarthestOrigin = 0x1p60;

/// A box that may be met, and where: enter_lo <= entry <= enter_hi if it is.
struct Candidate {
  std::uint32_t box;
  bool certain;  ///< that it is met
  double enter_lo;
  double enter_hi;
  double exit_hi;
};

/// What was not skipped.
struct Work {
  std::uint64_t nodes = 0;         ///< whose slots were compared, or blocks
  std::uint64_t boxes = 0;         ///< compared in double
  std::uint64_t turned_boxes = 0;  ///< of these, not aligned
};

struct Found;

/// Takes the candidates of a full list; the query goes on with an empty one.
/// @return of the closest: an upper bound of the parameter where the first of them is entered, as
/// far as the caller knows; of the others: negative to end the query
using Take = double (*)(void* context, const Found& found);

/// Where what a query finds out goes.
struct Found {
  static constexpr int kCapacity = 64;

  // (Without an initializer for the candidates: most queries need few of them, or none.)
  Found(Work* what_was_done, Take more, void* its_context)
      : count(0), work(what_was_done), take(more), context(its_context) {}
  explicit Found(Work* what_was_done) : count(0), work(what_was_done), take(nullptr) {}
  Found() : Found(nullptr, nullptr, nullptr) {}

  int count;
  Work* work;  ///< is added to
  /// For more candidates than there is room for; null: then the query is not taken.
  Take take;
  void* context;
  /// A box that is certainly entered before this parameter is certainly in range; of none is it
  /// known where the ray came near no box.
  double t_inside = -std::numeric_limits<double>::infinity();
  Candidate candidates[kCapacity];
};

enum class Answer {
  kNotTaken,
  kNone,       ///< no box
  kUndecided,  ///< what was found says more, or those that took it
  kYes         ///< a box is certainly met
};

/// Rays, or segments, to ask about together.
struct RayQueries {
  /// Origin and direction of each, or start and end, six numbers, one after the other.
  const double* rays;
  std::size_t count;
  const double* max_ranges;    ///< see RayQuery
  std::size_t range_distance;  ///< from one to the next: 0 if it is the same for all
  const std::uint64_t* mask;
  double radius;

  double maxRange(std::size_t i) const { return max_ranges[i * range_distance]; }
  RayQuery query(std::size_t i, bool is_segment) const {
    return {rays + 6 * i, rays + 6 * i + 3, is_segment, maxRange(i), mask, radius};
  }
};

/// Takes what is found for a query of many, known by its place; null where it has to be asked by
/// itself.
using Deliver = void (*)(void* context, std::size_t query, Answer answer, const Found* found);

/// The segment from start to end, and how far away a box may be to matter.
///
/// @pre Every number is finite, |start - center| and |end - center| at most kFarthestOrigin.
struct SegmentQuery {
  double start[3];
  double end[3];
  double bound;
  bool shrinks;  ///< only the nearest box matters
  /// Boxes to look at, a bit each by their number in the scene, or null.
  const std::uint64_t* mask;
};

/// A box that may be within the bound: SegmentSlabs, NearestGuess and DistanceBounds of
/// geometry/distance_filter.h, with a fourth lane of whatever; of one that is certainly met the
/// upper bound is 0.
struct alignas(32) NearBox {
  double below[4];
  double above[4];
  double direction[4];
  double excess[4];
  double scale;
  double t;
  double lower;
  double upper;
  std::uint32_t record;
};

/// Takes a box that may be within the bound.
/// @return the bound from now on, which never grows; negative to end the query
using Approach = double (*)(void* context, std::uint32_t box, const NearBox& near);
/// The same of one segment of many.
using ApproachEach = double (*)(void* context, std::size_t query, std::uint32_t box,
                                const NearBox& near);

/// The nearest box, and a parameter near the one where it is nearest.
struct NearestOne {
  /// Where the segment starts that certainly meets the box, and no other.
  enum class Start {
    kApart,    ///< it may not meet the box
    kOutside,  ///< or inside
    kInside
  };
  std::uint32_t record;
  double t;
  Start start = Start::kApart;

  bool isApart() const { return start == Start::kApart; }
};

/// Distance and parameter, correctly rounded, and the points, as SegmentDistance has them.
struct alignas(32) RoundedNearest {
  double on_segment[4];
  double on_box[4];
  double distance;
  double t;
};

/// A component and an oriented box.
///
/// @pre All numbers are compact (see bounds::kSmallest), the direction is not zero.
struct CrossingQuery {
  const double* quaternion;  ///< x, y, z, w
  const double* center;
  const double* half_extents;
  const double* origin;
  const double* direction;
  const double* direction_low;  ///< what the direction lacks of the exact one
  bool has_start;
  bool has_end;
};

/// Where a component crosses the surface of a box: at one face and certainly no other, or at the
/// component's own start or end.
struct Crossing {
  static constexpr int kOwn = -1;
  int axis;
  bool positive;  ///< the face is on the positive side of the axis
  /// The parameter: t[0] + t[1] within an error.
  double t[2];
  double error;
};

enum class Crossed { kMiss, kHit, kUnclear };

/// A segment that comes near an oriented box, and about where it is nearest.
struct RefineQuery {
  const double* quaternion;  ///< x, y, z, w
  const double* center;
  const double* half_extents;
  const double* start;
  const double* end;
  double t;
};

/// Where a segment is nearest to a box and how near, each x[0] + x[1] within an error.
struct Refined {
  bool inside;  ///< or else it is certainly nearest at the start, or the end, where t is 0 or 1
  double t[2];
  double t_error;
  double distance[2];
  double distance_error;
};

constexpr int kRoundLanes = 8;
/// How often a parameter is guessed. One from floats may be far from the nearest point, or beside
/// another part of the box: what is refined from there is nearer.
constexpr int kGuesses = 3;

/// Segments, and of each the record of a box, and a parameter near the one where it is nearest.
struct alignas(64) RoundQueries {
  const double* segment[kRoundLanes];  ///< start and end: six numbers
  /// What takes eight numbers: distance and parameter, correctly rounded, and the points, of the
  /// segment and of the box, as SegmentDistance has them.
  double* rounded[kRoundLanes];
  double t[kRoundLanes];
  std::uint32_t record[kRoundLanes];
};

}  // namespace box_query::kernels
