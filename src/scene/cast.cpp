// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/solve.h"
#include "scene/scene_impl.h"

#include <box_query/scene.h>

#include <algorithm>
#include <variant>

namespace box_query {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// A range in metres as bounds of the parameter: up to `inside` certainly within, beyond `outside`
/// certainly not.
struct Reach {
  double inside;
  double outside;
};

Reach reachOf(const DoubleComponent& c, double max_range) {
  if (!c.moderate || max_range == kInf) {
    return {c.moderate ? kInf : -kInf, kInf};
  }
  const double* d = c.direction;
  const double t = max_range / std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  return {t / exact::bounds::kInflate - exact::bounds::kUnderflow,
          t * exact::bounds::kInflate + exact::bounds::kUnderflow};
}

Solution solveBox(const Ray& ray, const DoubleComponent& component, const Box& box,
                  const PreparedBox& prepared) {
  const bool moderate = prepared.kind != PreparedBox::Kind::kExactOnly;
  if (const auto* aligned = std::get_if<AlignedBox>(&box)) {
    return solve(ray, component, *aligned,
                 Prepared<AlignedSlabs>{prepared.aligned, moderate, prepared.compact});
  }
  return solve(ray, component, *std::get_if<OrientedBox>(&box),
               Prepared<OrientedSlabs>{prepared.oriented, moderate, prepared.compact});
}

/// A box that the ray certainly meets, entered at a parameter in [enter_lo, enter_hi].
struct Candidate {
  std::size_t box = kNoBox;
  double enter_lo = kInf;
  double enter_hi = kInf;
  std::optional<Solution> solution;
};

/// Finds the closest box. Boxes are offered in order of their index, so that a tie changes nothing.
class Closest {
 public:
  Closest(const Ray& ray, const DoubleComponent& component, const std::vector<Box>& boxes,
          const std::vector<PreparedBox>& prepared)
      : ray_(ray), component_(component), boxes_(boxes), prepared_(prepared) {}

  std::size_t box() const { return best_.box; }

  /// A box that is entered here or later cannot be the closest any more.
  double bound() const { return best_.enter_hi; }

  Solution& solution() { return solutionOf(best_); }

  /// A box that is certainly met, or else one that may be.
  void offerHit(std::size_t box, double enter_lo, double enter_hi) {
    take({box, enter_lo, enter_hi, std::nullopt});
  }
  void offerUndecided(std::size_t box, const Enclosure& e) {
    Candidate candidate{box, e.enter_lo, e.exit_hi, std::nullopt};
    if (solutionOf(candidate).num_points > 0) {
      take(std::move(candidate));
    }
  }

 private:
  void take(Candidate&& candidate) {
    if (best_.box == kNoBox || candidate.enter_hi < best_.enter_lo || isBefore(candidate, best_)) {
      best_ = std::move(candidate);
    }
  }

  bool isBefore(Candidate& a, Candidate& b) {
    return compareEntries(ray_, boxes_[a.box], solutionOf(a), boxes_[b.box], solutionOf(b)) < 0;
  }

  Solution& solutionOf(Candidate& c) {
    if (!c.solution) {
      c.solution = solveBox(ray_, component_, boxes_[c.box], prepared_[c.box]);
    }
    return *c.solution;
  }

  const Ray& ray_;
  const DoubleComponent& component_;
  const std::vector<Box>& boxes_;
  const std::vector<PreparedBox>& prepared_;
  Candidate best_;
};

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

Hit Scene::cast(const Ray& ray, double max_range, const BoxMask* mask) const noexcept {
  const DoubleComponent component = doubleComponent(ray);
  const Reach reach = reachOf(component, max_range);
  Closest closest(ray, component, impl_->simplest, impl_->prepared);
  forEachBox(size(), mask, [&](std::size_t i) {
    const PreparedBox& box = impl_->prepared[i];
    const Enclosure e = enclose<Ray>(component, box);
    if (e.isMiss() || e.enter_lo >= closest.bound() || e.enter_lo > reach.outside) {
      return true;
    }
    if (e.isHit()) {
      closest.offerHit(i, e.enter_lo, e.enter_hi);
    } else if (crossesThinSlab<Ray>(component, box)) {
      closest.offerHit(i, e.enter_lo, e.exit_hi);
    } else {
      closest.offerUndecided(i, e);
    }
    return true;
  });
  if (closest.box() == kNoBox) {
    return {};
  }
  return hitOf(ray, component, closest.box(), impl_->boxes[closest.box()],
               impl_->simplest[closest.box()], closest.solution(), max_range);
}

bool Scene::castAny(const Ray& ray, double max_range, const BoxMask* mask) const noexcept {
  const DoubleComponent component = doubleComponent(ray);
  const Reach reach = reachOf(component, max_range);
  bool any = false;
  bool undecided = false;
  forEachBox(size(), mask, [&](std::size_t i) {
    const PreparedBox& box = impl_->prepared[i];
    const Enclosure e = enclose<Ray>(component, box);
    if (!e.isMiss() && e.enter_lo <= reach.outside) {
      any = (e.isHit() && e.enter_hi <= reach.inside) ||
            (e.exit_hi <= reach.inside && crossesThinSlab<Ray>(component, box));
      undecided = undecided || !any;
    }
    return !any;
  });
  if (any || !undecided) {
    return any;
  }
  const exact::DoubleDouble length = directionLength(ray);
  forEachBox(size(), mask, [&](std::size_t i) {
    const Enclosure e = enclose<Ray>(component, impl_->prepared[i]);
    if (!e.isMiss() && e.enter_lo <= reach.outside) {
      Solution solution = solveBox(ray, component, impl_->simplest[i], impl_->prepared[i]);
      any = solution.num_points > 0 &&
            std::visit(
                [&](const auto& b) { return isEnteredWithin(ray, b, solution, max_range, length); },
                impl_->simplest[i]);
    }
    return !any;
  });
  return any;
}

}  // namespace box_query
