// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Families at the limits of what the stages of the library take, on both sides of them: see
/// exact/bounds.h, exact/distance_bounds.h and kernels/scene_view.h.
#pragma once

#include "stress/scene_families.h"
#include "stress/target.h"

namespace box_query::stress {

/// v times a power of two.
Vector3 scaled(const Vector3& v, int power);
/// The box and where the component is, not its direction.
void scalePlaces(Sample& sample, int power);

/// Sizes of boxes and places, components of directions, norms of quaternions, ends of segments.
Sample stageLimits(Random& random, bool oriented);
/// Places and sizes in a scene, relative to its center; directions.
SceneSample sceneLimits(Random& random);

}  // namespace box_query::stress
