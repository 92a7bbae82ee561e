// SPDX-License-Identifier: BSD-3-Clause
#include "reference/oracle/points.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace box_query::oracle {

ExactPoint pointAt(const ExactComponent& component, const Fraction& t) {
  ExactPoint result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.numerator[i] =
        component.origin[i] * t.denominator + component.direction[i] * t.numerator;
  }
  result.denominator = t.denominator;
  return result;
}

ExactPoint nearestOnBox(const ExactComponent& component, const ExactBox& box, const Fraction& t) {
  const Slabs slabs(component, box);
  DyadicVector clamped;
  for (std::size_t i = 0; i < 3; ++i) {
    const Dyadic low = slabs.low[i] * t.denominator;
    const Dyadic high = slabs.high[i] * t.denominator;
    clamped[i] = slabs.y[i] * t.denominator + slabs.d[i] * t.numerator;
    if (compare(clamped[i], low) < 0) {
      clamped[i] = low;
    } else if (compare(clamped[i], high) > 0) {
      clamped[i] = high;
    }
  }
  // Lengths in the box frame are n times those of the world, and so are the columns of M.
  ExactPoint result;
  result.denominator = square(slabs.n) * t.denominator;
  const DyadicVector offset = box.toWorld(clamped);
  for (std::size_t i = 0; i < 3; ++i) {
    result.numerator[i] = offset[i] + box.center[i] * result.denominator;
  }
  return result;
}

double largestCoordinate(const Line& line) {
  return line.origin.cwiseAbs().maxCoeff();
}

double largestCoordinate(const Ray& ray) {
  return ray.origin.cwiseAbs().maxCoeff();
}

double largestCoordinate(const Segment& segment) {
  return segment.start.cwiseAbs().cwiseMax(segment.end.cwiseAbs()).maxCoeff();
}

double largestCoordinate(const AlignedBox& box) {
  return box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
}

double largestCoordinate(const OrientedBox& box) {
  return box.center.cwiseAbs().cwiseMax(box.half_extents).maxCoeff();
}

double largestCoordinate(const Box& box) {
  return std::visit([](const auto& b) { return largestCoordinate(b); }, box);
}

double pointError(const Vector3& point, const ExactPoint& exact, double scale) {
  if (!point.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  const double next = std::nextafter(scale, std::numeric_limits<double>::infinity());
  const double gap = std::isinf(next) ? scale - std::nextafter(scale, 0.0) : next - scale;
  const Dyadic unit = Dyadic(gap) * exact.denominator;
  double largest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Dyadic coordinate = Dyadic(point[static_cast<Eigen::Index>(i)]) * exact.denominator;
    // A coordinate beyond the largest double is to be that.
    const Dyadic limit = Dyadic(std::numeric_limits<double>::max()) * exact.denominator;
    Dyadic wanted = exact.numerator[i];
    if (compare(wanted, limit) > 0) {
      wanted = limit;
    } else if (compare(limit + wanted, Dyadic(0.0)) < 0) {
      wanted = Dyadic(0.0) - limit;
    }
    largest = std::max(largest, std::abs(approximateRatio(coordinate - wanted, unit)));
  }
  return largest;
}

}  // namespace box_query::oracle
