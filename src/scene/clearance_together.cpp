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

/// Has a record fetched that will be read.
void prefetch(const kernels::SceneView& view, std::uint32_t record) {
  const char* bytes = reinterpret_cast<const char*>(&view.records[record]);
  __builtin_prefetch(bytes);
  __builtin_prefetch(bytes + 64);
  __builtin_prefetch(&view.rests[record]);
}

/// Clearances that are known but for their numbers, eight at a time.
template <typename Impl>
class Rounding {
 public:
  Rounding(const Impl& scene, const Segment* segments, Clearance* clearances)
      : scene_(scene), segments_(segments), clearances_(clearances) {}

  /// @param number of the segment, and of its clearance
  void add(std::size_t number, const kernels::NearestOne& one) {
    const auto k = static_cast<std::size_t>(count_);
    for (int i = 0; i < 3; ++i) {
      queries_.start[i][k] = segments_[number].start[i];
      queries_.end[i][k] = segments_[number].end[i];
    }
    queries_.t[k] = one.t;
    queries_.record[k] = one.record;
    numbers_[k] = number;
    if (++count_ == kernels::kRoundLanes) {
      finish();
    }
  }

  void finish() {
    if (count_ == 0) {
      return;
    }
    kernels::RoundedEach rounded;
    const std::uint32_t certain = scene_.kernels.round_together(scene_.view, queries_, rounded);
    for (std::size_t k = 0; k < static_cast<std::size_t>(count_); ++k) {
      Clearance& clearance = clearances_[numbers_[k]];
      const std::size_t box = scene_.view.box_of_record[queries_.record[k]];
      if (((certain >> k) & 1U) == 0) {
        const kernels::NearestOne one = {queries_.record[k], queries_.t[k]};
        clearance = scene_.clearanceTo(segments_[numbers_[k]],
                                       nearestQuery(segments_[numbers_[k]], nullptr), one);
        continue;
      }
      const auto point = [k](const double(*lanes)[kernels::kRoundLanes]) {
        return Vector3(lanes[0][k], lanes[1][k], lanes[2][k]);
      };
      clearance = {box, rounded.distance[k], rounded.t[k], point(rounded.on_segment),
                   point(rounded.on_box)};
    }
    count_ = 0;
  }

 private:
  const Impl& scene_;
  const Segment* segments_;
  Clearance* clearances_;
  kernels::RoundQueries queries_{};
  std::size_t numbers_[kernels::kRoundLanes];
  int count_ = 0;
};

/// What is found of segments that the kernels have got at once.
struct Nearest {
  const Segment* segments;
  const SceneBoxes& boxes;
  std::size_t numbers[kSegments];
  NearestOffered offered[kSegments];

  Nearest(const Segment* all, const SceneBoxes& scene) : segments(all), boxes(scene) {}
  static double offer(void* context, std::size_t query, std::uint32_t box,
                      const kernels::NearBox& near) {
    Nearest& self = *static_cast<Nearest*>(context);
    return self.offered[query].offer(self.segments[self.numbers[query]], self.boxes, box, near);
  }
};

}  // namespace

Clearance Scene::Impl::clearanceTo(const Segment& segment, std::size_t box) const {
  const NearestEstimate estimate = estimateOf(segment, boxes.prepared(box));
  NearestBox nearest(segment, boxes);
  nearest.offer(box, estimate.bounds, [&] { return estimate; });
  return nearest.clearance();
}

void Scene::Impl::offerOthers(const Segment& segment, const BoxMask* mask,
                              NearestOffered& offered) const {
  if (!offered.nearest) {
    offered.nearest.emplace(segment, boxes);
  }
  forEachOther(tree, true, boxes.size(), mask, [&](std::size_t box) {
    const NearestEstimate estimate = estimateOf(segment, boxes.prepared(box));
    return offered.nearest->offer(box, estimate.bounds, [&] { return estimate; }) >= 0.0;
  });
}

void Scene::clearance(const Segment* segments, std::size_t count, Clearance* clearances,
                      const BoxMask* mask) const noexcept {
  if (impl_->kernels.nearest_together == nullptr) {
    for (std::size_t i = 0; i < count; ++i) {
      clearances[i] = clearance(segments[i], mask);
    }
    return;
  }
  const kernels::SceneView& view = impl_->view;
  const bool are_others = !impl_->tree.left_out().empty();
  Rounding<Impl> rounding(*impl_, segments, clearances);
  for (std::size_t first = 0; first < count; first += kSegments) {
    const std::size_t end = std::min(first + kSegments, count);
    kernels::SegmentQuery queries[kSegments];
    kernels::NearestOne ones[kSegments];
    Nearest nearest(segments, impl_->boxes);
    std::size_t taken = 0;
    for (std::size_t i = first; i < end; ++i) {
      if (isForKernels(segments[i], view)) {
        ones[taken].record = kNoRecord;
        nearest.numbers[taken] = i;
        queries[taken++] = nearestQuery(segments[i], mask);
      } else {
        clearances[i] = clearance(segments[i], mask);
      }
    }
    impl_->kernels.nearest_together(view, queries, taken, Nearest::offer, &nearest,
                                    are_others ? nullptr : ones, work_of_thread);
    for (std::size_t k = 0; k < taken; ++k) {
      if (ones[k].record != kNoRecord) {
        prefetch(view, ones[k].record);
      }
    }
    for (std::size_t k = 0; k < taken; ++k) {
      const std::size_t i = nearest.numbers[k];
      if (ones[k].record != kNoRecord) {
        if (ones[k].isApart()) {
          rounding.add(i, ones[k]);
        } else {
          clearances[i] = impl_->clearanceOfMet(segments[i], ones[k]);
        }
        continue;
      }
      NearestOffered& offered = nearest.offered[k];
      if (are_others || !offered.nearest) {
        impl_->offerOthers(segments[i], mask, offered);
      }
      if (offered.isApart(view)) {
        rounding.add(i, {offered.record, offered.nearest->guess()});
      } else {
        clearances[i] = offered.nearest->clearance();
      }
    }
  }
  rounding.finish();
}

}  // namespace box_query
