// SPDX-License-Identifier: BSD-3-Clause
#include "scene/candidates.h"
#include "scene/counters.h"
#include "scene/scene_impl.h"

#include <box_query/scene.h>

#include <algorithm>
#include <limits>

namespace box_query {
namespace {

/// Queries that the kernels get at once: many more than they work on at a time.
constexpr std::size_t kQueries = 256;

/// The six numbers of rays, or segments, in a row, as kernels read them.
inline const double* numbersOf(const Ray* rays) {
  static_assert(sizeof(Ray) == 6 * sizeof(double));
  return rays->origin.data();
}
inline const double* numbersOf(const Segment* segments) {
  static_assert(sizeof(Segment) == 6 * sizeof(double));
  return segments->start.data();
}

/// Sets all answers to that of rays, or segments, that meet nothing, and calls take(i, answer,
/// found) for each that may meet something.
template <typename Impl, typename Linear, typename Answer, typename Take>
void askTogether(const Impl& scene, kernels::Together together, const Linear* linear,
                 std::size_t count, Answer* answers, const Answer& miss,
                 const MaxRanges& max_ranges, const BoxMask* mask, Take&& take,
                 double radius = 0.0) {
  struct Context {
    Take& take;
    std::size_t first;
    bool is_taken[kQueries];
  };
  const auto deliver = [](void* context, std::size_t query, kernels::Answer answer,
                          const kernels::Found* found) {
    auto& c = *static_cast<Context*>(context);
    c.is_taken[query] = true;
    c.take(c.first + query, answer, found);
  };
  for (std::size_t first = 0; first < count; first += kQueries) {
    const std::size_t size = std::min(kQueries, count - first);
    std::fill_n(answers + first, size, miss);
    const kernels::RayQueries queries{numbersOf(linear + first),
                                      size,
                                      max_ranges.from(first),
                                      max_ranges.distance(),
                                      mask != nullptr ? mask->words() : nullptr,
                                      radius};
    Context context{take, first, {}};
    together(scene.view, queries, deliver, &context, work_of_thread);
    if (!scene.tree.left_out().empty()) {
      kernels::Found nothing;
      for (std::size_t i = 0; i < size; ++i) {
        if (!context.is_taken[i]) {
          take(first + i, kernels::Answer::kUndecided, &nothing);
        }
      }
    }
  }
}

/// Whether what the kernels say of a query needs no other look.
struct Decided {
  bool is_met;
  bool is_none;

  Decided(kernels::Answer answer, const kernels::Found* found, const BoxTree& tree)
      : is_met(answer == kernels::Answer::kYes),
        is_none(answer == kernels::Answer::kUndecided && found != nullptr && found->count == 0 &&
                tree.left_out().empty()) {}
};

}  // namespace

void Scene::cast(const Ray* rays, std::size_t count, Hit* hits, MaxRanges max_ranges,
                 const BoxMask* mask) const noexcept {
  askTogether(*impl_, impl_->kernels.closest_together, rays, count, hits, Hit(), max_ranges, mask,
              [&](std::size_t i, kernels::Answer /*answer*/, const kernels::Found* found) {
                hits[i] = impl_->hitOf(rays[i], max_ranges[i], mask, found);
              });
}

void Scene::castClosest(const Ray* rays, std::size_t count, ClosestBox* closest,
                        MaxRanges max_ranges, const BoxMask* mask) const noexcept {
  askTogether(*impl_, impl_->kernels.closest_together, rays, count, closest, ClosestBox(),
              max_ranges, mask,
              [&](std::size_t i, kernels::Answer /*answer*/, const kernels::Found* found) {
                closest[i] = impl_->closestOf(rays[i], max_ranges[i], mask, found);
              });
}

void Scene::castAny(const Ray* rays, std::size_t count, std::uint8_t* any, MaxRanges max_ranges,
                    const BoxMask* mask) const noexcept {
  if (impl_->tree.isFull()) {  // what rays have in common would be looked at for nothing
    for (std::size_t i = 0; i < count; ++i) {
      any[i] = castAny(rays[i], max_ranges[i], mask) ? 1 : 0;
    }
    return;
  }
  askTogether(
      *impl_, impl_->kernels.any_together, rays, count, any, std::uint8_t{0}, max_ranges, mask,
      [&](std::size_t i, kernels::Answer answer, const kernels::Found* found) {
        const Decided decided(answer, found, impl_->tree);
        any[i] =
            decided.is_met || (!decided.is_none && castAny(rays[i], max_ranges[i], mask)) ? 1 : 0;
      });
}

void Scene::isClear(const Segment* segments, std::size_t count, std::uint8_t* clear, double radius,
                    const BoxMask* mask) const noexcept {
  if (impl_->tree.isFull() || (radius != 0.0 && !isForKernels(radius, impl_->view))) {
    for (std::size_t i = 0; i < count; ++i) {
      clear[i] = isClear(segments[i], radius, mask) ? 1 : 0;
    }
    return;
  }
  constexpr double kInf = std::numeric_limits<double>::infinity();
  if (radius == 0.0) {
    askTogether(
        *impl_, impl_->kernels.any_of_segments_together, segments, count, clear, std::uint8_t{1},
        kInf, mask, [&](std::size_t i, kernels::Answer answer, const kernels::Found* found) {
          const Decided decided(answer, found, impl_->tree);
          clear[i] =
              !decided.is_met && (decided.is_none || isClear(segments[i], 0.0, mask)) ? 1 : 0;
        });
    return;
  }
  askTogether(
      *impl_, impl_->kernels.any_within_together, segments, count, clear, std::uint8_t{1}, kInf,
      mask,
      [&](std::size_t i, kernels::Answer answer, const kernels::Found* /*found*/) {
        const bool is_clear =
            answer != kernels::Answer::kYes && impl_->areFartherThan(segments[i], radius, mask);
        clear[i] = is_clear ? 1 : 0;
      },
      radius);
}

}  // namespace box_query
