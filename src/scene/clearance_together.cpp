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

/// Has a box fetched that will be read.
void prefetch(const Box& box) {
  const char* bytes = reinterpret_cast<const char*>(&box);
  __builtin_prefetch(bytes);
  __builtin_prefetch(bytes + sizeof(Box) - 1);
}

/// Clearances that are known but for their numbers, eight at a time.
template <typename Impl>
class Rounding {
 public:
  Rounding(const Impl& scene, const Segment* segments, Clearance* clearances)
      : scene_(scene), segments_(segments), clearances_(clearances) {}

  /// @param number of the segment, and of its clearance
  /// @param box which is nearest, certainly not met, near the parameter t
  void add(std::size_t number, std::size_t box, double t) {
    const auto* oriented = std::get_if<OrientedBox>(&scene_.boxes.simplest(box));
    if (oriented == nullptr) {
      clearances_[number] = scene_.clearanceTo(segments_[number], box);
      return;
    }
    const auto k = static_cast<std::size_t>(count_);
    for (int i = 0; i < 3; ++i) {
      queries_.center[i][k] = oriented->center[i];
      queries_.half_extents[i][k] = oriented->half_extents[i];
      queries_.start[i][k] = segments_[number].start[i];
      queries_.end[i][k] = segments_[number].end[i];
    }
    for (int i = 0; i < 4; ++i) {
      queries_.quaternion[i][k] = oriented->orientation.coeffs()[i];
    }
    queries_.t[k] = t;
    numbers_[k] = number;
    boxes_[k] = box;
    if (++count_ == kernels::kRefineLanes) {
      finish();
    }
  }

  void finish() {
    if (count_ == 0) {
      return;
    }
    kernels::RefinedEach refined;
    const std::uint32_t certain = scene_.kernels.refine_together(queries_, refined);
    for (std::size_t k = 0; k < static_cast<std::size_t>(count_); ++k) {
      Clearance& clearance = clearances_[numbers_[k]];
      if (((certain >> k) & 1U) == 0) {
        clearance = scene_.clearanceTo(segments_[numbers_[k]], boxes_[k]);
        continue;
      }
      const auto point = [k](const double(*lanes)[kernels::kRefineLanes]) {
        return Vector3(lanes[0][k], lanes[1][k], lanes[2][k]);
      };
      clearance = {boxes_[k], refined.distance[k], refined.t[k], point(refined.on_segment),
                   point(refined.on_box)};
    }
    count_ = 0;
  }

 private:
  const Impl& scene_;
  const Segment* segments_;
  Clearance* clearances_;
  kernels::RefineQueries queries_{};
  std::size_t numbers_[kernels::kRefineLanes];
  std::size_t boxes_[kernels::kRefineLanes];
  int count_ = 0;
};

/// What is found of segments that the kernels have got at once.
struct Nearest {
  const Segment* segments;
  const SceneBoxes& boxes;
  std::size_t numbers[kSegments];
  std::optional<NearestBox> offered[kSegments];

  static double offer(void* context, std::size_t query, std::uint32_t box,
                      const kernels::NearBox& near) {
    return static_cast<Nearest*>(context)->of(query).offer(
        std::size_t{box}, DistanceBounds{near.lower, near.upper}, [&] { return estimateOf(near); });
  }
  NearestBox& of(std::size_t query) {
    if (!offered[query]) {
      offered[query].emplace(segments[numbers[query]], boxes);
    }
    return *offered[query];
  }
};

}  // namespace

Clearance Scene::Impl::clearanceTo(const Segment& segment, std::size_t box) const {
  const NearestEstimate estimate = estimateOf(segment, boxes.prepared(box));
  NearestBox nearest(segment, boxes);
  nearest.offer(box, estimate.bounds, [&] { return estimate; });
  return nearest.clearance();
}

void Scene::clearance(const Segment* segments, std::size_t count, Clearance* clearances,
                      const BoxMask* mask) const noexcept {
  if (impl_->kernels.nearest_together == nullptr) {
    for (std::size_t i = 0; i < count; ++i) {
      clearances[i] = clearance(segments[i], mask);
    }
    return;
  }
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  const bool are_others = !impl_->tree.left_out().empty();
  Rounding<Impl> rounding(*impl_, segments, clearances);
  for (std::size_t first = 0; first < count; first += kSegments) {
    const std::size_t end = std::min(first + kSegments, count);
    kernels::SegmentQuery queries[kSegments];
    kernels::NearestOne ones[kSegments];
    Nearest nearest{segments, impl_->boxes, {}, {}};
    std::size_t taken = 0;
    for (std::size_t i = first; i < end; ++i) {
      if (isForKernels(segments[i], impl_->view)) {
        ones[taken].box = kNone;
        nearest.numbers[taken] = i;
        queries[taken++] = nearestQuery(segments[i], mask);
      } else {
        clearances[i] = clearance(segments[i], mask);
      }
    }
    impl_->kernels.nearest_together(impl_->view, queries, taken, Nearest::offer, &nearest,
                                    are_others ? nullptr : ones, work_of_thread);
    for (std::size_t k = 0; k < taken; ++k) {
      if (ones[k].box != kNone) {
        prefetch(impl_->boxes.simplest(ones[k].box));
      }
    }
    for (std::size_t k = 0; k < taken; ++k) {
      const std::size_t i = nearest.numbers[k];
      if (ones[k].box != kNone) {
        rounding.add(i, ones[k].box, ones[k].t);
        continue;
      }
      NearestBox& offered = nearest.of(k);
      forEachOther(impl_->tree, true, impl_->boxes.size(), mask, [&](std::size_t box) {
        const NearestEstimate estimate = estimateOf(segments[i], impl_->boxes.prepared(box));
        return offered.offer(box, estimate.bounds, [&] { return estimate; }) >= 0.0;
      });
      if (offered.isApart()) {
        rounding.add(i, offered.index(), offered.guess());
      } else {
        clearances[i] = offered.clearance();
      }
    }
  }
  rounding.finish();
}

}  // namespace box_query
