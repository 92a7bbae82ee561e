// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Exact points, and how far a point in doubles is from one.
#pragma once

#include "reference/oracle/slabs.h"

namespace box_query::oracle {

/// numerator / denominator, denominator > 0, in the frame of the query.
struct ExactPoint {
  DyadicVector numerator;
  Dyadic denominator;
};

/// The point of the component at t.
ExactPoint pointAt(const ExactComponent& component, const Fraction& t);

/// The point of the box that is nearest to the component's point at t.
ExactPoint nearestOnBox(const ExactComponent& component, const ExactBox& box, const Fraction& t);

/// Largest coordinate of what describes a component or a box: of its points, not its direction.
double largestCoordinate(const Line& line);
double largestCoordinate(const Ray& ray);
double largestCoordinate(const Segment& segment);
double largestCoordinate(const AlignedBox& box);
double largestCoordinate(const OrientedBox& box);
double largestCoordinate(const Box& box);

/// Largest error of a coordinate in ulps of `scale`, +inf if a coordinate is not finite.
double pointError(const Vector3& point, const ExactPoint& exact, double scale);

}  // namespace box_query::oracle
