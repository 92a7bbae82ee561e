// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/aligned_form.h"
#include "geometry/solve.h"
#include "scene/scene_impl.h"
#include "scene/search.h"

#include <box_query/scene.h>

#include <algorithm>
#include <variant>

namespace box_query {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// Outward normal of the face of the lowest axis in the set.
Vector3 outwardNormal(FaceSet faces, const Box& box, bool is_aligned) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool positive : {false, true}) {
      if (faces.contains(axis, positive)) {
        Vector3 normal = Vector3::Unit(axis);
        if (const auto* oriented = std::get_if<OrientedBox>(&box)) {
          const auto& a = boxAxes(oriented->orientation).of[axis];
          normal = Vector3(a[0], a[1], a[2]);
        }
        if (is_aligned) {
          normal = normal.array().round();
        }
        return positive ? normal : Vector3(-normal);
      }
    }
  }
  return Vector3::Zero();
}

/// The hit on a box, rounded; a miss if that is out of range.
/// @param max_range +inf if the hit is known to be in range
Hit hitOf(const Ray& ray, const DoubleComponent& component, std::size_t index, const Box& box,
          const Box& simplest, Solution& solution, double max_range) {
  const exact::DoubleDouble length = directionLength(ray);
  return std::visit(
      [&](const auto& b) -> Hit {
        if (!isEnteredWithin(ray, b, solution, max_range, length)) {
          return {};
        }
        Hit hit;
        hit.hit = true;
        hit.box = index;
        hit.range = roundedRange(ray, b, solution, End::kEnter, length);
        hit.exit_range = roundedRange(ray, b, solution, End::kExit, length);
        hit.t = roundedParameter(ray, b, solution, End::kEnter);
        hit.started_inside = solution.started_inside;
        hit.point = pointAt(ray, component, b, solution, End::kEnter, hit.t);
        hit.entered = solution.entered;
        const bool is_aligned = std::holds_alternative<AlignedBox>(simplest);
        if (const auto* oriented = std::get_if<OrientedBox>(&box); oriented && is_aligned) {
          hit.entered = alignedForm(*oriented)->ownFaces(hit.entered);
        }
        hit.normal =
            hit.started_inside ? Vector3::Zero() : outwardNormal(hit.entered, box, is_aligned);
        return hit;
      },
      simplest);
}

}  // namespace

void Scene::Impl::offerAll(FirstEntered<Ray>& first, double max_range, const BoxMask* mask,
                           const kernels::Found* found) const {
  if (found != nullptr) {
    first.offer(*found);
    offerOthers(first, true, max_range, mask);
  } else {
    findFirst(first, max_range, mask);
  }
}

Hit Scene::Impl::hitOf(const Ray& ray, double max_range, const BoxMask* mask,
                       const kernels::Found* found) const {
  if (found != nullptr && found->count == 0 && tree.left_out().empty()) {
    return {};
  }
  FirstEntered<Ray> first(ray, boxes);
  offerAll(first, max_range, mask, found);
  if (!first.any()) {
    return {};
  }
  if (found != nullptr && first.upper() <= found->t_inside) {
    max_range = kInf;
  }
  return box_query::hitOf(ray, first.component(), first.box(), boxes.given()[first.box()],
                          boxes.simplest(first.box()), first.solution(), max_range);
}

ClosestBox Scene::Impl::closestOf(const Ray& ray, double max_range, const BoxMask* mask,
                                  const kernels::Found* found) const {
  if (found != nullptr && tree.left_out().empty()) {
    // As a rule the kernel has decided everything.
    const kernels::Candidate& c = found->candidates[0];
    if (found->count == 0) {
      return {};
    }
    if (found->count == 1 && c.certain && c.enter_hi <= found->t_inside) {
      return {true, c.box, c.enter_lo, c.enter_hi};
    }
  }
  return decidedClosestOf(ray, max_range, mask, found);
}

ClosestBox Scene::Impl::decidedClosestOf(const Ray& ray, double max_range, const BoxMask* mask,
                                         const kernels::Found* found) const {
  FirstEntered<Ray> first(ray, boxes);
  offerAll(first, max_range, mask, found);
  if (!first.any()) {
    return {};
  }
  if (max_range < kInf && !(first.upper() <= reachOf(first.component(), max_range).inside) &&
      !std::visit(
          [&](const auto& box) {
            return isEnteredWithin(ray, box, first.solution(), max_range, directionLength(ray));
          },
          boxes.simplest(first.box()))) {
    return {};
  }
  return {true, first.box(), first.lower(), first.upper()};
}

/// Calls answer(found) with what the kernels find, or null where they leave it open; a miss, which
/// is what its result begins as, needs no more.
template <typename Answer>
[[gnu::always_inline]] inline auto Scene::Impl::castByKernels(const Ray& ray, double max_range,
                                                              const BoxMask* mask,
                                                              Answer&& answer) const
    -> decltype(answer(nullptr)) {
  kernels::Found found(&work_of_thread);
  const kernels::Answer found_out = kernels.closest(view, rayQuery(ray, max_range, mask), found);
  if (found_out == kernels::Answer::kNone && tree.left_out().empty()) {
    return {};
  }
  return answer(found_out != kernels::Answer::kNotTaken ? &found : nullptr);
}

Hit Scene::cast(const Ray& ray, double max_range, const BoxMask* mask) const noexcept {
  return impl_->castByKernels(ray, max_range, mask, [&](const kernels::Found* found) {
    return impl_->hitOf(ray, max_range, mask, found);
  });
}

ClosestBox Scene::castClosest(const Ray& ray, double max_range,
                              const BoxMask* mask) const noexcept {
  return impl_->castByKernels(ray, max_range, mask, [&](const kernels::Found* found) {
    return impl_->closestOf(ray, max_range, mask, found);
  });
}

bool Scene::castAny(const Ray& ray, double max_range, const BoxMask* mask) const noexcept {
  return impl_->meetsAny(ray, max_range, mask);
}

}  // namespace box_query
