// SPDX-License-Identifier: BSD-3-Clause
#include "exact/stage_counters.h"
#include "geometry/distance_exact.h"
#include "geometry/distance_points.h"
#include "geometry/distance_query.h"
#include "geometry/prepared_box.h"
#include "geometry/solve.h"
#include "scene/nearest_box.h"
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

bool isFartherThan(const Segment& segment, const Box& any, const DistanceBounds& bounds,
                   double radius) {
  // (What the bounds decide needs no box, which may be far away in memory.)
  return bounds.lower > radius ||
         (bounds.upper > radius &&
          std::visit([&](const auto& box) { return isFarther(segment, box, bounds, radius); },
                     any));
}

/// A box within the radius, with constructors of its own too.
struct Blocking {
  Blocking() {}  // NOLINT(modernize-use-equals-default)
  Blocking(std::size_t number, const NearestEstimate& e) : box(number), estimate(e) {}

  std::size_t box = kNoBox;
  NearestEstimate estimate;
  /// Of the first parameter within the radius.
  ParameterBounds bounds{0.0, 1.0};
  std::optional<exact::Root> root;
};

const exact::Root& firstRoot(const Segment& segment, const Box& box, double radius,
                             Blocking& blocking) {
  if (!blocking.root) {
    ++exact::stageCounters().exact_decisions;
    blocking.root = exact::firstWithin(exact::segmentAtBox(segment, box), radius);
  }
  return *blocking.root;
}

/// Exact order, ties by the index.
bool isEarlier(const Segment& segment, const SceneBoxes& boxes, double radius, Blocking& a,
               Blocking& b) {
  if (a.bounds.upper == 0.0 && b.bounds.upper == 0.0) {
    return a.box < b.box;  // both from the start
  }
  const int order = compare(firstRoot(segment, boxes.simplest(a.box), radius, a),
                            firstRoot(segment, boxes.simplest(b.box), radius, b));
  return order < 0 || (order == 0 && a.box < b.box);
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
  if (radius == 0.0 && segment.start != segment.end) {
    return !impl_->meetsAny(segment, std::numeric_limits<double>::infinity(), mask);
  }
  // As a rule the kernel decides everything.
  switch (impl_->anyWithin(segment, radius, mask)) {
    case kernels::Answer::kYes:
      return false;
    case kernels::Answer::kNone:
      return true;
    default:
      return impl_->areFartherThan(segment, radius, mask);
  }
}

kernels::Answer Scene::Impl::anyWithin(const Segment& segment, double radius,
                                       const BoxMask* mask) const {
  if (!isForKernels(radius, view)) {
    return kernels::Answer::kNotTaken;
  }
  constexpr double kInf = std::numeric_limits<double>::infinity();
  kernels::Found found(&work_of_thread);
  const kernels::Answer answer =
      kernels.any_within(view, rayQuery(segment, kInf, mask, radius), found);
  return answer == kernels::Answer::kNone && !tree.left_out().empty() ? kernels::Answer::kNotTaken
                                                                      : answer;
}

/// (Not inlined, so that a segment that meets nothing needs no room for it.)
[[gnu::noinline]] bool Scene::Impl::areFartherThan(const Segment& segment, double radius,
                                                   const BoxMask* mask) const {
  bool clear = true;
  forEachNear(segment, radius, false, mask,
              [&](std::size_t i, const DistanceBounds& bounds, const auto&) {
                clear = isFartherThan(segment, boxes.simplest(i), bounds, radius);
                return clear ? radius : -1.0;
              });
  return clear;
}

Clearance Scene::Impl::clearanceTo(const Segment& segment, const kernels::SegmentQuery& query,
                                   const kernels::NearestOne& one) const {
  if (!one.isApart()) {
    return clearanceOfMet(segment, one);
  }
  const std::size_t box = view.box_of_record[one.record];
  kernels::RoundedNearest rounded;
  if (!kernels.round_nearest(view, query, one, rounded)) {
    return clearanceTo(segment, box);
  }
  const auto point = [](const double* p) { return Vector3(p[0], p[1], p[2]); };
  return {box, rounded.distance, rounded.t, point(rounded.on_segment), point(rounded.on_box)};
}

Clearance Scene::Impl::clearanceOfMet(const Segment& segment,
                                      const kernels::NearestOne& one) const {
  const std::size_t number = view.box_of_record[one.record];
  const SegmentDistance met =
      one.start == kernels::NearestOne::Start::kInside
          ? fromInside(segment)
          : std::visit([&](const auto& box) { return distanceOfMet(segment, box); },
                       boxes.simplest(number));
  return {number, met.distance, met.t, met.on_segment, met.on_box};
}

Clearance Scene::clearance(const Segment& segment, const BoxMask* mask) const noexcept {
  const SceneBoxes& boxes = impl_->boxes;
  const kernels::SceneView& view = impl_->view;
  if (mask != nullptr || !impl_->tree.left_out().empty() || !isForKernels(segment, view) ||
      impl_->kernels.nearest_one == nullptr) {
    NearestBox nearest(segment, boxes);
    impl_->forEachNear(segment, std::numeric_limits<double>::infinity(), true, mask,
                       [&](std::size_t i, const DistanceBounds& bounds, const auto& estimate) {
                         return nearest.offer(i, bounds, estimate);
                       });
    return nearest.clearance();
  }
  struct Context {
    const Segment& segment;
    const SceneBoxes& boxes;
    NearestOffered offered;
  } context{segment, boxes, NearestOffered()};
  const auto approach = [](void* to, std::uint32_t box, const kernels::NearBox& near) {
    auto& c = *static_cast<Context*>(to);
    return c.offered.offer(c.segment, c.boxes, box, near);
  };
  const kernels::SegmentQuery query = nearestQuery(segment, nullptr);
  kernels::NearestOne one;
  const bool is_one =
      impl_->kernels.nearest_one(view, query, approach, &context, &one, work_of_thread);
  const std::optional<NearestBox>& nearest = context.offered.nearest;
  if (!is_one) {
    if (!context.offered.isApart(view)) {
      return nearest ? nearest->clearance() : Clearance();
    }
    one = {context.offered.record, nearest->guess()};
  }
  return impl_->clearanceTo(segment, query, one);
}

Blockage Scene::Impl::firstMet(const Segment& segment, const BoxMask* mask) const {
  FirstEntered<Segment> first(segment, boxes);
  findFirst(first, std::numeric_limits<double>::infinity(), mask);
  if (!first.any()) {
    return {};
  }
  const double blocked_at = std::visit(
      [&](const auto& b) { return roundedParameter(segment, b, first.solution(), End::kEnter); },
      boxes.simplest(first.box()));
  return {true, first.box(), blocked_at};
}

Blockage Scene::firstBlockage(const Segment& segment, double radius,
                              const BoxMask* mask) const noexcept {
  if (radius == 0.0) {
    return impl_->firstMet(segment, mask);
  }
  if (impl_->anyWithin(segment, radius, mask) == kernels::Answer::kNone) {
    return {};
  }
  Blocking first;
  impl_->forEachNear(segment, radius, false, mask,
                     [&](std::size_t i, const DistanceBounds& bounds, const auto& estimate) {
                       if (isFartherThan(segment, impl_->boxes.simplest(i), bounds, radius)) {
                         return radius;
                       }
                       Blocking other(i, estimate());
                       other.bounds = firstWithinBounds(other.estimate, radius);
                       const bool is_earlier =
                           first.box == kNoBox || other.bounds.upper < first.bounds.lower ||
                           (other.bounds.lower <= first.bounds.upper &&
                            isEarlier(segment, impl_->boxes, radius, other, first));
                       if (is_earlier) {
                         first = std::move(other);
                       }
                       return radius;
                     });
  if (first.box == kNoBox) {
    return {};
  }
  const double blocked_at = std::visit(
      [&](const auto& box) { return roundedFirstWithin(segment, box, first.estimate, radius); },
      impl_->boxes.simplest(first.box));
  return {true, first.box, blocked_at};
}

}  // namespace box_query
