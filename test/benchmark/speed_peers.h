// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a user would pick instead, each in a file of its own that is compiled where it is
/// installed.
#pragma once

#include "benchmark/speed.h"

#include <algorithm>
#include <string>
#include <vector>

namespace box_query::benchmark {

struct Peer {
  std::string note;  ///< Which version, or how to get one.
  std::vector<SpeedMethodKind> methods;
};

Peer bulletPeer();
Peer embreePeer();
Peer fclPeer();
Peer odePeer();

/// All that were found when this was built, and for the others no more than a note.
const std::vector<Peer>& peers();

template <typename Method>
std::unique_ptr<SpeedMethod> makeMethod(const std::vector<OrientedBox>& boxes) {
  return std::make_unique<Method>(boxes);
}

/// From `box`'s center at most so far away is every point of it.
inline double radiusOf(const OrientedBox& box) {
  return box.half_extents.norm();
}

/// Bounds of the boxes, wide rather than tight.
struct Extent {
  Vector3 lo = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 hi = -lo;

  explicit Extent(const std::vector<OrientedBox>& boxes) {
    for (const OrientedBox& box : boxes) {
      lo = lo.cwiseMin((box.center.array() - radiusOf(box)).matrix());
      hi = hi.cwiseMax((box.center.array() + radiusOf(box)).matrix());
    }
  }
};

/// For those that know segments only: how long one from `origin` is that leaves all boxes behind,
/// for an unlimited range, else what `question` says.
inline double lengthOf(Question question, const Extent& extent, const Vector3& origin) {
  if (question != Question::kClosest) {
    return question == Question::kSegment ? kSegmentLength : kRange;
  }
  return (origin - extent.lo).cwiseAbs().cwiseMax((origin - extent.hi).cwiseAbs()).norm();
}

}  // namespace box_query::benchmark
