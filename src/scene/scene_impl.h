// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kernels/kernels.h"
#include "scene/box_tree.h"
#include "scene/scene_boxes.h"

#include <box_query/scene.h>

#include <vector>

namespace box_query {

template <typename T>
class FirstEntered;
struct NearestOffered;

struct Scene::Impl {
  explicit Impl(std::vector<Box> all);
  /// What comes after `before`.
  Impl(const Impl& before, std::vector<Box> all, const std::vector<std::size_t>& previous);

  /// firstBlockage() for radius 0.
  Blockage firstMet(const Segment& segment, const BoxMask* mask) const;

  template <typename Answer>
  auto castByKernels(const Ray& ray, double max_range, const BoxMask* mask, Answer&& answer) const
      -> decltype(answer(nullptr));

  /// cast() and castClosest() behind the kernel.
  /// @param found all candidates, or null if they are still to be found
  Hit hitOf(const Ray& ray, double max_range, const BoxMask* mask,
            const kernels::Found* found) const;
  ClosestBox closestOf(const Ray& ray, double max_range, const BoxMask* mask,
                       const kernels::Found* found) const;
  /// The latter where that does not say everything.
  ClosestBox decidedClosestOf(const Ray& ray, double max_range, const BoxMask* mask,
                              const kernels::Found* found) const;

  /// Offers all candidates.
  void offerAll(FirstEntered<Ray>& first, double max_range, const BoxMask* mask,
                const kernels::Found* found) const;

  /// Offers all boxes that may be the first, but for those that are certainly entered beyond
  /// `max_range` metres.
  template <typename T>
  void findFirst(FirstEntered<T>& first, double max_range, const BoxMask* mask) const;

  /// Those of them that the kernels did not look at.
  template <typename T>
  void offerOthers(FirstEntered<T>& first, bool taken, double max_range, const BoxMask* mask) const;

  /// Whether any box is met, entered at a range of at most `max_range` metres.
  template <typename T>
  bool meetsAny(const T& linear, double max_range, const BoxMask* mask) const;
  /// The same behind the kernel.
  template <typename T>
  bool decideAny(const T& linear, double max_range, const BoxMask* mask, kernels::Answer answer,
                 const kernels::Found& found) const;

  /// Whether any box is within a radius of a segment: kYes or kNone, or what no kernel can say.
  kernels::Answer anyWithin(const Segment& segment, double radius, const BoxMask* mask) const;
  /// Whether all boxes are farther from it.
  bool areFartherThan(const Segment& segment, double radius, const BoxMask* mask) const;

  /// Calls visit(index, bounds, estimate) for all boxes that may be within `bound` of the segment:
  /// with DistanceBounds, and estimate() for the NearestEstimate. It returns the bound from then
  /// on, which never grows, or a negative number to end.
  /// @param shrinks only the nearest box matters
  template <typename Visit>
  void forEachNear(const Segment& segment, double bound, bool shrinks, const BoxMask* mask,
                   Visit&& visit) const;

  /// Offers the boxes that kernels do not look at.
  void offerOthers(const Segment& segment, const BoxMask* mask, NearestOffered& offered) const;

  /// Of a segment to a box that is known to be the nearest.
  /// @param query the same segment
  Clearance clearanceTo(const Segment& segment, const kernels::SegmentQuery& query,
                        const kernels::NearestOne& one) const;
  Clearance clearanceTo(const Segment& segment, std::size_t box) const;
  /// Of a segment that certainly meets the box.
  Clearance clearanceOfMet(const Segment& segment, const kernels::NearestOne& one) const;

  template <typename T>
  std::vector<BoxIntersection> findAll(const T& linear, const BoxMask* mask) const;

  SceneBoxes boxes;
  BoxTree tree;
  SceneUpdate update;
  kernels::SceneView view;
  const kernels::Kernels& kernels = kernels::active();
};

/// Calls visit(index) for every box that the mask looks at, in order of the index, until it returns
/// false.
template <typename Visit>
void forEachBox(std::size_t size, const BoxMask* mask, Visit&& visit) {
  for (std::size_t i = 0; i < size; ++i) {
    if ((mask == nullptr || (*mask)[i]) && !visit(i)) {
      return;
    }
  }
}

/// Encloses entry and exit; everything is possible where the filter may not take the box or the
/// component.
template <typename T>
Enclosure enclose(const DoubleComponent& component, const PreparedBox& box) {
  switch (component.moderate ? box.kind : PreparedBox::Kind::kExactOnly) {
    case PreparedBox::Kind::kAligned:
      return enclose<T>(component, box.aligned);
    case PreparedBox::Kind::kOriented:
      return enclose<T>(component, box.oriented);
    case PreparedBox::Kind::kExactOnly:
      break;
  }
  constexpr double kInf = std::numeric_limits<double>::infinity();
  return {kHasStart<T> ? 0.0 : -kInf, kInf, -kInf, kHasEnd<T> ? 1.0 : kInf};
}

/// Whether an undecided component certainly meets the box.
template <typename T>
bool crossesThinSlab(const DoubleComponent& component, const PreparedBox& box) {
  switch (component.moderate ? box.kind : PreparedBox::Kind::kExactOnly) {
    case PreparedBox::Kind::kAligned:
      return crossesThinSlab<T>(slabTimes(component, box.aligned));
    case PreparedBox::Kind::kOriented:
      return crossesThinSlab<T>(slabTimes(component, box.oriented));
    case PreparedBox::Kind::kExactOnly:
      break;
  }
  return false;
}

}  // namespace box_query
