// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/distance_exact.h"

#include "exact/rounding.h"

#include <cmath>

namespace box_query::exact {
namespace {

/// Signed excess of the point at t over the slab of an axis, times t.den.
Dyadic excess(const Slabs& slabs, std::size_t axis, const Parameter& t) {
  const Dyadic x = slabs.direction[axis] * t.num;
  Dyadic over = x - slabs.above[axis] * t.den;
  if (over.sign() > 0) {
    return over;
  }
  const Dyadic under = x - slabs.below[axis] * t.den;
  return under.sign() < 0 ? under : Dyadic();
}

/// The sign of f'(t).
int slopeSign(const Slabs& slabs, const Parameter& t) {
  Dyadic slope;
  for (std::size_t i = 0; i < 3; ++i) {
    if (slabs.direction[i].sign() != 0) {
      slope += slabs.direction[i] * excess(slabs, i, t);
    }
  }
  return slope.sign();
}

/// f(t) in the world.
Ratio squaredDistance(const SegmentAtBox& segment, const Parameter& t) {
  Dyadic sum;
  for (std::size_t i = 0; i < 3; ++i) {
    const Dyadic e = excess(segment.slabs, i, t);
    sum += e * e;
  }
  return {sum, t.den * t.den * segment.stretch_squared};
}

/// Shrinks (before, after] until no break point lies inside. `isBefore` says of a parameter whether
/// the one looked for comes later; it is false at `after`.
template <typename Predicate>
void narrowToPiece(const Slabs& slabs, Parameter& before, Parameter& after,
                   const Predicate& isBefore) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (slabs.direction[i].sign() == 0) {
      continue;
    }
    for (const Dyadic* face : {&slabs.below[i], &slabs.above[i]}) {
      Parameter t{*face, slabs.direction[i]};
      if (t.den.sign() < 0) {
        t = {-t.num, -t.den};
      }
      if (compare(before, t) < 0 && compare(t, after) < 0) {
        (isBefore(t) ? before : after) = t;
      }
    }
  }
}

/// f(t) = a t^2 + 2 b t + c, stretched, on one piece.
struct Quadratic {
  Dyadic a;
  Dyadic b;
  Dyadic c;
};

/// @pre no break point lies between the two parameters
Quadratic quadraticBetween(const Slabs& slabs, const Parameter& before, const Parameter& after) {
  const Parameter middle{before.num * after.den + after.num * before.den,
                         (before.den * after.den).scaled(1)};
  Quadratic f;
  for (std::size_t i = 0; i < 3; ++i) {
    const int side = excess(slabs, i, middle).sign();
    if (side != 0) {
      const Dyadic& d = slabs.direction[i];
      const Dyadic& face = side > 0 ? slabs.above[i] : slabs.below[i];
      f.a += d * d;
      f.b -= d * face;
      f.c += face * face;
    }
  }
  return f;
}

/// Smallest parameter in [0, 1] where f is smallest: where f' first is not negative.
Parameter firstMinimum(const Slabs& slabs) {
  Parameter before{0.0, 1.0};
  if (slopeSign(slabs, before) >= 0) {
    return before;
  }
  Parameter after{1.0, 1.0};
  if (slopeSign(slabs, after) < 0) {
    return after;
  }
  narrowToPiece(slabs, before, after, [&](const Parameter& t) { return slopeSign(slabs, t) < 0; });
  // On this piece f' = 2 (a t + b) rises from a negative value, so that a > 0.
  const Quadratic f = quadraticBetween(slabs, before, after);
  return {-f.b, f.a};
}

/// floor(log2 x) for x > 0.
int topBit(const Dyadic& x) {
  return static_cast<int>(boost::multiprecision::msb(x.mantissa())) + x.exponent();
}

/// The sign of a - sqrt(b) + sqrt(c).
int signWithRoots(const Dyadic& a, const Dyadic& b, const Dyadic& c) {
  const int roots = compare(c, b);
  if (a.sign() * roots >= 0) {
    return a.sign() != 0 ? a.sign() : roots;
  }
  // The sign of a^2 - (sqrt(c) - sqrt(b))^2 = (a^2 - b - c) + 2 sqrt(b c) says which one is larger.
  const Dyadic rest = a * a - b - c;
  const int larger =
      rest.sign() >= 0 && (b * c).sign() > 0
          ? 1
          : (rest.sign() >= 0 ? rest.sign() : compare((b * c).scaled(2), rest * rest));
  return larger * a.sign();
}

}  // namespace

SegmentAtBox segmentAtBox(const Segment& segment, const AlignedBox& box) {
  SegmentAtBox s;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const Dyadic start = segment.start[i];
    s.slabs.below[axis] = box.min[i] - start;
    s.slabs.above[axis] = box.max[i] - start;
    s.slabs.direction[axis] = segment.end[i] - start;
  }
  s.stretch_squared = 1.0;
  return s;
}

SegmentAtBox segmentAtBox(const Segment& segment, const OrientedBox& box) {
  const Dyadic w = box.orientation.w();
  const Dyadic x = box.orientation.x();
  const Dyadic y = box.orientation.y();
  const Dyadic z = box.orientation.z();
  const Dyadic ww = w * w, xx = x * x, yy = y * y, zz = z * z;
  const Dyadic xy = (x * y).scaled(1), xz = (x * z).scaled(1), yz = (y * z).scaled(1);
  const Dyadic wx = (w * x).scaled(1), wy = (w * y).scaled(1), wz = (w * z).scaled(1);
  const Dyadic n = ww + xx + yy + zz;
  const Dyadic axes[3][3] = {{ww + xx - yy - zz, xy + wz, xz - wy},
                             {xy - wz, ww - xx + yy - zz, yz + wx},
                             {xz + wy, yz - wx, ww - xx - yy + zz}};
  Dyadic offset[3];
  Dyadic direction[3];
  for (int j = 0; j < 3; ++j) {
    const Dyadic start = segment.start[j];
    offset[j] = start - box.center[j];
    direction[j] = segment.end[j] - start;
  }
  SegmentAtBox s;
  for (std::size_t i = 0; i < 3; ++i) {
    const Dyadic* axis = axes[i];
    const Dyadic position = axis[0] * offset[0] + axis[1] * offset[1] + axis[2] * offset[2];
    const Dyadic extent = n * box.half_extents[static_cast<int>(i)];
    s.slabs.below[i] = -extent - position;
    s.slabs.above[i] = extent - position;
    s.slabs.direction[i] = axis[0] * direction[0] + axis[1] * direction[1] + axis[2] * direction[2];
  }
  s.stretch_squared = n * n;
  return s;
}

SegmentAtBox segmentAtBox(const Segment& segment, const Box& box) {
  if (const auto* aligned = std::get_if<AlignedBox>(&box)) {
    return segmentAtBox(segment, *aligned);
  }
  return segmentAtBox(segment, *std::get_if<OrientedBox>(&box));
}

Nearest nearest(const SegmentAtBox& segment) {
  const Parameter t = firstMinimum(segment.slabs);
  return {t, squaredDistance(segment, t)};
}

int compare(const Root& a, const Root& b) {
  return signWithRoots(b.s * a.p - a.s * b.p, b.s * b.s * a.q, a.s * a.s * b.q);
}

double roundedDown(const Root& root) {
  if (root.p.sign() <= 0) {
    return 0.0;
  }
  const int k = -topBit(root.p);  // neither overflow nor harmful underflow for p in [1, 2)
  const Dyadic p = root.p.scaled(k);
  const Dyadic q = root.q.scaled(2 * k);
  const Dyadic s = root.s.scaled(k);
  // (p - sqrt(q)) / s without cancellation, good to a few ulp; its neighbours are decided exactly.
  double t = roundedQuotient(p * p - q, s * (p + roundedSqrt(q, 1.0)));
  const auto isNotAfter = [&](double candidate) {
    const Dyadic rest = p - s * candidate;
    return rest.sign() >= 0 && q <= rest * rest;
  };
  while (!isNotAfter(t)) {
    t = std::nextafter(t, 0.0);
  }
  for (double next = std::nextafter(t, 1.0); next > t && isNotAfter(next);
       next = std::nextafter(t, 1.0)) {
    t = next;
  }
  return t;
}

std::optional<Root> firstWithin(const SegmentAtBox& segment, double radius) {
  const Ratio limit{Dyadic(radius) * radius, 1.0};
  const auto isOutside = [&](const Parameter& t) {
    return compare(squaredDistance(segment, t), limit) > 0;
  };
  Parameter before{0.0, 1.0};
  if (!isOutside(before)) {
    return Root{0.0, 0.0, 1.0};
  }
  Parameter after = firstMinimum(segment.slabs);
  if (isOutside(after)) {
    return std::nullopt;
  }
  narrowToPiece(segment.slabs, before, after, isOutside);
  if (compare(squaredDistance(segment, after), limit) == 0) {
    return Root{after.num, 0.0, after.den};
  }
  const Quadratic f = quadraticBetween(segment.slabs, before, after);
  const Dyadic c = f.c - limit.num * segment.stretch_squared;
  return Root{-f.b, f.b * f.b - f.a * c, f.a};
}

}  // namespace box_query::exact
