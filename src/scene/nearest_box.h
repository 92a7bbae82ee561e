// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which box is nearest to a segment, decided exactly.
#pragma once

#include "geometry/distance_exact.h"
#include "geometry/distance_query.h"
#include "scene/scene_boxes.h"

#include <box_query/distance.h>
#include <box_query/intersection.h>
#include <box_query/scene.h>

#include <limits>
#include <optional>
#include <utility>
#include <variant>

namespace box_query {

inline bool meet(const Segment& segment, const Box& any) {
  return std::visit([&](const auto& box) { return testIntersection(segment, box); }, any);
}

/// A box that may be the nearest one.
///
/// With constructors of its own: for others GCC clears all members first, also the room for exact
/// numbers that are hardly ever there, of 600 bytes.
struct Nearby {
  Nearby() {}  // NOLINT(modernize-use-equals-default)
  Nearby(std::size_t number, const DistanceBounds& b) : box(number), bounds(b) {}

  std::size_t box = kNoBox;
  DistanceBounds bounds{0.0, std::numeric_limits<double>::infinity()};
  std::optional<exact::Ratio> squared;
};

/// The exact squared distance, computed once.
inline const exact::Ratio& squaredDistance(const Segment& segment, const Box& box, Nearby& nearby) {
  if (!nearby.squared) {
    nearby.squared =
        std::visit([&](const auto& b) { return exactSquaredDistance(segment, b); }, box);
  }
  return *nearby.squared;
}

/// Exact order, ties by the index.
inline bool isNearer(const Segment& segment, const SceneBoxes& boxes, Nearby& a, Nearby& b) {
  const int order = compare(squaredDistance(segment, boxes.simplest(a.box), a),
                            squaredDistance(segment, boxes.simplest(b.box), b));
  return order < 0 || (order == 0 && a.box < b.box);
}

/// Takes boxes in any order; of those that are nearest the one of the lowest index stays.
class NearestBox {
 public:
  NearestBox(const Segment& segment, const SceneBoxes& boxes)
      : segment_(&segment), boxes_(&boxes) {}

  /// @param bounds an upper one of 0 says that the box is met
  /// @param estimate estimate() for the NearestEstimate
  /// @return how near a box must be from now on
  template <typename Estimate>
  double offer(std::size_t index, const DistanceBounds& bounds, Estimate&& estimate) {
    const Box& box = boxes_->simplest(index);
    Nearby other(index, bounds);
    const bool meets = bounds.upper == 0.0 || (bounds.lower <= 0.0 && meet(*segment_, box));
    // Nothing is nearer than a box that is met.
    const bool is_nearer = meets ? !met_ || index < nearest_.box
                                 : nearest_.box == kNoBox || bounds.upper < nearest_.bounds.lower ||
                                       (!met_ && bounds.lower <= nearest_.bounds.upper &&
                                        isNearer(*segment_, *boxes_, other, nearest_));
    if (is_nearer) {
      nearest_ = std::move(other);
      estimate_ = estimate();
    }
    met_ = met_ || meets;
    return met_ ? 0.0 : nearest_.bounds.upper;
  }

  /// The box, or null.
  const Box* box() const {
    return nearest_.box == kNoBox ? nullptr : &boxes_->simplest(nearest_.box);
  }

  std::size_t index() const { return nearest_.box; }

  /// Whether the box is certainly not met; and about where it is nearest.
  bool isApart() const { return nearest_.bounds.lower > 0.0; }
  double guess() const { return estimate_.guess.t; }

  Clearance clearance() const {
    if (nearest_.box == kNoBox) {
      return {};
    }
    const SegmentDistance d =
        std::visit([&](const auto& box) { return roundedDistance(*segment_, box, estimate_); },
                   boxes_->simplest(nearest_.box));
    return {nearest_.box, d.distance, d.t, d.on_segment, d.on_box};
  }

 private:
  const Segment* segment_;
  const SceneBoxes* boxes_;
  Nearby nearest_;
  NearestEstimate estimate_;
  bool met_ = false;
};

}  // namespace box_query
