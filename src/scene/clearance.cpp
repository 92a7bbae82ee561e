// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/distance_exact.h"
#include "geometry/distance_query.h"
#include "geometry/prepared_box.h"
#include "geometry/solve.h"
#include "scene/bounding_spheres.h"
#include "scene/scene_impl.h"
#include "scene/search.h"

#include <box_query/distance.h>
#include <box_query/intersection.h>
#include <box_query/scene.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

namespace box_query {
namespace {

NearestEstimate estimateFor(const Segment& segment, const PreparedBox& box) {
  switch (box.kind) {
    case PreparedBox::Kind::kAligned:
      return estimateNearest(segment, box.aligned);
    case PreparedBox::Kind::kOriented:
      return estimateNearest(segment, box.oriented);
    case PreparedBox::Kind::kExactOnly:
      break;
  }
  return {};
}

bool meet(const Segment& segment, const Box& any) {
  return std::visit([&](const auto& box) { return testIntersection(segment, box); }, any);
}

bool isFartherThan(const Segment& segment, const Box& any, const NearestEstimate& estimate,
                   double radius) {
  return std::visit([&](const auto& box) { return isFarther(segment, box, estimate, radius); },
                    any);
}

/// A box that may be the nearest one.
struct Nearby {
  std::size_t box = kNoBox;
  NearestEstimate estimate;
  std::optional<exact::Ratio> squared;
};

/// The exact squared distance, computed once.
const exact::Ratio& squaredDistance(const Segment& segment, const Box& box, Nearby& nearby) {
  if (!nearby.squared) {
    nearby.squared =
        std::visit([&](const auto& b) { return exactSquaredDistance(segment, b); }, box);
  }
  return *nearby.squared;
}

/// A box within the radius.
struct Blocking {
  std::size_t box = kNoBox;
  NearestEstimate estimate;
  /// Of the first parameter within the radius.
  ParameterBounds bounds{0.0, 1.0};
  std::optional<exact::Root> root;
};

const exact::Root& firstRoot(const Segment& segment, const Box& box, double radius,
                             Blocking& blocking) {
  if (!blocking.root) {
    blocking.root = exact::firstWithin(exact::segmentAtBox(segment, box), radius);
  }
  return *blocking.root;
}

ParameterBounds firstWithinBounds(const NearestEstimate& estimate, double radius) {
  const SegmentSlabs& slabs = estimate.slabs;
  if (!slabs.isInRange()) {
    return {0.0, 1.0};
  }
  const Excess start = excessAt(slabs, 0.0);
  if (std::sqrt(dot(start, start)) + slabs.error() <= radius) {
    return {0.0, 0.0};
  }
  return firstWithinBounds(slabs, radius, guessFirstWithin(slabs, radius));
}

}  // namespace

bool Scene::isClear(const Segment& segment, double radius, const BoxMask* mask) const noexcept {
  if (radius == 0.0) {
    const DoubleComponent component = doubleComponent(segment);
    return !impl_->meetsAny(segment, component, 1.0, 1.0, mask,
                            [&](std::size_t i) { return meet(segment, impl_->simplest[i]); });
  }
  const SphereFilter spheres(segment, impl_->spheres);
  bool clear = true;
  forEachBox(size(), mask, [&](std::size_t i) {
    if (!spheres.isBeyond(i, radius)) {
      const Box& box = impl_->simplest[i];
      clear = isFartherThan(segment, box, estimateFor(segment, impl_->prepared[i]), radius);
    }
    return clear;
  });
  return clear;
}

Clearance Scene::clearance(const Segment& segment, const BoxMask* mask) const noexcept {
  const SphereFilter spheres(segment, impl_->spheres);
  Nearby nearest;
  forEachBox(size(), mask, [&](std::size_t i) {
    if (nearest.box != kNoBox && spheres.isBeyond(i, nearest.estimate.bounds.upper)) {
      return true;
    }
    const Box& box = impl_->simplest[i];
    Nearby other{i, estimateFor(segment, impl_->prepared[i]), std::nullopt};
    if (other.estimate.bounds.lower <= 0.0 && meet(segment, box)) {
      nearest = std::move(other);
      return false;  // nothing is nearer, and a tie would go to this one
    }
    const DistanceBounds& a = nearest.estimate.bounds;
    const DistanceBounds& b = other.estimate.bounds;
    const bool is_nearer =
        nearest.box == kNoBox || b.upper < a.lower ||
        (b.lower <= a.upper &&
         compare(squaredDistance(segment, box, other),
                 squaredDistance(segment, impl_->simplest[nearest.box], nearest)) < 0);
    if (is_nearer) {
      nearest = std::move(other);
    }
    return true;
  });
  if (nearest.box == kNoBox) {
    return {};
  }
  const SegmentDistance d =
      std::visit([&](const auto& box) { return roundedDistance(segment, box, nearest.estimate); },
                 impl_->simplest[nearest.box]);
  return {nearest.box, d.distance, d.t, d.on_segment, d.on_box};
}

Blockage Scene::Impl::firstMet(const Segment& segment, const BoxMask* mask) const {
  const DoubleComponent component = doubleComponent(segment);
  FirstEntered<Segment> first(segment, component, simplest, prepared);
  findFirst(first, component, 1.0, mask);
  if (!first.any()) {
    return {};
  }
  const double blocked_at = std::visit(
      [&](const auto& b) { return roundedParameter(segment, b, first.solution(), End::kEnter); },
      simplest[first.box()]);
  return {true, first.box(), blocked_at};
}

Blockage Scene::firstBlockage(const Segment& segment, double radius,
                              const BoxMask* mask) const noexcept {
  if (radius == 0.0) {
    return impl_->firstMet(segment, mask);
  }
  const SphereFilter spheres(segment, impl_->spheres);
  Blocking first;
  forEachBox(size(), mask, [&](std::size_t i) {
    if (spheres.isBeyond(i, radius, first.bounds.upper)) {
      return true;
    }
    const Box& box = impl_->simplest[i];
    Blocking other{i, estimateFor(segment, impl_->prepared[i]), {}, std::nullopt};
    if (isFartherThan(segment, box, other.estimate, radius)) {
      return true;
    }
    other.bounds = firstWithinBounds(other.estimate, radius);
    const bool is_earlier =
        first.box == kNoBox || other.bounds.upper < first.bounds.lower ||
        (other.bounds.lower <= first.bounds.upper &&
         compare(firstRoot(segment, box, radius, other),
                 firstRoot(segment, impl_->simplest[first.box], radius, first)) < 0);
    if (is_earlier) {
      first = std::move(other);
    }
    return first.bounds.upper > 0.0;  // nothing is earlier than the start
  });
  if (first.box == kNoBox) {
    return {};
  }
  const double blocked_at = std::visit(
      [&](const auto& box) { return blockedAt(segment, box, radius); }, impl_->simplest[first.box]);
  return {true, first.box, blocked_at};
}

}  // namespace box_query
