// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One query against one box: decided in double, if not in double-double, if not exactly; then
/// rounded, but only what is asked for.
#pragma once

#include "exact/clip.h"
#include "exact/estimate.h"
#include "geometry/planes.h"
#include "geometry/prepared_box.h"
#include "geometry/slabs.h"

#include <box_query/geometry.h>
#include <box_query/intersection.h>

#include <optional>

namespace box_query {

/// Whether the component meets the box, through all stages.
template <typename T, typename BoxType, typename SlabsType>
bool meetsByStages(const T& linear, const BoxType& box, const Prepared<SlabsType>& prepared);

/// Whether the component meets the box.
template <typename T>
inline bool meets(const T& linear, const AlignedBox& box, const Prepared<AlignedSlabs>& prepared) {
  return meetsByStages(linear, box, prepared);
}
template <typename T>
inline bool meets(const T& linear, const OrientedBox& box,
                  const Prepared<OrientedSlabs>& prepared) {
  const Verdict quick = quickVerdict(linear, prepared.slabs);
  return quick.certain ? quick.hit : meetsByStages(linear, box, prepared);
}

/// An end of what of a component lies in a box, at a face or at the component's own end. What is
/// not known of its parameter yet is worked out for whoever asks.
struct Crossing {
  int axis = 0;
  bool positive = false;
  std::optional<CertifiedParameter> t;
  std::optional<exact::Estimate> estimate;
};

/// What of a component lies in a box: everything is decided, nothing is rounded.
struct Solution {
  // Not defaulted: value-initialisation would clear `exactly`, 2 kB, every time.
  Solution() noexcept {}  // NOLINT(modernize-use-equals-default)

  int num_points = 0;
  bool started_inside = false;
  FaceSet entered;
  FaceSet left;
  /// Entry and exit; without meaning where `exactly` is set.
  Crossing enter;
  Crossing exit;
  /// The exact stage's own solution, where it was needed.
  std::optional<exact::Clip> exactly;
};

/// Of a box that is prepared only if it has to be.
template <typename T, typename BoxType>
Solution solve(const T& linear, const DoubleComponent& component, const BoxType& box);

/// -1, 0 or 1 as the first box is entered before, with or after the second.
template <typename T>
int compareEntries(const T& linear, const Box& box_a, Solution& a, const Box& box_b, Solution& b);

/// The length of a component's direction, the factor between parameters and metres, within
/// bounds::kOperation relative.
template <typename T>
exact::DoubleDouble directionLength(const T& linear);

/// Which end of the part of a component that lies in a box.
enum class End { kEnter, kExit };

/// The parameter and the distance in metres of an end of a solution that is a hit, correctly
/// rounded.
template <typename T, typename BoxType>
double roundedParameter(const T& linear, const BoxType& box, Solution& solution, End end);
template <typename T, typename BoxType>
double roundedRange(const T& linear, const BoxType& box, Solution& solution, End end,
                    const exact::DoubleDouble& length);

/// Whether a hit is entered at a distance of at most `max_range` metres.
template <typename T, typename BoxType>
bool isEnteredWithin(const T& linear, const BoxType& box, Solution& solution, double max_range,
                     const exact::DoubleDouble& length);

/// The point at an end of a solution that is a hit; `t` is its rounded parameter.
template <typename T, typename BoxType>
Vector3 pointAt(const T& linear, const DoubleComponent& component, const BoxType& box,
                Solution& solution, End end, double t);

/// Everything about a solution, rounded.
template <typename T, typename BoxType>
Intersection intersectionOf(const T& linear, const DoubleComponent& component, const BoxType& box,
                            Solution& solution) {
  Intersection result;
  result.num_points = solution.num_points;
  result.started_inside = solution.started_inside;
  if (solution.num_points > 0) {
    result.t_enter = roundedParameter(linear, box, solution, End::kEnter);
    result.t_exit = roundedParameter(linear, box, solution, End::kExit);
    result.entered = solution.entered;
    result.left = solution.left;
    result.enter_point = pointAt(linear, component, box, solution, End::kEnter, result.t_enter);
    result.exit_point = pointAt(linear, component, box, solution, End::kExit, result.t_exit);
  }
  return result;
}

}  // namespace box_query
