// SPDX-License-Identifier: BSD-3-Clause
#include "scene/counters.h"
#include "scene/nearest_box.h"
#include "scene/scene_impl.h"
#include "scene/search.h"

#include <box_query/scene.h>

#include <algorithm>
#include <cmath>
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

/// The numbers of a clearance, which kernels write: distance, t and the points.
double* numbersOf(Clearance& clearance) {
  static_assert(sizeof(Clearance) == sizeof(std::size_t) + 8 * sizeof(double));
  return &clearance.distance;
}

/// Clearances that are known but for their numbers, eight at a time.
template <typename Impl>
class Rounding {
 public:
  Rounding(const Impl& scene, const Segment* segments, Clearance* clearances)
      : scene_(scene), segments_(segments), clearances_(clearances) {}

  /// @param number of the segment, and of its clearance
  void add(std::size_t number, const kernels::NearestOne& one) {
    if (scene_.view.records[one.record].isAligned()) {  // kernels leave it to others
      clearances_[number] =
          scene_.clearanceTo(segments_[number], scene_.view.box_of_record[one.record]);
      return;
    }
    add({number, 0}, one.record, one.t);
    while (count_ == kernels::kRoundLanes) {
      round(true);
    }
  }

  void finish() {
    if (count_ > 0) {
      round(false);
    }
  }

 private:
  struct Lane {
    std::size_t number;
    int guesses;
  };

  void add(const Lane& lane, std::uint32_t record, double t) {
    const auto k = static_cast<std::size_t>(count_++);
    queries_.segment[k] = &segments_[lane.number].start[0];
    queries_.rounded[k] = numbersOf(clearances_[lane.number]);
    queries_.t[k] = t;
    queries_.record[k] = record;
    lanes_[k] = {lane.number, lane.guesses + 1};
    clearances_[lane.number].box = scene_.view.box_of_record[record];
  }

  /// @param again whether what is not certain may be guessed again with others
  void round(bool again) {
    const auto count = static_cast<std::size_t>(count_);
    count_ = 0;
    for (std::size_t k = count; k < kernels::kRoundLanes; ++k) {
      queries_.segment[k] = queries_.segment[0];
      queries_.rounded[k] = queries_.rounded[0];
      queries_.t[k] = queries_.t[0];
      queries_.record[k] = queries_.record[0];
    }
    std::uint32_t uncertain = ~scene_.kernels.round_together(scene_.view, queries_);
    for (uncertain &= (1U << count) - 1; uncertain != 0; uncertain &= uncertain - 1) {
      const auto k = static_cast<std::size_t>(__builtin_ctz(uncertain));
      const Lane lane = lanes_[k];
      Clearance& clearance = clearances_[lane.number];
      const double next = std::min(std::max(clearance.t, 0.0), 1.0);
      const Segment& segment = segments_[lane.number];
      if (lane.guesses == kernels::kGuesses || !(std::fabs(next - queries_.t[k]) > 0.0)) {
        clearance = scene_.clearanceTo(segment, clearance.box);
      } else if (again) {
        add(lane, queries_.record[k], next);
      } else {
        clearance =
            scene_.clearanceTo(segment, nearestQuery(segment, nullptr), {queries_.record[k], next});
      }
    }
  }

  const Impl& scene_;
  const Segment* segments_;
  Clearance* clearances_;
  kernels::RoundQueries queries_{};
  Lane lanes_[kernels::kRoundLanes];
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
