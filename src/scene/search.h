// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How a query goes through the boxes of a scene: the kernels first, then whatever they leave.
#pragma once

#include "geometry/distance_query.h"
#include "geometry/solve.h"
#include "scene/candidates.h"
#include "scene/counters.h"
#include "scene/first_entered.h"
#include "scene/nearest_box.h"
#include "scene/scene_impl.h"

#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <variant>

namespace box_query {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

/// A range in metres as bounds of the parameter: up to `inside` certainly within, beyond `outside`
/// certainly not.
struct Reach {
  double inside;
  double outside;
};

inline Reach reachOf(const DoubleComponent& c, double max_range) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  if (!c.moderate || max_range == kInf) {
    return {c.moderate ? kInf : -kInf, kInf};
  }
  const double* d = c.direction;
  const double t = max_range / std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  return {t / exact::bounds::kInflate - exact::bounds::kUnderflow,
          t * exact::bounds::kInflate + exact::bounds::kUnderflow};
}

template <typename T>
void Scene::Impl::offerOthers(FirstEntered<T>& first, bool taken, double max_range,
                              const BoxMask* mask) const {
  if (!taken || !tree.left_out().empty()) {
    const double t_end = reachOf(first.component(), max_range).outside;
    forEachOther(tree, taken, boxes.size(), mask, [&](std::size_t i) {
      first.offer(i, t_end);
      return true;
    });
  }
}

template <typename T>
void Scene::Impl::findFirst(FirstEntered<T>& first, double max_range, const BoxMask* mask) const {
  kernels::Found found(&work_of_thread, FirstEntered<T>::take, &first);
  const auto ask = [&](const T& component) {
    return kernels.closest(view, rayQuery(component, max_range, mask), found) !=
           kernels::Answer::kNotTaken;
  };
  bool taken = ask(first.linear());
  if constexpr (std::is_same_v<T, Ray>) {
    if (const auto scaled = taken ? std::nullopt : withDirectionNearOne(first.linear())) {
      // The parameters of the candidates are those of another direction, their boxes are the same.
      found.take = [](void* context, const kernels::Found& some) {
        forEachCandidate(some, [&](const kernels::Candidate& c) {
          static_cast<FirstEntered<T>*>(context)->offer(c.box, kNoEnd);
          return true;
        });
        return kNoEnd;
      };
      taken = ask(*scaled);
      found.take(&first, found);
      offerOthers(first, taken, max_range, mask);
      return;
    }
  }
  first.offer(found);
  offerOthers(first, taken, max_range, mask);
}

/// Whether a box is met, entered at a range of at most `max_range` metres: exactly.
inline bool isMet(const Ray& ray, const Box& any, double max_range) {
  Solution solution = solveBox(ray, doubleComponent(ray), any);
  return solution.num_points > 0 &&
         std::visit(
             [&](const auto& box) {
               return isEnteredWithin(ray, box, solution, max_range, directionLength(ray));
             },
             any);
}
inline bool isMet(const Segment& segment, const Box& any, double /*max_range*/) {
  return meet(segment, any);
}

/// Candidates of a search for any box.
template <typename T>
struct Undecided {
  const SceneBoxes& boxes;
  const T& linear;
  double max_range;
  bool met = false;

  bool decide(std::size_t box) const { return isMet(linear, boxes.simplest(box), max_range); }

  /// For kernels::Found.
  static double take(void* context, const kernels::Found& found) {
    auto& self = *static_cast<Undecided*>(context);
    self.met = self.met || !forEachCandidate(found, [&](const kernels::Candidate& c) {
                 return !self.decide(c.box);
               });
    return self.met ? -1.0 : 1.0;
  }
};

template <typename T>
[[gnu::always_inline]] inline bool Scene::Impl::meetsAny(const T& linear, double max_range,
                                                         const BoxMask* mask) const {
  kernels::Found found(&work_of_thread);
  const kernels::Answer answer = kernels.any(view, rayQuery(linear, max_range, mask), found);
  // As a rule the kernel has decided everything.
  return answer == kernels::Answer::kYes ||
         (!(answer == kernels::Answer::kNone && tree.left_out().empty()) &&
          decideAny(linear, max_range, mask, answer, found));
}

template <typename T>
[[gnu::noinline]] bool Scene::Impl::decideAny(const T& linear, double max_range,
                                              const BoxMask* mask, kernels::Answer answer,
                                              const kernels::Found& found_first) const {
  Undecided<T> undecided{boxes, linear, max_range};
  if (answer != kernels::Answer::kNotTaken) {
    undecided.take(&undecided, found_first);
  } else {
    kernels::Found found(&work_of_thread, undecided.take, &undecided);
    answer = kernels.any(view, rayQuery(linear, max_range, mask), found);
    if constexpr (std::is_same_v<T, Ray>) {
      if (answer == kernels::Answer::kNotTaken) {
        if (const auto scaled = withDirectionNearOne(linear)) {
          answer = kernels.any(view, rayQuery(*scaled, max_range, mask), found);
        }
      }
    }
    undecided.take(&undecided, found);
  }
  if (answer == kernels::Answer::kYes || undecided.met) {
    return true;
  }
  const bool taken = answer != kernels::Answer::kNotTaken;
  if (taken && tree.left_out().empty()) {
    return false;
  }
  // Those that doubles decide come first: nothing else may be needed.
  const DoubleComponent component = doubleComponent(linear);
  const Reach reach = reachOf(component, max_range);
  for (const bool slowly : {false, true}) {
    forEachOther(tree, taken, boxes.size(), mask, [&](std::size_t i) {
      const kernels::Candidate c = candidateOf<T>(component, boxes.prepared(i), i);
      if (c.enter_lo <= c.exit_hi && c.enter_lo <= reach.outside) {
        undecided.met = slowly ? undecided.decide(i) : c.certain && c.enter_hi <= reach.inside;
      }
      return !undecided.met;
    });
  }
  return undecided.met;
}

/// Whether the kernels may take a segment.
inline bool isForKernels(const Segment& segment, const kernels::SceneView& view) {
  double size = 0.0;  // as one sum: a branch for each number takes longer
  for (int i = 0; i < 3; ++i) {
    size +=
        std::fabs(segment.start[i] - view.center[i]) + std::fabs(segment.end[i] - view.center[i]);
  }
  return size <= kernels::kFarthestOrigin;
}

/// Asks for the nearest box.
inline kernels::SegmentQuery nearestQuery(const Segment& segment, const BoxMask* mask) {
  return {{segment.start[0], segment.start[1], segment.start[2]},
          {segment.end[0], segment.end[1], segment.end[2]},
          std::numeric_limits<double>::infinity(),
          true,
          mask != nullptr ? mask->words() : nullptr};
}

inline NearestEstimate estimateOf(const kernels::NearBox& near) {
  const auto three = [](const double* lanes) {
    return std::array<double, 3>{lanes[0], lanes[1], lanes[2]};
  };
  return {{three(near.below), three(near.above), three(near.direction), near.scale},
          {near.t, three(near.excess)},
          {near.lower, near.upper}};
}
inline NearestEstimate estimateOf(const Segment& segment, const PreparedBox& box) {
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

constexpr std::uint32_t kNoRecord = ~std::uint32_t{0};

/// The nearest of the boxes that a kernel offers.
struct NearestOffered {
  std::optional<NearestBox> nearest;
  std::uint32_t record = kNoRecord;  ///< of that box

  NearestOffered() {}  // NOLINT(modernize-use-equals-default): as Nearby
  double offer(const Segment& segment, const SceneBoxes& boxes, std::uint32_t box,
               const kernels::NearBox& near) {
    if (!nearest) {
      nearest.emplace(segment, boxes);
    }
    const double bound = nearest->offer(std::size_t{box}, DistanceBounds{near.lower, near.upper},
                                        [&] { return estimateOf(near); });
    record = nearest->index() == box ? near.record : record;
    return bound;
  }
  /// Whether its distance is for kernels to round.
  bool isApart(const kernels::SceneView& view) const {
    return nearest && nearest->isApart() && record != kNoRecord &&
           view.box_of_record[record] == nearest->index();
  }
};

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
    const auto approach = [](void* to, std::uint32_t box, const kernels::NearBox& near) {
      auto& c = *static_cast<Context*>(to);
      const double next = c.visit(std::size_t{box}, DistanceBounds{near.lower, near.upper},
                                  [&] { return estimateOf(near); });
      c.ended = next < 0.0;
      return next;
    };
    kernels.nearest(view, query, approach, &context, work_of_thread);
  }
  if (!ended) {
    forEachOther(tree, for_kernels, boxes.size(), mask, [&](std::size_t i) {
      const NearestEstimate estimate = estimateOf(segment, boxes.prepared(i));
      return visit(i, estimate.bounds, [&] { return estimate; }) >= 0.0;
    });
  }
}

}  // namespace box_query
