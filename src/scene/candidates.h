// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a kernel leaves to the stages behind it.
#pragma once

#include "exact/clip.h"
#include "geometry/slabs.h"
#include "kernels/kernels.h"
#include "scene/scene_impl.h"

#include <box_query/scene.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace box_query {

/// What a kernel is asked about a ray or a segment.
inline kernels::RayQuery rayQuery(const Ray& ray, double max_range, const BoxMask* mask) {
  return {ray.origin.data(),
          ray.direction.data(),
          false,
          max_range,
          mask != nullptr ? mask->words() : nullptr,
          0.0};
}
inline kernels::RayQuery rayQuery(const Segment& segment, double max_range, const BoxMask* mask,
                                  double radius = 0.0) {
  return {segment.start.data(),
          segment.end.data(),
          true,
          max_range,
          mask != nullptr ? mask->words() : nullptr,
          radius};
}

/// Whether kernels are asked what is within a radius.
inline bool isForKernels(double radius, const kernels::SceneView& view) {
  return radius > 0.0 && radius <= view.most_radius;
}

/// The same ray with a direction of about 1, times an exact power of two: it meets the same boxes
/// at the same ranges. Nothing if some component would not be exact, nor of a zero direction.
inline std::optional<Ray> withDirectionNearOne(const Ray& ray) {
  const double size = ray.direction.cwiseAbs().maxCoeff();
  if (size == 0.0) {
    return std::nullopt;
  }
  const int exponent = std::ilogb(size);
  Ray scaled = ray;
  for (int i = 0; i < 3; ++i) {
    scaled.direction[i] = std::scalbn(ray.direction[i], -exponent);
    if (std::scalbn(scaled.direction[i], exponent) != ray.direction[i]) {
      return std::nullopt;
    }
  }
  return scaled;
}

/// Calls visit(candidate) for each box in `found` once, in order of their numbers, until it returns
/// false.
template <typename Visit>
bool forEachCandidate(const kernels::Found& found, Visit&& visit) {
  if (found.count <= 1) {
    return found.count == 0 || visit(found.candidates[0]);
  }
  kernels::Candidate sorted[kernels::Found::kCapacity];
  const auto end = std::copy(found.candidates, found.candidates + found.count, sorted);
  std::sort(sorted, end, [](const auto& a, const auto& b) { return a.box < b.box; });
  for (const auto* c = sorted; c != end; ++c) {
    if ((c == sorted || c->box != c[-1].box) && !visit(*c)) {
      return false;
    }
  }
  return true;
}

/// A box that the kernels may not take, or no component, as a candidate.
template <typename T>
kernels::Candidate candidateOf(const DoubleComponent& component, const PreparedBox& box,
                               std::size_t index) {
  const Enclosure e = enclose<T>(component, box);
  return {static_cast<std::uint32_t>(index), e.isHit(), e.enter_lo, e.enter_hi, e.exit_hi};
}

/// Calls visit(index) for each box that the kernels did not look at, in order of the index, until
/// it returns false: those that they may not take, or all where they may not take the component.
template <typename Visit>
void forEachOther(const BoxTree& tree, bool for_kernels, std::size_t size, const BoxMask* mask,
                  Visit&& visit) {
  if (!for_kernels) {
    forEachBox(size, mask, visit);
    return;
  }
  for (const std::uint32_t i : tree.left_out()) {
    if ((mask == nullptr || (*mask)[i]) && !visit(i)) {
      return;
    }
  }
}

}  // namespace box_query
