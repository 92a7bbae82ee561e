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

static_assert(sizeof(Ray) == 6 * sizeof(double), "kernels read the six numbers of rays in a row");

/// Sets all answers to those of rays that meet nothing, and calls take(i, answer, found) for each
/// ray that may meet something.
template <typename Impl, typename Answer, typename Take>
void castTogether(const Impl& scene, kernels::Together together, const Ray* rays, std::size_t count,
                  Answer* answers, const MaxRanges& max_ranges, const BoxMask* mask, Take&& take) {
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
    std::fill_n(answers + first, size, Answer());
    const kernels::RayQueries queries{rays[first].origin.data(), size, max_ranges.from(first),
                                      max_ranges.distance(),
                                      mask != nullptr ? mask->words() : nullptr};
    Context context{take, first, {}};
    kernels::Work work;
    together(scene.view, queries, deliver, &context, work);
    countWork(work);
    if (!scene.tree.left_out().empty()) {
      kernels::Found nothing;
      nothing.count = 0;
      nothing.t_inside = -std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < size; ++i) {
        if (!context.is_taken[i]) {
          take(first + i, kernels::Answer::kUndecided, &nothing);
        }
      }
    }
  }
}

}  // namespace

void Scene::cast(const Ray* rays, std::size_t count, Hit* hits, MaxRanges max_ranges,
                 const BoxMask* mask) const noexcept {
  castTogether(*impl_, impl_->kernels.closest_together, rays, count, hits, max_ranges, mask,
               [&](std::size_t i, kernels::Answer /*answer*/, const kernels::Found* found) {
                 hits[i] = impl_->hitOf(rays[i], max_ranges[i], mask, found);
               });
}

void Scene::castClosest(const Ray* rays, std::size_t count, ClosestBox* closest,
                        MaxRanges max_ranges, const BoxMask* mask) const noexcept {
  castTogether(*impl_, impl_->kernels.closest_together, rays, count, closest, max_ranges, mask,
               [&](std::size_t i, kernels::Answer /*answer*/, const kernels::Found* found) {
                 closest[i] = impl_->closestOf(rays[i], max_ranges[i], mask, found);
               });
}

void Scene::castAny(const Ray* rays, std::size_t count, std::uint8_t* any, MaxRanges max_ranges,
                    const BoxMask* mask) const noexcept {
  castTogether(*impl_, impl_->kernels.any_together, rays, count, any, max_ranges, mask,
               [&](std::size_t i, kernels::Answer answer, const kernels::Found* found) {
                 const bool is_none = answer == kernels::Answer::kUndecided && found != nullptr &&
                                      found->count == 0 && impl_->tree.left_out().empty();
                 const bool is_met = answer == kernels::Answer::kYes;
                 any[i] = is_met || (!is_none && castAny(rays[i], max_ranges[i], mask)) ? 1 : 0;
               });
}

}  // namespace box_query
