// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <box_query/geometry.h>

namespace box_query {

/// A point that rounding has left near the box, clamped to it, and exactly onto the given faces.
Vector3 movedInto(const AlignedBox& box, const Vector3& point, FaceSet faces);

/// The same in the frame of the box. Only the correction, which is tiny, is turned back into the
/// world, so that no more than the point's own rounding is lost.
Vector3 movedInto(const OrientedBox& box, const Vector3& point, FaceSet faces);

}  // namespace box_query
