// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Liang-Barsky clipping (paper, section 3), one algorithm in two arithmetics: Dyadic always
/// decides, Certified decides or says that it cannot.
///
/// Line, ray and segment are one clip with three intervals, and an oriented box is an aligned one
/// in its own frame. With n = |q|^2 and M = n R nothing is divided in that frame: y = M^T (P - C),
/// d = M^T D, E = n e, and M^T M = n^2 I holds exactly whatever |q| is.
#pragma once

#include "exact/certified.h"
#include "exact/dyadic.h"

#include <box_query/geometry.h>

#include <array>

namespace box_query::exact {

/// Whether the parameter of a component is bounded by 0 below, by 1 above.
template <typename T>
inline constexpr bool kHasStart = true;
template <>
inline constexpr bool kHasStart<Line> = false;
template <typename T>
inline constexpr bool kHasEnd = false;
template <>
inline constexpr bool kHasEnd<Segment> = true;

/// origin + t * direction with t >= 0 if has_start and t <= 1 if has_end.
template <typename Number>
struct BasicComponent {
  std::array<Number, 3> origin;
  std::array<Number, 3> direction;
  bool has_start;
  bool has_end;
};

/// The points of a component that lie in a box: below_i <= t * direction_i <= above_i, in the frame
/// of the box, up to a positive factor.
template <typename Number>
struct BasicSlabs {
  std::array<Number, 3> below;
  std::array<Number, 3> above;
  std::array<Number, 3> direction;
};

/// num / den with den > 0, or an infinity: num = +-1, den = 0.
template <typename Number>
struct BasicParameter {
  Number num;
  Number den;
};

/// What of a component lies in a box; the fields are those of Intersection. On a miss only
/// num_points and started_inside mean something.
template <typename Number>
struct BasicClip {
  int num_points = 0;
  bool started_inside = false;
  FaceSet entered;
  FaceSet left;
  BasicParameter<Number> enter;
  BasicParameter<Number> exit;
};

using Component = BasicComponent<Dyadic>;
using Slabs = BasicSlabs<Dyadic>;
using Parameter = BasicParameter<Dyadic>;
using Clip = BasicClip<Dyadic>;

template <typename Number>
std::array<Number, 3> exactly(const Vector3& v) {
  return {Number(v[0]), Number(v[1]), Number(v[2])};
}

template <typename Number>
std::array<Number, 3> difference(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <typename Number>
Number dot(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <typename Number, typename T>
BasicComponent<Number> basicComponent(const T& linear) {
  if constexpr (kHasEnd<T>) {
    const auto start = exactly<Number>(linear.start);
    return {start, difference(exactly<Number>(linear.end), start), true, true};
  } else {
    return {exactly<Number>(linear.origin), exactly<Number>(linear.direction), kHasStart<T>, false};
  }
}

template <typename Number>
BasicSlabs<Number> basicSlabs(const BasicComponent<Number>& component, const AlignedBox& box,
                              bool /*shorten*/ = false) {
  return {difference(exactly<Number>(box.min), component.origin),
          difference(exactly<Number>(box.max), component.origin), component.direction};
}

/// Divides n out of an axis n * (0, 0, +-1), in any order. Then whatever touches the two faces on
/// it, a ray along a shelf, say, does so in short numbers.
template <typename Number>
bool alignWithWorld(std::array<Number, 3>& axis) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (axis[(i + 1) % 3].sign() == 0 && axis[(i + 2) % 3].sign() == 0) {
      axis[i] = axis[i].sign();
      return true;
    }
  }
  return false;
}

/// @param shorten scales the axes each by its own factor where that makes the numbers shorter;
/// without it all are scaled by |q|^2
template <typename Number>
BasicSlabs<Number> basicSlabs(const BasicComponent<Number>& component, const OrientedBox& box,
                              bool shorten = false) {
  const Number w = box.orientation.w();
  const Number x = box.orientation.x();
  const Number y = box.orientation.y();
  const Number z = box.orientation.z();
  const auto twice = [](const Number& a) { return a + a; };
  const Number ww = w * w, xx = x * x, yy = y * y, zz = z * z;
  const Number xy = twice(x * y), xz = twice(x * z), yz = twice(y * z);
  const Number wx = twice(w * x), wy = twice(w * y), wz = twice(w * z);
  const Number n = (ww + xx) + (yy + zz);
  std::array<Number, 3> axes[3] = {{(ww - zz) + (xx - yy), xy + wz, xz - wy},
                                   {xy - wz, (ww - zz) - (xx - yy), yz + wx},
                                   {xz + wy, yz - wx, (ww + zz) - (xx + yy)}};
  const std::array<Number, 3> offset = difference(component.origin, exactly<Number>(box.center));
  BasicSlabs<Number> result;
  for (std::size_t i = 0; i < 3; ++i) {
    Number extent = box.half_extents[static_cast<int>(i)];
    if (!shorten || !alignWithWorld(axes[i])) {
      extent = n * extent;
    }
    const Number position = dot(axes[i], offset);
    result.below[i] = -extent - position;
    result.above[i] = extent - position;
    result.direction[i] = dot(axes[i], component.direction);
  }
  return result;
}

/// -1, 0 or 1 as a < b, a = b or a > b; kUnknownSign if the arithmetic cannot tell.
template <typename Number>
int compare(const BasicParameter<Number>& a, const BasicParameter<Number>& b) {
  return (a.num * b.den - b.num * a.den).sign();
}

/// Clips [0 or -inf, 1 or +inf] by the three slabs.
/// @return whether the arithmetic could tell everything that `result` says.
template <typename Number>
bool clip(const BasicSlabs<Number>& slabs, bool has_start, bool has_end,
          BasicClip<Number>& result) {
  result = BasicClip<Number>();
  result.enter = {has_start ? 0.0 : -1.0, has_start ? 1.0 : 0.0};
  result.exit = {1.0, has_end ? 1.0 : 0.0};
  result.started_inside = has_start;
  bool is_point = true;
  bool outside = false;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const Number& below = slabs.below[axis];
    const Number& above = slabs.above[axis];
    const int sign = slabs.direction[axis].sign();
    const int below_sign = below.sign();
    const int above_sign = above.sign();
    if (sign == kUnknownSign || below_sign == kUnknownSign || above_sign == kUnknownSign) {
      return false;
    }
    const bool contains_start = below_sign <= 0 && above_sign >= 0;
    result.started_inside = result.started_inside && contains_start;
    if (sign == 0) {
      outside = outside || !contains_start;
      continue;
    }
    is_point = false;
    // For a direction d < 0: -above <= t * (-d) <= -below.
    const bool positive = sign > 0;
    const Number length = positive ? slabs.direction[axis] : -slabs.direction[axis];
    const BasicParameter<Number> near{positive ? below : -above, length};
    const BasicParameter<Number> far{positive ? above : -below, length};
    const int enters = compare(near, result.enter);
    const int leaves = compare(far, result.exit);
    if (enters == kUnknownSign || leaves == kUnknownSign) {
      return false;
    }
    if (enters > 0) {
      result.enter = near;
      result.entered = FaceSet();
    }
    if (enters >= 0) {
      result.entered.insert(i, !positive);
    }
    if (leaves < 0) {
      result.exit = far;
      result.left = FaceSet();
    }
    if (leaves <= 0) {
      result.left.insert(i, positive);
    }
  }
  const int order = is_point ? 0 : compare(result.enter, result.exit);
  if (!outside && order <= 0) {
    result.num_points = order == 0 ? 1 : 2;
  }
  return order != kUnknownSign;
}

// The stage that always decides.

template <typename T>
Component component(const T& linear) {
  return basicComponent<Dyadic>(linear);
}

template <typename BoxType>
Slabs slabs(const Component& component, const BoxType& box) {
  return basicSlabs(component, box);
}

Clip clip(const Component& component, const Box& box);

/// The parameter, correctly rounded.
double rounded(const Parameter& t);

/// t * sqrt(squared_length), correctly rounded; 0 where the length is.
double roundedRange(const Parameter& t, const Dyadic& squared_length);

/// Whether |t| * sqrt(squared_length) <= range.
bool isWithin(const Parameter& t, const Dyadic& squared_length, double range);

/// origin + t * direction, every coordinate correctly rounded. (At an infinite parameter the
/// direction is zero.)
Vector3 roundedPoint(const Component& component, const Parameter& t);

}  // namespace box_query::exact
