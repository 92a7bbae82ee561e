// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What can be spoilt in the mutant of the core (mutant_core.cmake).
#pragma once

namespace box_query {

struct Mutation {
  bool touching_misses = false;     ///< A tie's sign is flipped: a touch of one point is a miss.
  bool ties_name_one_face = false;  ///< Faces entered at the same time: only the first counts.
  bool skip_exact_stage = false;    ///< What double-double cannot tell is believed all the same.
  bool skip_slow_stages = false;    ///< What double cannot tell is called a hit.
  bool skip_rounding_test = false;  ///< What double-double has is rounded however close to a tie.
  bool refine_by_axes = false;      ///< Distances are refined as without kernels, which is right.
};

inline Mutation mutation;

}  // namespace box_query
