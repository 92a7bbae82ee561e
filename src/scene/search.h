// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How a query goes through the boxes of a scene: the kernels first, then whatever they leave.
#pragma once

#include "scene/candidates.h"
#include "scene/first_entered.h"
#include "scene/scene_impl.h"

namespace box_query {

template <typename T>
void Scene::Impl::findFirst(FirstEntered<T>& first, const DoubleComponent& component, double t_end,
                            const BoxMask* mask) const {
  const bool for_kernels = isForKernels(component, view);
  if (for_kernels) {
    kernels::Found found;
    kernels.closest(view, rayQuery<T>(component, t_end, mask), found, FirstEntered<T>::take,
                    &first);
    first.offer(found);
  }
  forEachOther(tree, for_kernels, boxes.size(), mask, [&](std::size_t i) {
    first.offer(i, t_end);
    return true;
  });
}

template <typename T, typename Decide>
bool Scene::Impl::meetsAny(const T&, const DoubleComponent& component, double t_inside,
                           double t_end, const BoxMask* mask, Decide&& decide) const {
  struct Undecided {
    const Impl& scene;
    const DoubleComponent& component;
    double t_inside;
    Decide& decide;
    bool met = false;

    bool isMet(const kernels::Candidate& c) {
      return (c.exit_hi <= t_inside && crossesThinSlab<T>(component, scene.prepared[c.box])) ||
             decide(c.box);
    }
    static double take(void* context, const kernels::Found& found) {
      auto& self = *static_cast<Undecided*>(context);
      self.met = self.met || !forEachCandidate(found, [&](const kernels::Candidate& c) {
                   return !self.isMet(c);
                 });
      return self.met ? -1.0 : 1.0;
    }
  };
  Undecided undecided{*this, component, t_inside, decide};
  const bool for_kernels = isForKernels(component, view);
  if (for_kernels) {
    kernels::Found found;
    if (kernels.any(view, rayQuery<T>(component, t_end, mask), t_inside, found, Undecided::take,
                    &undecided) ||
        undecided.met || Undecided::take(&undecided, found) < 0.0) {
      return true;
    }
  }
  // Those that doubles decide come first: nothing else may be needed.
  for (const bool slowly : {false, true}) {
    forEachOther(tree, for_kernels, boxes.size(), mask, [&](std::size_t i) {
      const kernels::Candidate c = candidateOf<T>(component, prepared[i], i);
      if (c.enter_lo <= c.exit_hi && c.enter_lo <= t_end) {
        undecided.met = slowly ? undecided.isMet(c) : c.certain && c.enter_hi <= t_inside;
      }
      return !undecided.met;
    });
  }
  return undecided.met;
}

/// Whether the kernels may take a segment.
inline bool isForKernels(const Segment& segment, const kernels::SceneView& view) {
  bool near = true;
  for (int i = 0; i < 3; ++i) {
    near = near && std::fabs(segment.start[i] - view.center[i]) <= kernels::kFarthestOrigin &&
           std::fabs(segment.end[i] - view.center[i]) <= kernels::kFarthestOrigin;
  }
  return near;
}

template <typename Visit>
void Scene::Impl::forEachNear(const Segment& segment, double bound, bool shrinks,
                              const BoxMask* mask, Visit&& visit) const {
  const bool for_kernels = isForKernels(segment, view);
  bool ended = false;
  if (for_kernels) {
    const kernels::SegmentQuery query{{segment.start[0], segment.start[1], segment.start[2]},
                                      {segment.end[0], segment.end[1], segment.end[2]},
                                      bound,
                                      shrinks,
                                      mask != nullptr ? mask->words() : nullptr};
    struct Context {
      Visit& visit;
      bool& ended;
    } context{visit, ended};
    const auto approach = [](void* to, std::uint32_t box) {
      auto& c = *static_cast<Context*>(to);
      const double next = c.visit(std::size_t{box});
      c.ended = next < 0.0;
      return next;
    };
    kernels::Work work;
    kernels.nearest(view, query, approach, &context, work);
  }
  if (!ended) {
    forEachOther(tree, for_kernels, boxes.size(), mask,
                 [&](std::size_t i) { return visit(i) >= 0.0; });
  }
}

}  // namespace box_query
