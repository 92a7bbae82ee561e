// SPDX-License-Identifier: BSD-3-Clause
#include "reference/oracle/distance.h"

#include <algorithm>
#include <vector>

namespace box_query::oracle {
namespace {

/// Signed amounts by which the point at t leaves each slab, times t's denominator (and n).
DyadicVector excess(const Slabs& slabs, const Fraction& t) {
  DyadicVector result;
  for (std::size_t i = 0; i < 3; ++i) {
    const Dyadic p = slabs.y[i] * t.denominator + slabs.d[i] * t.numerator;
    const Dyadic above = p - slabs.high[i] * t.denominator;
    const Dyadic below = p - slabs.low[i] * t.denominator;
    if (above.sign() > 0) {
      result[i] = above;
    } else if (below.sign() < 0) {
      result[i] = below;
    }
  }
  return result;
}

Fraction squaredDistance(const Slabs& slabs, const Fraction& t) {
  const DyadicVector e = excess(slabs, t);
  return {dot(e, e), square(t.denominator * slabs.n)};
}

/// Half the derivative of the squared distance at t has this sign.
int slope(const Slabs& slabs, const Fraction& t) {
  return dot(excess(slabs, t), slabs.d).sign();
}

/// 0, 1 and the crossings of the planes in between, ascending.
std::vector<Fraction> breakPoints(const Slabs& slabs) {
  const Fraction zero;
  const Fraction one{1.0, 1.0};
  std::vector<Fraction> result = {zero, one};
  for (std::size_t i = 0; i < 3; ++i) {
    const int sign = slabs.d[i].sign();
    if (sign == 0) {
      continue;
    }
    for (const Dyadic& bound : {slabs.low[i], slabs.high[i]}) {
      const Dyadic distance = bound - slabs.y[i];
      if (distance.sign() * sign > 0) {
        const Fraction t =
            sign > 0 ? Fraction{distance, slabs.d[i]} : Fraction{-distance, -slabs.d[i]};
        if (t < one) {
          result.push_back(t);
        }
      }
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// The squared distance times n^2 is a t^2 + 2 b t + c.
struct Quadratic {
  Dyadic a;
  Dyadic b;
  Dyadic c;
};

/// The quadratic between two neighbouring break points. A slab counts if the point is outside it at
/// either of them: between them its excess is linear and has no zero.
Quadratic quadraticBetween(const Slabs& slabs, const Fraction& from, const Fraction& to) {
  const DyadicVector at_from = excess(slabs, from);
  const DyadicVector at_to = excess(slabs, to);
  Quadratic result;
  for (std::size_t i = 0; i < 3; ++i) {
    const int side = at_from[i].sign() != 0 ? at_from[i].sign() : at_to[i].sign();
    if (side != 0) {
      const Dyadic offset = slabs.y[i] - (side > 0 ? slabs.high[i] : slabs.low[i]);
      result.a = result.a + square(slabs.d[i]);
      result.b = result.b + slabs.d[i] * offset;
      result.c = result.c + square(offset);
    }
  }
  return result;
}

}  // namespace

Fraction squaredDistanceAt(const ExactComponent& component, const ExactBox& box,
                           const Fraction& t) {
  return squaredDistance(Slabs(component, box), t);
}

Nearest nearest(const ExactComponent& segment, const ExactBox& box) {
  const Slabs slabs(segment, box);
  const std::vector<Fraction> points = breakPoints(slabs);
  // The slope never decreases: the minimum is where it first is not negative.
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int sign = slope(slabs, points[i]);
    if (sign == 0 || (sign > 0 && i == 0)) {
      return {squaredDistance(slabs, points[i]), points[i]};
    }
    if (sign > 0) {
      // At t = -b / a, where the squared distance is (c - b^2 / a) / n^2.
      const Quadratic q = quadraticBetween(slabs, points[i - 1], points[i]);
      return {{q.a * q.c - square(q.b), q.a * square(slabs.n)}, {-q.b, q.a}};
    }
  }
  return {squaredDistance(slabs, points.back()), points.back()};
}

bool isClear(const ExactComponent& segment, const ExactBox& box, double radius) {
  return compare(nearest(segment, box).squared, Fraction{square(radius), 1.0}) > 0;
}

std::optional<Root> firstWithin(const ExactComponent& segment, const ExactBox& box, double radius) {
  return firstWithin(segment, box, radius, nearest(segment, box));
}

std::optional<Root> firstWithin(const ExactComponent& segment, const ExactBox& box, double radius,
                                const Nearest& best) {
  const Fraction limit{square(radius), 1.0};
  if (compare(best.squared, limit) > 0) {
    return std::nullopt;
  }
  if (compare(best.squared, limit) == 0) {
    return Root(best.t);
  }
  const Slabs slabs(segment, box);
  const std::vector<Fraction> points = breakPoints(slabs);
  if (compare(squaredDistance(slabs, points[0]), limit) <= 0) {
    return Root(points[0]);
  }
  // Somewhere before the minimum the distance falls through the radius. The minimum may lie between
  // two break points: the squared distance at the second one says nothing then.
  std::size_t i = 1;
  while (points[i] < best.t && compare(squaredDistance(slabs, points[i]), limit) > 0) {
    ++i;
  }
  const Quadratic q = quadraticBetween(slabs, points[i - 1], points[i]);
  const Dyadic c = q.c - limit.numerator * square(slabs.n);
  return Root(q.a, q.b, square(q.b) - q.a * c);
}

}  // namespace box_query::oracle
