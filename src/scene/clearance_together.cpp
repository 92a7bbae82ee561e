// SPDX-License-Identifier: BSD-3-Clause
#include "scene/counters.h"
#include "scene/nearest_box.h"
#include "scene/scene_impl.h"
#include "scene/search.h"

#include <box_query/scene.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <variant>

namespace box_query {
namespace {

/// Segments that the kernels get at once: so few that what is found of them stays in cache.
constexpr std::size_t kSegments = 16;

kernels::SegmentQuery segmentQuery(const Segment& segment, const BoxMask* mask) {
  return {{segment.start[0], segment.start[1], segment.start[2]},
          {segment.end[0], segment.end[1], segment.end[2]},
          std::numeric_limits<double>::infinity(),
          true,
          mask != nullptr ? mask->words() : nullptr};
}

/// Has a box fetched that will be read.
void prefetch(const Box* box) {
  if (box != nullptr) {
    const char* bytes = reinterpret_cast<const char*>(box);
    __builtin_prefetch(bytes);
    __builtin_prefetch(bytes + sizeof(Box) - 1);
  }
}

/// Clearances that are known but for their numbers, eight at a time.
class Rounding {
 public:
  explicit Rounding(Clearance* clearances) : clearances_(clearances) {}

  /// @param number of the segment, and of its clearance
  void add(std::size_t number, const Segment& segment, const NearestBox& nearest) {
    const auto* box = nearest.isApart() ? std::get_if<OrientedBox>(nearest.box()) : nullptr;
    if (box == nullptr || refine_ == nullptr) {
      clearances_[number] = nearest.clearance();
      return;
    }
    const auto k = static_cast<std::size_t>(count_);
    for (int i = 0; i < 3; ++i) {
      queries_.center[i][k] = box->center[i];
      queries_.half_extents[i][k] = box->half_extents[i];
      queries_.start[i][k] = segment.start[i];
      queries_.end[i][k] = segment.end[i];
    }
    for (int i = 0; i < 4; ++i) {
      queries_.quaternion[i][k] = box->orientation.coeffs()[i];
    }
    queries_.t[k] = nearest.guess();
    numbers_[k] = number;
    nearest_[k] = &nearest;
    if (++count_ == kernels::kRefineLanes) {
      finish();
    }
  }

  void finish() {
    if (count_ == 0) {
      return;
    }
    kernels::RefinedEach refined;
    const std::uint32_t certain = refine_(queries_, refined);
    for (std::size_t k = 0; k < static_cast<std::size_t>(count_); ++k) {
      Clearance& clearance = clearances_[numbers_[k]];
      if (((certain >> k) & 1U) == 0) {
        clearance = nearest_[k]->clearance();
        continue;
      }
      const auto point = [k](const double(*lanes)[kernels::kRefineLanes]) {
        return Vector3(lanes[0][k], lanes[1][k], lanes[2][k]);
      };
      clearance = {nearest_[k]->index(), refined.distance[k], refined.t[k],
                   point(refined.on_segment), point(refined.on_box)};
    }
    count_ = 0;
  }

 private:
  Clearance* clearances_;
  decltype(kernels::Kernels::refine_together) refine_ = kernels::active().refine_together;
  kernels::RefineQueries queries_{};
  std::size_t numbers_[kernels::kRefineLanes];
  const NearestBox* nearest_[kernels::kRefineLanes];
  int count_ = 0;
};

}  // namespace

void Scene::clearance(const Segment* segments, std::size_t count, Clearance* clearances,
                      const BoxMask* mask) const noexcept {
  Rounding rounding(clearances);
  for (std::size_t first = 0; first < count; first += kSegments) {
    const std::size_t end = std::min(first + kSegments, count);
    kernels::SegmentQuery queries[kSegments];
    std::size_t numbers[kSegments];
    std::optional<NearestBox> nearest[kSegments];
    std::size_t taken = 0;
    for (std::size_t i = first; i < end; ++i) {
      if (isForKernels(segments[i], impl_->view)) {
        nearest[taken].emplace(segments[i], impl_->boxes);
        numbers[taken] = i;
        queries[taken++] = segmentQuery(segments[i], mask);
      } else {
        clearances[i] = clearance(segments[i], mask);
      }
    }
    const auto approach = [](void* context, std::size_t query, std::uint32_t box,
                             const kernels::NearBox& near) {
      auto* all = static_cast<std::optional<NearestBox>*>(context);
      return all[query]->offer(std::size_t{box}, DistanceBounds{near.lower, near.upper},
                               [&] { return estimateOf(near); });
    };
    impl_->kernels.nearest_together(impl_->view, queries, taken, approach, nearest, work_of_thread);
    for (std::size_t k = 0; k < taken; ++k) {
      prefetch(nearest[k]->box());
    }
    for (std::size_t k = 0; k < taken; ++k) {
      forEachOther(impl_->tree, true, impl_->boxes.size(), mask, [&](std::size_t i) {
        const NearestEstimate estimate = estimateOf(segments[numbers[k]], impl_->boxes.prepared(i));
        return nearest[k]->offer(i, estimate.bounds, [&] { return estimate; }) >= 0.0;
      });
      rounding.add(numbers[k], segments[numbers[k]], *nearest[k]);
    }
    rounding.finish();
  }
}

}  // namespace box_query
