// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Distance from a segment to a box in double, with a bound of its error.
///
/// Let x(t) = t d be a point of the segment in the frame of the box, ex(t) its excess over the box,
/// a_i <= x_i <= b_i. However t in [0, 1] was found, the distance is at most |ex(t)|. And the plane
/// through the face, edge or corner that ex(t) points away from separates: with w = ex(t), and c_i
/// = b_i where w_i > 0, a_i where w_i < 0, the distance is at least min(-w.c, w.(d - c)) / |w|,
/// since that is the smaller distance of the two ends from the plane. Both bounds meet where t is
/// the nearest point, so that neither t nor the pieces of f need a proof.
///
/// Errors, u = 2^-53, S = |P - C|_1, E = |e|_1, D = |direction|_1: entries of the axes are within
/// 10u, a_i and b_i within 16u (S + E) (u S from the difference, 10u S from the axes, 3u S from the
/// dot product, the rest from -e - y), d_i within 15u D. S + E + D <= 1.74 s, where s is the sum of
/// max(|a_i|, |b_i|) + |d_i|, so that a_i and d_i together are within 54u s; an aligned box is
/// better off. Then each ex_i(t) is within 57u s, |ex| within 99u s, and w.c / |w|, with the
/// rounding of two dot products, the root and the quotient, within (1.74 * 54 + 32)u s: 126u s.
#pragma once

#include "exact/distance_bounds.h"
#include "exact/float_model.h"
#include "geometry/slabs.h"

#include <box_query/geometry.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace box_query {

/// A segment in the frame of a box: the start is the origin, and t * direction is in the box where
/// below_i <= t * direction_i <= above_i.
struct SegmentSlabs {
  std::array<double, 3> below;
  std::array<double, 3> above;
  std::array<double, 3> direction;
  double scale;

  /// Whether the error bounds hold.
  bool isInRange() const {
    return scale >= exact::bounds::kSmallestScale && scale <= exact::bounds::kLargestScale;
  }
  /// Bounds the error of a distance, and of each excess.
  double error() const { return exact::bounds::kDistance * scale; }
  /// Bounds the error of direction . excess, half the slope of the squared distance.
  double slopeError() const {
    const double length =
        std::fabs(direction[0]) + std::fabs(direction[1]) + std::fabs(direction[2]);
    return exact::bounds::kSlope * scale * std::max(length, exact::bounds::kShortestDirection);
  }
};

/// Whether the segment certainly starts in the box.
inline bool startsInside(const SegmentSlabs& s) {
  const double error = s.error();
  return s.isInRange() && s.below[0] < -error && s.above[0] > error && s.below[1] < -error &&
         s.above[1] > error && s.below[2] < -error && s.above[2] > error;
}

inline double scaleOf(const SegmentSlabs& s) {
  double scale = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    scale += std::max(std::fabs(s.below[i]), std::fabs(s.above[i])) + std::fabs(s.direction[i]);
  }
  return scale;
}

inline SegmentSlabs segmentSlabs(const Segment& segment, const AlignedSlabs& box) {
  SegmentSlabs s;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    s.below[k] = box.bound[0][i] - segment.start[i];
    s.above[k] = box.bound[1][i] - segment.start[i];
    s.direction[k] = segment.end[i] - segment.start[i];
  }
  s.scale = scaleOf(s);
  return s;
}

inline SegmentSlabs segmentSlabs(const Segment& segment, const OrientedSlabs& box) {
  double p[3];
  double d[3];
  for (int j = 0; j < 3; ++j) {
    p[j] = segment.start[j] - box.center[j];
    d[j] = segment.end[j] - segment.start[j];
  }
  SegmentSlabs s;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double* axis = box.axes[i];
    const double y = axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
    s.below[k] = -box.half_extents[i] - y;
    s.above[k] = box.half_extents[i] - y;
    s.direction[k] = axis[0] * d[0] + axis[1] * d[1] + axis[2] * d[2];
  }
  s.scale = scaleOf(s);
  return s;
}

using Excess = std::array<double, 3>;

inline Excess excessAt(const SegmentSlabs& s, double t) {
  Excess w;
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = t * s.direction[i];
    w[i] = x - std::min(std::max(x, s.below[i]), s.above[i]);
  }
  return w;
}

inline double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A parameter near the one where the distance is smallest, and the excess there.
struct NearestGuess {
  double t;
  Excess excess;
};

inline NearestGuess guessNearest(const SegmentSlabs& s) {
  NearestGuess start{0.0, excessAt(s, 0.0)};
  if (dot(s.direction, start.excess) >= 0.0) {
    return start;
  }
  NearestGuess end{1.0, excessAt(s, 1.0)};
  if (dot(s.direction, end.excess) <= 0.0) {
    return end;
  }
  // The slope g = d.ex rises, linearly between break points, from negative to positive: Newton's
  // method, kept in its bracket, from the point nearest to the center.
  const std::array<double, 3> middle{s.below[0] + s.above[0], s.below[1] + s.above[1],
                                     s.below[2] + s.above[2]};
  double lower = 0.0;
  double upper = 1.0;
  double t = 0.5 * dot(s.direction, middle) / dot(s.direction, s.direction);
  NearestGuess guess = start;
  for (int step = 0; step < 8; ++step) {
    if (!(t > lower && t < upper)) {
      t = 0.5 * (lower + upper);
    }
    guess = {t, excessAt(s, t)};
    double slope = 0.0;
    double curvature = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      slope += s.direction[i] * guess.excess[i];
      curvature += guess.excess[i] != 0.0 ? s.direction[i] * s.direction[i] : 0.0;
    }
    const double change = slope / curvature;
    if (!(std::fabs(change) > 0x1p-51 * t)) {
      break;  // found; also where the excess, and with it the curvature, is 0
    }
    (slope < 0.0 ? lower : upper) = t;
    t -= change;
  }
  return guess;
}

/// Certified bounds of the distance; lower may be negative.
struct DistanceBounds {
  double lower;
  double upper;
};

/// @pre s.isInRange()
inline DistanceBounds distanceBounds(const SegmentSlabs& s, const Excess& w) {
  std::array<double, 3> face;
  for (std::size_t i = 0; i < 3; ++i) {
    face[i] = w[i] > 0.0 ? s.above[i] : s.below[i];
  }
  const double length = std::sqrt(dot(w, w));
  const double at_start = -dot(w, face);
  const double at_end = at_start + dot(w, s.direction);
  const double error = s.error();
  if (length == 0.0) {
    return {0.0, error};
  }
  return {std::min(at_start, at_end) / length - error, length + error};
}

/// Whether the distance certainly falls at t.
/// @pre s.isInRange()
inline bool isFalling(const SegmentSlabs& s, const Excess& excess) {
  return dot(s.direction, excess) < -s.slopeError();
}

/// Certainly encloses the smallest parameter within a radius.
struct ParameterBounds {
  double lower;
  double upper;
};

/// A parameter near the smallest one within the radius, by Newton's method on the distance: it is
/// convex, so that from the left no step goes too far.
inline double guessFirstWithin(const SegmentSlabs& s, double radius) {
  double t = 0.0;
  for (int step = 0; step < 16; ++step) {
    const Excess w = excessAt(s, t);
    const double length = std::sqrt(dot(w, w));
    const double change = (length - radius) * length / -dot(s.direction, w);
    if (!(change > 0x1p-52 * t)) {
      break;
    }
    t += change;
  }
  return std::min(t, 1.0);
}

/// Bounds of the smallest parameter within the radius from a guess of it; 0 and 1 where nothing
/// better is certain.
/// @pre s.isInRange(), and the smallest distance is at most the radius
inline ParameterBounds firstWithinBounds(const SegmentSlabs& s, double radius, double guess) {
  const auto length = [](const Excess& w) { return std::sqrt(dot(w, w)); };
  ParameterBounds bounds{0.0, 1.0};
  const Excess w = excessAt(s, guess);
  const double steepness = -dot(s.direction, w) / length(w);
  const double slack = 4.0 * s.error() / steepness + 0x1p-50 * guess;
  if (!(steepness > 0.0 && slack < 1.0)) {
    return bounds;  // where the distance does not fall, a step to either side tells nothing
  }
  const Excess before = excessAt(s, guess - slack);
  if (guess > slack && length(before) - s.error() > radius && isFalling(s, before)) {
    bounds.lower = guess - slack;
  }
  if (guess + slack < 1.0 && length(excessAt(s, guess + slack)) + s.error() <= radius) {
    bounds.upper = guess + slack;
  }
  return bounds;
}

}  // namespace box_query
