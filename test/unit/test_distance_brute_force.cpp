// SPDX-License-Identifier: BSD-3-Clause
//
// Distance queries against brute force in rational numbers, which shares neither code nor method
// with the library: f is evaluated at every parameter that could be its minimum, those of all 27
// choices of the side of each axis, and the smallest wins.
#include <box_query/distance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>
#include <boost/rational.hpp>
#include <gtest/gtest.h>

namespace box_query {
namespace {

/// Without expression templates, of which that of gcd() refers to what is gone.
using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>,
                                              boost::multiprecision::et_off>;
using Rational = boost::rational<Integer>;
using Rational3 = std::array<Rational, 3>;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();
constexpr double kHuge = std::numeric_limits<double>::max();

/// A finite double as it is.
Rational rational(double x) {
  constexpr int kDigits = std::numeric_limits<double>::digits;
  int exponent = 0;
  const Integer digits(std::ldexp(std::frexp(x, &exponent), kDigits));
  exponent -= kDigits;
  return exponent < 0 ? Rational(digits, Integer(1) << -exponent) : Rational(digits << exponent);
}

/// A segment y + t v and a box |x_i - middle_i| <= half_i, in the frame of the box.
struct Problem {
  Rational3 y, v, lo, hi;
};

Problem problemOf(const Segment& segment, const AlignedBox& box) {
  Problem p;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    p.y[k] = rational(segment.start[i]);
    p.v[k] = rational(segment.end[i]) - rational(segment.start[i]);
    p.lo[k] = rational(box.min[i]);
    p.hi[k] = rational(box.max[i]);
  }
  return p;
}

/// Rotates with q^-1 p q, not with a matrix.
Rational3 rotatedBack(const Quaternion& orientation, const Rational3& p) {
  const Rational w = rational(orientation.w());
  const Rational3 u{-rational(orientation.x()), -rational(orientation.y()),
                    -rational(orientation.z())};
  const auto cross = [](const Rational3& a, const Rational3& b) {
    return Rational3{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                     a[0] * b[1] - a[1] * b[0]};
  };
  const Rational norm = w * w + u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
  const Rational3 a = cross(u, p);
  const Rational3 b = cross(u, a);
  Rational3 r;
  for (std::size_t i = 0; i < 3; ++i) {
    r[i] = p[i] + (2 * w * a[i] + 2 * b[i]) / norm;
  }
  return r;
}

Problem problemOf(const Segment& segment, const OrientedBox& box) {
  Problem p;
  Rational3 from_center, direction;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    from_center[k] = rational(segment.start[i]) - rational(box.center[i]);
    direction[k] = rational(segment.end[i]) - rational(segment.start[i]);
    p.hi[k] = rational(box.half_extents[i]);
    p.lo[k] = -p.hi[k];
  }
  p.y = rotatedBack(box.orientation, from_center);
  p.v = rotatedBack(box.orientation, direction);
  return p;
}

Rational squaredDistance(const Problem& p, const Rational& t) {
  Rational sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Rational x = p.y[i] + t * p.v[i];
    const Rational excess = x > p.hi[i] ? x - p.hi[i] : (x < p.lo[i] ? p.lo[i] - x : Rational(0));
    sum += excess * excess;
  }
  return sum;
}

struct Minimum {
  Rational t;
  Rational squared;
};

Minimum bruteForce(const Problem& p) {
  std::vector<Rational> candidates{0, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    if (p.v[i] != 0) {
      candidates.emplace_back((p.lo[i] - p.y[i]) / p.v[i]);
      candidates.emplace_back((p.hi[i] - p.y[i]) / p.v[i]);
    }
  }
  for (int sides = 0; sides < 27; ++sides) {
    Rational a = 0, b = 0;
    int rest = sides;
    for (std::size_t i = 0; i < 3; ++i, rest /= 3) {
      if (rest % 3 != 0) {
        a += p.v[i] * p.v[i];
        b += p.v[i] * (p.y[i] - (rest % 3 == 1 ? p.lo[i] : p.hi[i]));
      }
    }
    if (a != 0) {
      candidates.emplace_back(-b / a);
    }
  }
  Minimum best{0, squaredDistance(p, 0)};
  for (const Rational& t : candidates) {
    if (t < 0 || t > 1) {
      continue;
    }
    const Rational squared = squaredDistance(p, t);
    if (squared < best.squared || (squared == best.squared && t < best.t)) {
      best = {t, squared};
    }
  }
  return best;
}

/// Half way to the next double, exactly; beyond the largest one, where rounding to it ends.
Rational halfWay(double x, double towards) {
  const double next = std::nextafter(x, towards);
  const Rational beyond = std::isinf(next)
                              ? rational(x) + (rational(x) - rational(std::nextafter(x, 0.0)))
                              : rational(next);
  return (rational(x) + beyond) / 2;
}

bool isEven(double x) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof(bits));
  return (bits & 1U) == 0;
}

/// Whether x >= 0 is sqrt(squared) (power 2), or squared itself (power 1), rounded to nearest even.
bool isRounded(double x, const Rational& exact, int power) {
  const auto raised = [power](const Rational& y) { return power == 2 ? y * y : y; };
  if (std::isinf(x)) {
    return raised(halfWay(kHuge, kInf)) <= exact;
  }
  const Rational above = raised(halfWay(x, kInf));
  if (above < exact || (above == exact && !isEven(x))) {
    return false;
  }
  if (x == 0.0) {
    return exact >= 0;
  }
  const Rational below = raised(halfWay(x, -kInf));
  return below < exact || (below == exact && isEven(x));
}

/// Whether t is the largest double not greater than the first parameter within the radius.
bool isFirstWithin(const Problem& p, double t, double radius, const Minimum& minimum) {
  const Rational limit = rational(radius) * rational(radius);
  const auto isNotAfter = [&](double x) {
    return rational(x) <= minimum.t && squaredDistance(p, rational(x)) >= limit;
  };
  if (squaredDistance(p, 0) <= limit) {
    return t == 0.0;
  }
  return t >= 0.0 && t <= 1.0 && isNotAfter(t) && (t == 1.0 || !isNotAfter(std::nextafter(t, 2.0)));
}

struct Query {
  Segment segment;
  AlignedBox aligned;
  OrientedBox oriented;
};

class Source {
 public:
  explicit Source(unsigned seed) : engine_(seed) {}
  double uniform(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine_);
  }
  int integer(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(engine_); }
  Vector3 vector(double lo, double hi) {
    return {uniform(lo, hi), uniform(lo, hi), uniform(lo, hi)};
  }
  Vector3 lattice(int lo, int hi) {
    return Vector3(integer(lo, hi), integer(lo, hi), integer(lo, hi)) / 2.0;
  }
  double anyScale() { return std::ldexp(uniform(-1.0, 1.0), integer(-400, 400)); }
  /// Moves a number by a few ulp.
  double nudged(double x) {
    for (int i = integer(-3, 3); i != 0; i += i < 0 ? 1 : -1) {
      x = std::nextafter(x, i < 0 ? -kInf : kInf);
    }
    return x;
  }
  Vector3 nudged(const Vector3& x) { return {nudged(x[0]), nudged(x[1]), nudged(x[2])}; }

 private:
  std::mt19937_64 engine_;
};

Query random(Source& source) {
  Query q{{source.vector(-5, 5), source.vector(-5, 5)},
          {source.vector(-2, 0), source.vector(0, 2)},
          {source.vector(-2, 2), Quaternion::Identity(), source.vector(0, 2)}};
  q.oriented.orientation.coeffs() << source.vector(-1, 1), source.uniform(-1, 1);
  return q;
}

/// Where everything ties: touching, parallel, flat, and points.
Query lattice(Source& source) {
  const Vector3 corner = source.lattice(-3, 3);
  Query q{{source.lattice(-6, 6), source.lattice(-6, 6)},
          {corner, corner + source.lattice(0, 3)},
          {corner, Quaternion::Identity(), source.lattice(0, 3)}};
  do {
    q.oriented.orientation.coeffs() << source.lattice(-2, 2), source.integer(-1, 1) / 2.0;
  } while (q.oriented.orientation.coeffs().isZero(0.0));
  if (source.integer(0, 9) == 0) {
    q.segment.end = q.segment.start;
  }
  return q;
}

Query nudgedLattice(Source& source) {
  Query q = lattice(source);
  q.segment.start = source.nudged(q.segment.start);
  q.segment.end = source.nudged(q.segment.end);
  return q;
}

/// Shelves in map coordinates: paths along faces.
Query farAway(Source& source) {
  Query q = lattice(source);
  const Vector3 offset = source.vector(-1e6, 1e6);
  q.segment.start += offset;
  q.segment.end += offset;
  q.aligned.min += offset;
  q.aligned.max += offset;
  q.oriented.center += offset;
  return q;
}

Query nearParallel(Source& source) {
  Query q = random(source);
  q.oriented.orientation.coeffs() << 0.0, 0.0, source.uniform(-1, 1), source.uniform(-1, 1);
  q.segment.end = q.segment.start +
                  source.uniform(1, 5) * (q.oriented.orientation.normalized() * Vector3::UnitX());
  q.segment.end[2] += std::ldexp(source.uniform(-1, 1), -source.integer(0, 60));
  return q;
}

Query anyScale(Source& source) {
  const auto vector = [&] {
    return Vector3(source.anyScale(), source.anyScale(), source.anyScale());
  };
  const Vector3 a = vector();
  const Vector3 b = vector();
  Query q{{vector(), vector()},
          {a.cwiseMin(b), a.cwiseMax(b)},
          {vector(), Quaternion::Identity(), vector().cwiseAbs()}};
  do {
    q.oriented.orientation.coeffs() << vector(), source.anyScale();
  } while (q.oriented.orientation.coeffs().isZero(0.0));
  return q;
}

Query denormal(Source& source) {
  Query q = lattice(source);
  const double scale = 2.0 * kTiny;
  q.segment.start *= scale;
  q.segment.end *= scale;
  q.aligned.min *= scale;
  q.aligned.max *= scale;
  q.oriented.center *= scale;
  q.oriented.half_extents *= scale;
  return q;
}

struct Tally {
  int meeting = 0;
  int clear = 0;
  int blocked_later = 0;
};

template <typename AnyBox>
void check(const Segment& segment, const AnyBox& box, Source& source, Tally& tally) {
  const Problem p = problemOf(segment, box);
  const Minimum minimum = bruteForce(p);
  const SegmentDistance d = distance(segment, box);
  ASSERT_TRUE(isRounded(d.distance, minimum.squared, 2)) << d.distance;
  ASSERT_TRUE(isRounded(d.t, minimum.t, 1)) << d.t;
  ASSERT_FALSE(d.on_segment.hasNaN() || d.on_box.hasNaN());

  const double at_distance = std::min(d.distance, kHuge);
  for (const double radius :
       {0.0, at_distance, std::nextafter(at_distance, 0.0), source.uniform(0.0, 2.0) * at_distance,
        std::ldexp(source.uniform(0.0, 1.0), source.integer(-3, 3))}) {
    if (!std::isfinite(radius)) {
      continue;
    }
    SCOPED_TRACE(testing::Message() << "radius " << radius);
    const bool clear = minimum.squared > rational(radius) * rational(radius);
    ASSERT_EQ(isClear(segment, box, radius), clear);
    const double t = blockedAt(segment, box, radius);
    if (clear) {
      ASSERT_EQ(t, kInf);
    } else if (radius == 0.0) {
      ASSERT_TRUE(isRounded(t, minimum.t, 1)) << t;
    } else {
      ASSERT_TRUE(isFirstWithin(p, t, radius, minimum)) << t;
    }
    tally.clear += clear ? 1 : 0;
    tally.blocked_later += !clear && t > 0.0 ? 1 : 0;
  }
  tally.meeting += minimum.squared == 0 ? 1 : 0;
}

struct Family {
  const char* name;
  Query (*query)(Source&);
  int queries;
};

class DistanceFamily : public testing::TestWithParam<Family> {};

TEST_P(DistanceFamily, AgreesWithBruteForce) {
  const int queries = GetParam().queries;
  Source source(20);
  Tally tally;
  for (int i = 0; i < queries; ++i) {
    const Query q = GetParam().query(source);
    SCOPED_TRACE(testing::Message()
                 << std::hexfloat << "query " << i << ": " << q.segment.start.transpose() << " to "
                 << q.segment.end.transpose());
    check(q.segment, q.aligned, source, tally);
    check(q.segment, q.oriented, source, tally);
    if (HasFatalFailure()) {
      return;
    }
  }
  EXPECT_GT(tally.meeting, queries / 60);
  EXPECT_GT(tally.clear, queries);
  EXPECT_GT(tally.blocked_later, queries / 10);
}

// Rational numbers of mixed scales have thousands of bits: fewer of those.
INSTANTIATE_TEST_SUITE_P(
    , DistanceFamily,
    testing::Values(Family{"random", &random, 150}, Family{"lattice", &lattice, 1000},
                    Family{"nudged_lattice", &nudgedLattice, 40},
                    Family{"far_away", &farAway, 1000}, Family{"near_parallel", &nearParallel, 150},
                    Family{"any_scale", &anyScale, 20}, Family{"denormal", &denormal, 300}),
    [](const auto& param) { return std::string(param.param.name); });

}  // namespace
}  // namespace box_query
