// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The slab test after Kay and Kajiya (SIGGRAPH 1986) as programs have it: branchless, with
/// reciprocals, in float, in double, and padded after T. Ize, "Robust BVH Ray Traversal" (JCGT 2,
/// 2013).
#pragma once

#include "benchmark/library_box.h"

#include <algorithm>

namespace box_query::benchmark {

/// The axes of a box as rows, its center and half extents: what any slab test needs.
template <typename Real>
struct SlabBox {
  Real axes[3][3];
  Real center[3];
  Real half_extents[3];
};

template <typename Real>
SlabBox<Real> slabBox(const OrientedBox& box) {
  const Eigen::Matrix3d rotation = box.orientation.normalized().toRotationMatrix();
  SlabBox<Real> result;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      result.axes[i][k] = static_cast<Real>(rotation(k, i));
    }
    result.center[i] = static_cast<Real>(box.center[i]);
    result.half_extents[i] = static_cast<Real>(box.half_extents[i]);
  }
  return result;
}

/// A component and its own interval.
template <typename Real>
struct SlabComponent {
  Real origin[3];
  Real direction[3];
  Real t_min;
  Real t_max;
};

template <typename Real>
SlabComponent<Real> slabComponent(const Vector3& origin, const Vector3& direction, double t_min,
                                  double t_max) {
  SlabComponent<Real> result;
  for (int i = 0; i < 3; ++i) {
    result.origin[i] = static_cast<Real>(origin[i]);
    result.direction[i] = static_cast<Real>(direction[i]);
  }
  result.t_min = static_cast<Real>(t_min);
  result.t_max = static_cast<Real>(t_max);
  return result;
}
template <typename Real>
SlabComponent<Real> slabComponent(const Line& line) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return slabComponent<Real>(line.origin, line.direction, -kInfinity, kInfinity);
}
template <typename Real>
SlabComponent<Real> slabComponent(const Ray& ray) {
  return slabComponent<Real>(ray.origin, ray.direction, 0.0,
                             std::numeric_limits<double>::infinity());
}
template <typename Real>
SlabComponent<Real> slabComponent(const Segment& segment) {
  return slabComponent<Real>(segment.start, segment.end - segment.start, 0.0, 1.0);
}

/// The center and the axes are read from where they are prepared: by slabBox() or by the library.
/// `Pad::kFar` multiplies every t at which a slab is left.
template <typename Real, typename Pad, typename BoxType>
Answer clipBySlabs(const SlabComponent<Real>& component, const BoxType& box) {
  const Real p[3] = {component.origin[0] - box.center[0], component.origin[1] - box.center[1],
                     component.origin[2] - box.center[2]};
  Real t0 = component.t_min;
  Real t1 = component.t_max;
  for (int i = 0; i < 3; ++i) {
    const Real* axis = box.axes[i];
    const Real y = axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
    const Real d = axis[0] * component.direction[0] + axis[1] * component.direction[1] +
                   axis[2] * component.direction[2];
    const Real r = Real(1) / d;
    const Real a = (-box.half_extents[i] - y) * r;
    const Real b = (box.half_extents[i] - y) * r;
    t0 = std::max(t0, std::min(a, b));
    t1 = std::min(t1, std::max(a, b) * static_cast<Real>(Pad::kFar));
  }
  return {t0 <= t1, static_cast<double>(t0)};
}

struct NoPad {
  static constexpr double kFar = 1.0;
};
/// Two ulp on where a slab is left, as Ize's listing has it.
struct IzePad {
  static constexpr double kFar = 1.0 + 0x1p-51;
};

/// Timed for its yes or no alone, which favours it: its t comes with it.
template <typename Real, typename Pad>
struct Slab {
  static constexpr bool kGivesT = true;
  static constexpr bool kLooksAtT = false;
  using Prepared = SlabBox<Real>;
  static Prepared prepare(const OrientedBox& box) { return slabBox<Real>(box); }
  template <typename Component>
  static Answer ask(const Component& component, const Prepared& box) {
    return clipBySlabs<Real, Pad>(slabComponent<Real>(component), box);
  }
};

struct FloatSlab : Slab<float, NoPad> {
  static constexpr const char* kName = "float slab";
};
/// What the library is measured by: on its own prepared boxes, so that both read the same memory.
struct DoubleSlab {
  static constexpr const char* kName = "double slab";
  static constexpr bool kGivesT = true;
  static constexpr bool kLooksAtT = false;
  using Prepared = LibraryBox;
  static Prepared prepare(const OrientedBox& box) { return LibraryBox(box); }
  template <typename Component>
  static Answer ask(const Component& component, const Prepared& box) {
    return clipBySlabs<double, NoPad>(slabComponent<double>(component), box.filter.slabs);
  }
};
/// A lone one is prepared as the library does it.
template <>
struct Lone<DoubleSlab> {
  static constexpr const char* kName = DoubleSlab::kName;
  static constexpr bool kGivesT = true;
  static constexpr bool kLooksAtT = false;
  using Prepared = OrientedBox;
  static const OrientedBox& prepare(const OrientedBox& box) { return box; }
  template <typename Component>
  static Answer ask(const Component& component, const OrientedBox& box) {
    return clipBySlabs<double, NoPad>(slabComponent<double>(component), doubleSlabs(box));
  }
};
struct PaddedSlab : Slab<double, IzePad> {
  static constexpr const char* kName = "padded slab";
};

}  // namespace box_query::benchmark
