// SPDX-License-Identifier: BSD-3-Clause
//
// In the frame of the box stretched by n = |q|^2, in double-double, with u = 2^-53: an excess at t
// is c + t v, where c, the start seen from a face, and v, the direction, are each within
// eta = 64u^2 n (S + E + D) of the exact ones (exact/bounds.h), so that an excess is within 2.4
// eta.
//
// On the piece of f that holds the nearest point t*, with the guess t near it,
//   g = sum v_i ex_i,  A = sum v_i^2,  t* = t - g / A,  f(t*) = f(t) - g^2 / A,
// and both corrections are so small that double is enough for A. g is within 3 eta (|v|_1 +
// |ex|_1), A within (5u + 3.5 eta / |v|_2) A, f(t) within 5 eta |ex|_1 + 35u^2 f(t), g^2 / A within
// 2 |g / A| times the error of g, which is less than 6.1 eta |ex|_1 where the sides are certain.
#include "geometry/distance_refine.h"

#include "exact/bounds.h"
#include "exact/double_double.h"
#include "geometry/prepared_box.h"
#include "kernels/kernels.h"

#include <type_traits>

namespace box_query {
namespace {

using exact::DoubleDouble;
namespace bounds = exact::bounds;

/// A sum of products, within 35u^2 of the sum of their absolute values.
class DotSum {
 public:
  explicit DotSum(const DoubleDouble& first) : hi_(first.hi), lo_(first.lo) {}
  DotSum(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble product = exact::twoProd(a.hi, b.hi);
    hi_ = product.hi;
    lo_ = product.lo + (a.hi * b.lo + a.lo * b.hi);
  }
  DotSum& add(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble product = exact::twoProd(a.hi, b.hi);
    addProduct(product, a.hi * b.lo + a.lo * b.hi);
    return *this;
  }
  DotSum& add(const DoubleDouble& a, double b) {
    addProduct(exact::twoProd(a.hi, b), a.lo * b);
    return *this;
  }
  DoubleDouble value() const { return exact::fastTwoSum(hi_, lo_); }

 private:
  void addProduct(const DoubleDouble& product, double rest) {
    const DoubleDouble sum = exact::twoSum(hi_, product.hi);
    hi_ = sum.hi;
    lo_ += sum.lo + (product.lo + rest);
  }

  double hi_;
  double lo_;
};

/// A segment seen from the faces of a box, stretched. `end` is the one of its ends that counts as
/// the origin.
template <typename BoxType>
class WideFrame;

template <>
class WideFrame<AlignedBox> {
 public:
  WideFrame(const Segment& segment, const Vector3& end, const AlignedBox& box)
      : segment_(segment), end_(end), box_(box) {}
  DoubleDouble stretch() const { return {1.0, 0.0}; }
  DoubleDouble fromFace(int axis, bool positive) const {
    return exact::twoDiff(end_[axis], (positive ? box_.max : box_.min)[axis]);
  }
  DoubleDouble direction(int axis) const {
    return exact::twoDiff(segment_.end[axis], segment_.start[axis]);
  }

 private:
  const Segment& segment_;
  const Vector3& end_;
  const AlignedBox& box_;
};

template <>
class WideFrame<OrientedBox> {
 public:
  WideFrame(const Segment& segment, const Vector3& end, const OrientedBox& box)
      : box_(box), rows_(doubleDoubleRows(box.orientation)) {
    for (int j = 0; j < 3; ++j) {
      offset_[j] = exact::twoDiff(end[j], box.center[j]);
      direction_[j] = exact::twoDiff(segment.end[j], segment.start[j]);
    }
  }
  DoubleDouble stretch() const { return rows_.n; }
  DoubleDouble fromFace(int axis, bool positive) const {
    const DoubleDouble* row = rows_.axes[axis];
    const double extent = box_.half_extents[axis];
    return DotSum(row[0], offset_[0])
        .add(row[1], offset_[1])
        .add(row[2], offset_[2])
        .add(rows_.n, positive ? -extent : extent)
        .value();
  }
  DoubleDouble direction(int axis) const {
    const DoubleDouble* row = rows_.axes[axis];
    return DotSum(row[0], direction_[0])
        .add(row[1], direction_[1])
        .add(row[2], direction_[2])
        .value();
  }

 private:
  const OrientedBox& box_;
  Rows rows_;
  DoubleDouble offset_[3];
  DoubleDouble direction_[3];
};

/// f and its first two derivatives at a point, stretched, on the piece of the sides.
struct WideValue {
  DoubleDouble squared;        ///< f
  DoubleDouble slope;          ///< f' / 2
  double curvature = 0.0;      ///< f'' / 2
  double excess_sum = 0.0;     ///< sum |ex_i|
  double direction_sum = 0.0;  ///< sum |v_i| over the same axes
};

/// At the origin of the frame; f only.
template <typename Frame>
WideValue valueAtOrigin(const Frame& frame, const Excess& sides) {
  WideValue value;
  DotSum squared{DoubleDouble()};
  for (int i = 0; i < 3; ++i) {
    const double side = sides[static_cast<std::size_t>(i)];
    if (side != 0.0) {
      const DoubleDouble excess = frame.fromFace(i, side > 0.0);
      squared.add(excess, excess);
      value.excess_sum += std::fabs(excess.hi);
    }
  }
  value.squared = squared.value();
  return value;
}

/// At t, counted from the start, which is the origin.
template <typename Frame>
WideValue valueAt(const Frame& frame, double t, const Excess& sides) {
  WideValue value;
  DotSum squared{DoubleDouble()};
  DotSum slope{DoubleDouble()};
  for (int i = 0; i < 3; ++i) {
    const double side = sides[static_cast<std::size_t>(i)];
    if (side != 0.0) {
      const DoubleDouble direction = frame.direction(i);
      const DoubleDouble excess = DotSum(frame.fromFace(i, side > 0.0)).add(direction, t).value();
      squared.add(excess, excess);
      slope.add(direction, excess);
      value.curvature += direction.hi * direction.hi;
      value.excess_sum += std::fabs(excess.hi);
      value.direction_sum += std::fabs(direction.hi);
    }
  }
  value.squared = squared.value();
  value.slope = slope.value();
  return value;
}

/// Whether the excess certainly keeps its sides at every parameter within `change` of t.
bool sidesAreCertain(const SegmentSlabs& s, double t, const Excess& sides, double change) {
  const double error = s.error() + std::fabs(change) * s.scale;
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = t * s.direction[i];
    const bool certain = sides[i] != 0.0 ? std::fabs(sides[i]) > error
                                         : x - s.below[i] > error && s.above[i] - x > error;
    if (!certain) {
      return false;
    }
  }
  return true;
}

/// Together with the range of the slabs: nothing overflows, and what underflows, even of a
/// component of the quaternion, is far below the error.
bool isInRange(const DoubleDouble& n) {
  return n.hi >= bounds::kSmallestStretch && n.hi <= bounds::kLargestStretch;
}

/// The error of an excess in the stretched frame.
double wideError(const SegmentSlabs& slabs, const DoubleDouble& n) {
  return bounds::kRow * 2.0 * n.hi * slabs.scale;
}

/// Ziv's test: the double that every number within `error` of x[0] + x[1] rounds to, if there is
/// one.
std::optional<double> rounded(const double* x, double error) {
  const double low = x[0] + (x[1] - error);
  const double high = x[0] + (x[1] + error);
  return low == high ? std::optional<double>(low) : std::nullopt;
}

/// Both, rounded, if that is certain.
std::optional<RoundedDistance> roundedOf(const kernels::Refined& refined) {
  const auto t = rounded(refined.t, refined.t_error);
  const auto distance = rounded(refined.distance, refined.distance_error);
  if (!t || (refined.inside && !(*t > 0.0 && *t < 1.0)) || !distance) {
    return std::nullopt;
  }
  return RoundedDistance{*distance, *t};
}

/// One axis after the other.
/// @return whether the box is taken, and its sides are certain
template <typename BoxType>
bool refine(const Segment& segment, const BoxType& box, const SegmentSlabs& slabs,
            const NearestGuess& guess, kernels::Refined& refined) {
  const double slope = dot(slabs.direction, guess.excess);
  const bool at_start =
      guess.t == 0.0 && (slope > slabs.slopeError() || segment.start == segment.end);
  const bool at_end = guess.t == 1.0 && slope < -slabs.slopeError();
  const bool inside = !at_start && !at_end;
  const WideFrame<BoxType> frame(segment, at_end ? segment.end : segment.start, box);
  const DoubleDouble n = frame.stretch();
  if (!isInRange(n)) {
    return false;
  }
  const WideValue f =
      inside ? valueAt(frame, guess.t, guess.excess) : valueAtOrigin(frame, guess.excess);
  const double eta = wideError(slabs, n);
  double change = 0.0;
  double curvature_error = 0.0;
  double t_error = 0.0;
  if (inside) {
    const double inverse = 1.0 / f.curvature;
    change = -f.slope.hi * inverse;
    curvature_error = 16.0 * bounds::kUnit + 4.0 * eta * std::sqrt(inverse);
    t_error = 4.0 * eta * (f.direction_sum + f.excess_sum) * inverse +
              std::fabs(change) * curvature_error;
  }
  const DoubleDouble t = exact::twoSum(guess.t, change);

  const double fall = change * change * f.curvature;
  const DoubleDouble squared = exact::fastTwoSum(f.squared.hi, f.squared.lo - fall);
  // One step of Newton's method for sqrt(squared) / n, with the rest in double-double.
  const double root = std::sqrt(squared.hi) / n.hi;
  const double factor = 0.5 / (root * n.hi * n.hi);
  const DoubleDouble stretched = n * DoubleDouble{root, 0.0};
  const DoubleDouble distance =
      exact::fastTwoSum(root, (squared - stretched * stretched).hi * factor);
  const double error = (12.0 * eta * f.excess_sum + 8.0 * curvature_error * fall) * factor +
                       2.0 * bounds::kOperation * root;
  refined = {inside, {t.hi, t.lo}, t_error, {distance.hi, distance.lo}, error};
  return sidesAreCertain(slabs, guess.t, guess.excess, change);
}

}  // namespace

std::optional<RoundedDistance> refinedByKernel(const Segment& segment, const OrientedBox& box,
                                               double t) {
  kernels::Refined refined;
  const auto by_kernel = kernels::active().refine;
  if (by_kernel == nullptr ||
      !by_kernel({box.orientation.coeffs().data(), box.center.data(), box.half_extents.data(),
                  segment.start.data(), segment.end.data(), t},
                 refined)) {
    return std::nullopt;
  }
  return roundedOf(refined);
}

template <typename BoxType>
std::optional<RoundedDistance> refinedDistance(const Segment& segment, const BoxType& box,
                                               const SegmentSlabs& slabs,
                                               const NearestGuess& guess) {
  if constexpr (std::is_same_v<BoxType, OrientedBox>) {
    if (kernels::active().refine != nullptr) {
      return refinedByKernel(segment, box, guess.t);
    }
  }
  kernels::Refined refined;
  return refine(segment, box, slabs, guess, refined) ? roundedOf(refined) : std::nullopt;
}

template <typename BoxType>
std::optional<double> refinedFirstWithin(const Segment& segment, const BoxType& box,
                                         const SegmentSlabs& slabs, double radius, double guess) {
  const WideFrame<BoxType> frame(segment, segment.start, box);
  const DoubleDouble n = frame.stretch();
  if (!isInRange(n)) {
    return std::nullopt;
  }
  const DoubleDouble reach = n * DoubleDouble{radius, 0.0};
  const DoubleDouble limit = reach * reach;
  const double eta = wideError(slabs, n);

  double t = guess;
  for (int step = 0; step < 4; ++step) {
    // The distance must fall from 0 to t, be at least the radius at t, and less at its neighbour.
    const double next = std::nextafter(t, 1.0);
    const Excess sides = excessAt(slabs, t);
    if (!(t > 0.0 && next < 1.0) || !isFalling(slabs, sides) ||
        !sidesAreCertain(slabs, t, sides, next - t)) {
      return std::nullopt;
    }
    const WideValue at = valueAt(frame, t, sides);
    const WideValue after = valueAt(frame, next, sides);
    const double error = 6.0 * eta * at.excess_sum + 2.0 * bounds::kOperation * limit.hi;
    const DoubleDouble rest = at.squared - limit;
    if (rest.hi > error && (after.squared - limit).hi < -error) {
      return t;
    }
    // Newton's method from the left, but for the rounding of the sum.
    t = std::min(t - rest.hi / (2.0 * at.slope.hi), 1.0);
    if (rest.hi < 0.0) {
      t = std::nextafter(t, 0.0);
    }
  }
  return std::nullopt;
}

template std::optional<RoundedDistance> refinedDistance(const Segment&, const AlignedBox&,
                                                        const SegmentSlabs&, const NearestGuess&);
template std::optional<RoundedDistance> refinedDistance(const Segment&, const OrientedBox&,
                                                        const SegmentSlabs&, const NearestGuess&);
template std::optional<double> refinedFirstWithin(const Segment&, const AlignedBox&,
                                                  const SegmentSlabs&, double, double);
template std::optional<double> refinedFirstWithin(const Segment&, const OrientedBox&,
                                                  const SegmentSlabs&, double, double);

}  // namespace box_query
