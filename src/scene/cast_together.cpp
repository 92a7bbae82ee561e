// SPDX-License-Identifier: BSD-3-Clause
#include "scene/candidates.h"
#include "scene/counters.h"
#include "scene/scene_impl.h"

#include <box_query/scene.h>

#include <algorithm>

namespace box_query {
namespace {

/// Queries that the kernels get at once: many more than they work on at a time.
constexpr std::size_t kQueries = 256;

/// Calls take(i, answer, found) for each ray once, in any order.
template <typename Take>
void castTogether(kernels::Together together, const kernels::SceneView& view, const Ray* rays,
                  std::size_t count, const MaxRanges& max_ranges, const BoxMask* mask,
                  Take&& take) {
  struct Context {
    Take& take;
    std::size_t first;
  };
  const auto deliver = [](void* context, std::size_t query, kernels::Answer answer,
                          const kernels::Found* found) {
    const auto& c = *static_cast<Context*>(context);
    if (found != nullptr) {
      countWork(found->work);
    }
    c.take(c.first + query, answer, found);
  };
  for (std::size_t first = 0; first < count; first += kQueries) {
    kernels::RayQuery queries[kQueries];
    const std::size_t size = std::min(kQueries, count - first);
    for (std::size_t i = 0; i < size; ++i) {
      Vector3 direction;
      queries[i] = rayQuery(rays[first + i], max_ranges[first + i], mask, direction);
    }
    Context context{take, first};
    together(view, queries, size, deliver, &context);
  }
}

}  // namespace

void Scene::cast(const Ray* rays, std::size_t count, Hit* hits, MaxRanges max_ranges,
                 const BoxMask* mask) const noexcept {
  castTogether(impl_->kernels.closest_together, impl_->view, rays, count, max_ranges, mask,
               [&](std::size_t i, kernels::Answer /*answer*/, const kernels::Found* found) {
                 hits[i] = impl_->hitOf(rays[i], max_ranges[i], mask, found);
               });
}

void Scene::castClosest(const Ray* rays, std::size_t count, ClosestBox* closest,
                        MaxRanges max_ranges, const BoxMask* mask) const noexcept {
  castTogether(impl_->kernels.closest_together, impl_->view, rays, count, max_ranges, mask,
               [&](std::size_t i, kernels::Answer /*answer*/, const kernels::Found* found) {
                 closest[i] = impl_->closestOf(rays[i], max_ranges[i], mask, found);
               });
}

void Scene::castAny(const Ray* rays, std::size_t count, std::uint8_t* any, MaxRanges max_ranges,
                    const BoxMask* mask) const noexcept {
  castTogether(impl_->kernels.any_together, impl_->view, rays, count, max_ranges, mask,
               [&](std::size_t i, kernels::Answer answer, const kernels::Found* found) {
                 const bool is_none = answer == kernels::Answer::kUndecided && found != nullptr &&
                                      found->count == 0 && impl_->tree.left_out().empty();
                 const bool is_met = answer == kernels::Answer::kYes;
                 any[i] = is_met || (!is_none && castAny(rays[i], max_ranges[i], mask)) ? 1 : 0;
               });
}

}  // namespace box_query
