// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Oriented boxes that are aligned ones, exactly: turned by 0, 90, 120 or 180 degrees, with bounds
/// that doubles hold.
#pragma once

#include <box_query/geometry.h>

#include <array>
#include <cstdint>
#include <optional>

namespace box_query {

struct AlignedForm {
  AlignedBox box;
  /// The oriented box's own number of each face of the aligned one.
  std::array<std::uint8_t, 6> own_face;

  FaceSet ownFaces(FaceSet faces) const {
    unsigned own = 0;
    for (unsigned face = 0; face < 6; ++face) {
      own |= ((static_cast<unsigned>(faces.bits()) >> face) & 1U) << own_face[face];
    }
    return FaceSet(own);
  }
};

/// The same solid as an aligned box, if it is one.
std::optional<AlignedForm> findAlignedForm(const OrientedBox& box);

/// The same, quick to say that a box of any old orientation is none.
inline std::optional<AlignedForm> alignedForm(const OrientedBox& box) {
  const Quaternion& q = box.orientation;
  const bool any_zero = q.w() == 0.0 || q.x() == 0.0 || q.y() == 0.0 || q.z() == 0.0;
  if (!any_zero && (q.w() != q.x() && q.w() != -q.x())) {
    return std::nullopt;
  }
  return findAlignedForm(box);
}

}  // namespace box_query
