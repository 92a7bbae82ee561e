// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The first stage: a component against three slabs in double, with enclosures of its parameters.
///
/// Where an enclosure decides it is right (bounds.h); where it does not, a slower stage does.
#pragma once

#include "exact/bounds.h"
#include "exact/clip.h"

#include <box_query/geometry.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace box_query {

using exact::kHasEnd;
using exact::kHasStart;

/// A component in double, once a query.
struct DoubleComponent {
  double origin[3];
  double direction[3];  ///< of a segment: its rounded end - start
  double inverse[3];    ///< +inf where the direction is zero
  bool negative[3];
  bool moderate;  ///< the filter may take it
  bool compact;   ///< double-double may take it: see bounds::kSmallest
};

inline bool isModerate(double x) {
  const double size = std::fabs(x);
  return (size >= exact::bounds::kTiniest && size <= exact::bounds::kLargest) || size == 0.0;
}
inline bool isCompact(double x) {
  const double size = std::fabs(x);
  return (size >= exact::bounds::kSmallest && size <= exact::bounds::kLargest) || size == 0.0;
}
inline bool isModerate(const Vector3& v) {
  return isModerate(v[0]) && isModerate(v[1]) && isModerate(v[2]);
}
inline bool isCompact(const Vector3& v) {
  return isCompact(v[0]) && isCompact(v[1]) && isCompact(v[2]);
}

template <typename T>
DoubleComponent doubleComponent(const T& linear) {
  DoubleComponent c;
  const Vector3* origin = nullptr;
  Vector3 direction;
  if constexpr (kHasEnd<T>) {
    origin = &linear.start;
    direction = linear.end - linear.start;
    c.moderate = isModerate(linear.start) && isModerate(linear.end);
    c.compact = isCompact(linear.start) && isCompact(linear.end);
  } else {
    origin = &linear.origin;
    direction = linear.direction;
    c.moderate = isModerate(linear.origin) && isModerate(linear.direction);
    c.compact = isCompact(linear.origin) && isCompact(linear.direction);
  }
  double longest = 0.0;
  for (int i = 0; i < 3; ++i) {
    c.origin[i] = (*origin)[i];
    c.direction[i] = direction[i];
    const double length = std::fabs(direction[i]);
    c.negative[i] = direction[i] < 0.0;
    c.inverse[i] = length > 0.0 ? 1.0 / direction[i] : std::numeric_limits<double>::infinity();
    c.moderate &= length >= exact::bounds::kSmallestComponent || length == 0.0;
    longest = std::max(longest, length);
  }
  c.moderate &= longest >= exact::bounds::kSmallestDirection;
  c.compact &= c.moderate;
  return c;
}

/// min <= X <= max.
struct AlignedSlabs {
  double bound[2][3];
};

/// |axes_i . (X - center)| <= half_extents_i.
struct OrientedSlabs {
  double axes[3][3];
  double center[3];
  double half_extents[3];
  double padded_extent_sum;  ///< with kUnderflow / kSlab, so that eta has kUnderflow in it
};

/// Enclosures of where a component enters and leaves each slab: near_lo <= near <= near_hi. Those
/// of an oriented box mean something only where the component is in the box.
struct SlabTimes {
  double near_lo[3];
  double near_hi[3];
  double far_lo[3];
  double far_hi[3];
  bool negative[3];  ///< the component goes down the axis
};

/// Encloses the parameters of entry and exit, if there are any.
struct Enclosure {
  double enter_lo;
  double enter_hi;
  double exit_lo;
  double exit_hi;

  bool isMiss() const { return enter_lo > exit_hi; }
  bool isHit() const { return enter_hi <= exit_lo; }
};

inline double widenedDown(double t) {
  constexpr double kC = exact::bounds::kAlignedSlab;
  return std::min(t * (1.0 - kC), t * (1.0 + kC));
}

inline double widenedUp(double t) {
  constexpr double kC = exact::bounds::kAlignedSlab;
  return std::max(t * (1.0 - kC), t * (1.0 + kC));
}

/// Parameters at the planes of an aligned box. Where the direction is zero they are -inf and +inf
/// inside, or the other way round outside, exactly, and NaN in the plane: no comparison holds for a
/// NaN, so that the plane does not clip.
inline double nearPlane(const DoubleComponent& c, const AlignedSlabs& box, int i) {
  return (box.bound[c.negative[i] ? 1 : 0][i] - c.origin[i]) * c.inverse[i];
}

inline double farPlane(const DoubleComponent& c, const AlignedSlabs& box, int i) {
  return (box.bound[c.negative[i] ? 0 : 1][i] - c.origin[i]) * c.inverse[i];
}

template <typename T>
Enclosure clippedToOwn(Enclosure e) {
  if constexpr (kHasStart<T>) {
    e.enter_lo = std::max(e.enter_lo, 0.0);
    e.enter_hi = std::max(e.enter_hi, 0.0);
  }
  if constexpr (kHasEnd<T>) {
    e.exit_lo = std::min(e.exit_lo, 1.0);
    e.exit_hi = std::min(e.exit_hi, 1.0);
  }
  return e;
}

template <typename T>
Enclosure enclose(const DoubleComponent& c, const AlignedSlabs& box) {
  double near = -std::numeric_limits<double>::infinity();
  double far = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    near = std::max(near, nearPlane(c, box, i));  // (max(a, NaN) is a)
    far = std::min(far, farPlane(c, box, i));
  }
  // Widening is monotone, so that once is enough. A start makes near >= 0; far < 0 is a miss then,
  // whichever way it is widened.
  if constexpr (kHasStart<T>) {
    constexpr double kC = exact::bounds::kAlignedSlab;
    near = std::max(near, 0.0);
    return clippedToOwn<T>(
        {near * (1.0 - kC), near * (1.0 + kC), far * (1.0 - kC), far * (1.0 + kC)});
  }
  return clippedToOwn<T>({widenedDown(near), widenedUp(near), widenedDown(far), widenedUp(far)});
}

inline SlabTimes slabTimes(const DoubleComponent& c, const AlignedSlabs& box) {
  SlabTimes t;
  for (int i = 0; i < 3; ++i) {
    const double near = nearPlane(c, box, i);
    const double far = farPlane(c, box, i);
    const bool in_plane_near = std::isnan(near);
    const bool in_plane_far = std::isnan(far);
    constexpr double kInf = std::numeric_limits<double>::infinity();
    t.near_lo[i] = in_plane_near ? -kInf : widenedDown(near);
    t.near_hi[i] = in_plane_near ? -kInf : widenedUp(near);
    t.far_lo[i] = in_plane_far ? kInf : widenedDown(far);
    t.far_hi[i] = in_plane_far ? kInf : widenedUp(far);
    t.negative[i] = c.negative[i];
  }
  return t;
}

/// `times` the eta of bounds::kSlab, where the component starts at the center + v.
template <int times = 1>
inline double slabError(const double* v, const OrientedSlabs& box) {
  return times * exact::bounds::kSlab *
         ((std::fabs(v[0]) + std::fabs(v[1])) + (std::fabs(v[2]) + box.padded_extent_sum));
}

struct Verdict {
  bool certain;
  bool hit;  ///< if it is certain
};

/// Whether a component meets an oriented box, in little more than the plain slab test.
///
/// Its parameters of entry and exit are those of slabTimes without eta, which would move each by
/// eta |r_i|, r = 1 / d. So where the gap between the last entry and the first exit is more than
/// 2 eta (|r_0| + |r_1| + |r_2|), enclose() would decide the same.
///
/// Nothing is assumed of the magnitudes: where bound <= 2^50, |r_i| is below 2^1010 (eta is at
/// least kUnderflow), so that no d_i is 0 or short of bits, and no parameter overflows; where
/// |r_i| >= 2^-100, no d_i overflows, and what underflow adds is in eta.
template <typename T>
inline Verdict quickVerdict(const T& linear, const OrientedSlabs& box) {
  double v[3];
  double direction[3];
  for (int i = 0; i < 3; ++i) {
    if constexpr (kHasEnd<T>) {
      v[i] = linear.start[i] - box.center[i];
      direction[i] = linear.end[i] - linear.start[i];
    } else {
      v[i] = linear.origin[i] - box.center[i];
      direction[i] = linear.direction[i];
    }
  }
  double minus_enter = kHasStart<T> ? 0.0 : std::numeric_limits<double>::infinity();
  double exit = kHasEnd<T> ? 1.0 : std::numeric_limits<double>::infinity();
  double r_abs[3];
  for (int i = 0; i < 3; ++i) {
    const double* axis = box.axes[i];
    const double y = axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
    const double d = axis[0] * direction[0] + axis[1] * direction[1] + axis[2] * direction[2];
    const double r = 1.0 / d;
    r_abs[i] = std::fabs(r);
    const double minus_middle = y * r;
    const double half = box.half_extents[i] * r_abs[i];
    minus_enter = std::min(minus_enter, half + minus_middle);
    exit = std::min(exit, half - minus_middle);
  }
  const double bound = slabError<2>(v, box) * ((r_abs[0] + r_abs[1]) + r_abs[2]);
  const double gap = exit + minus_enter;
  const bool certain =
      std::fabs(gap) > bound && bound <= 0x1p50 &&
      std::min(std::min(r_abs[0], r_abs[1]), r_abs[2]) >= 1.0 / exact::bounds::kLargest;
  return {certain, gap > 0.0};
}

inline SlabTimes slabTimes(const DoubleComponent& c, const OrientedSlabs& box) {
  const double v[3] = {c.origin[0] - box.center[0], c.origin[1] - box.center[1],
                       c.origin[2] - box.center[2]};
  const double eta = slabError(v, box);
  SlabTimes t;
  for (int i = 0; i < 3; ++i) {
    const double* axis = box.axes[i];
    const double y = axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
    const double d = axis[0] * c.direction[0] + axis[1] * c.direction[1] + axis[2] * c.direction[2];
    const double inverse = 1.0 / std::copysign(std::max(std::fabs(d), exact::bounds::kFlattest), d);
    const double middle = -y * inverse;
    const double outer = (box.half_extents[i] + eta) * std::fabs(inverse);
    const double inner = (box.half_extents[i] - eta) * std::fabs(inverse);
    t.near_lo[i] = middle - outer;
    t.near_hi[i] = middle - inner;
    t.far_lo[i] = middle + inner;
    t.far_hi[i] = middle + outer;
    t.negative[i] = d < 0.0;
  }
  return t;
}

template <typename T>
Enclosure enclose(const SlabTimes& t) {
  return clippedToOwn<T>({std::max(std::max(t.near_lo[0], t.near_lo[1]), t.near_lo[2]),
                          std::max(std::max(t.near_hi[0], t.near_hi[1]), t.near_hi[2]),
                          std::min(std::min(t.far_lo[0], t.far_lo[1]), t.far_lo[2]),
                          std::min(std::min(t.far_hi[0], t.far_hi[1]), t.far_hi[2])});
}

template <typename T>
Enclosure enclose(const DoubleComponent& c, const OrientedSlabs& box) {
  return enclose<T>(slabTimes(c, box));
}

/// Whether a component that crosses one thin slab, which the filter cannot resolve, certainly meets
/// the box: it does if it stays within the two others, and within its own ends, all the while.
/// Between near_lo and far_hi it certainly crosses the thin slab.
template <typename T>
bool crossesThinSlab(const SlabTimes& t) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const double lo = t.near_lo[i];
    const double hi = t.far_hi[i];
    if (t.near_hi[j] <= lo && t.near_hi[k] <= lo && hi <= t.far_lo[j] && hi <= t.far_lo[k] &&
        (!kHasStart<T> || lo >= 0.0) && (!kHasEnd<T> || hi <= 1.0)) {
      return true;
    }
  }
  return false;
}

}  // namespace box_query
