// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The oracle against a second method in other arithmetic, on inputs that tie and nearly tie.
#include "reference/oracle.h"
#include "reference/oracle/second_method.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace box_query {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// Small numbers, so that nearly everything touches something; some an ulp or two away, some of
/// quite another size.
class HostileInput {
 public:
  explicit HostileInput(std::uint64_t seed) : engine_(seed) {}

  double lattice(int limit) {
    return 0.5 * static_cast<double>(below(4 * static_cast<unsigned>(limit) + 1)) - limit;
  }
  double number(int limit) {
    double value = lattice(limit);
    if (style_ > 0) {
      for (unsigned nudges = below(6); nudges > 3; --nudges) {
        value = std::nextafter(value, below(2) == 0 ? kInf : -kInf);
      }
    }
    if (style_ == 2 && below(4) == 0) {
      value = std::ldexp(value, static_cast<int>(below(2001)) - 1000);
    }
    return value;
  }
  Vector3 vector(int limit) {
    const double x = number(limit);
    const double y = number(limit);
    return {x, y, number(limit)};
  }
  Quaternion quaternion() {
    for (;;) {
      const Vector3 u = below(3) == 0 ? Vector3::Zero() : vector(1);
      Quaternion q(number(1), u.x(), u.y(), u.z());
      if ((q.coeffs().array() != 0.0).any()) {
        return q;
      }
    }
  }
  OrientedBox orientedBox() {
    const Vector3 center = vector(2);
    const Quaternion orientation = quaternion();
    return {center, orientation, vector(2).cwiseAbs()};
  }
  AlignedBox alignedBox() {
    const Vector3 a = vector(2);
    const Vector3 b = vector(2);
    return {a.cwiseMin(b), a.cwiseMax(b)};
  }
  double radius() { return std::abs(number(3)); }
  /// 0: on the lattice, 1: nudged, 2: of mixed sizes.
  void setStyle(unsigned style) { style_ = style; }

 private:
  unsigned below(unsigned n) { return static_cast<unsigned>(engine_() % n); }

  std::mt19937_64 engine_;
  unsigned style_ = 0;
};

struct Tally {
  int hits = 0;
  int queries = 0;
};

const Vector3& startOf(const Segment& segment) {
  return segment.start;
}
const Vector3& startOf(const Ray& ray) {
  return ray.origin;
}
const Vector3& startOf(const Line& line) {
  return line.origin;
}

template <typename Component, typename AnyBox>
void expectSameInterval(const Component& component, const AnyBox& box, Tally& tally) {
  const oracle::ExactComponent exact(component);
  const oracle::Interval found = oracle::interval(exact, box);
  const second_method::RationalComponent rational(component);
  const second_method::RationalBox rational_box(box);
  ASSERT_EQ(found.hit(), second_method::intersects(rational, rational_box));
  ++tally.queries;
  tally.hits += found.hit() ? 1 : 0;
  if (exact.isPoint()) {
    ASSERT_EQ(found.num_points, found.hit() ? 1 : 0);
    ASSERT_TRUE(found.entered.empty() && found.left.empty());
    return;
  }
  const second_method::Interval expected = second_method::interval(rational, rational_box);
  ASSERT_EQ(found.hit(), expected.hit);
  if (found.hit()) {
    ASSERT_EQ(found.enter.infinity, 0);
    ASSERT_EQ(found.exit.infinity, 0);
    ASSERT_EQ(found.enter.value.toRational(), expected.enter);
    ASSERT_EQ(found.exit.value.toRational(), expected.exit);
    ASSERT_EQ(found.num_points, expected.enter == expected.exit ? 1 : 2);
    ASSERT_EQ(found.entered, expected.entered);
    ASSERT_EQ(found.left, expected.left);
    if (exact.kind != oracle::Kind::kLine) {
      const Segment start{startOf(component), startOf(component)};
      ASSERT_EQ(found.started_inside, oracle::interval(start, box).hit());
    }
  }
}

Line asLine(const Segment& s) {
  return {s.start, s.end};
}
Ray asRay(const Segment& s) {
  return {s.start, s.end};
}

class OracleOn : public testing::TestWithParam<unsigned> {
 protected:
  void SetUp() override { input_.setStyle(GetParam()); }
  int count() const {
    const int counts[] = {12000, 3000, 1000};
    return counts[GetParam()];
  }

  HostileInput input_{20240607};
};

TEST_P(OracleOn, IntervalIsThatOfTheSecondMethod) {
  Tally tally;
  for (int i = 0; i < count() && !HasFatalFailure(); ++i) {
    SCOPED_TRACE(i);
    const Segment segment{input_.vector(3), input_.vector(3)};
    const OrientedBox oriented = input_.orientedBox();
    const AlignedBox aligned = input_.alignedBox();
    expectSameInterval(asLine(segment), oriented, tally);
    expectSameInterval(asLine(segment), aligned, tally);
    expectSameInterval(asRay(segment), oriented, tally);
    expectSameInterval(asRay(segment), aligned, tally);
    expectSameInterval(segment, oriented, tally);
    expectSameInterval(segment, aligned, tally);
  }
  EXPECT_GT(tally.hits, tally.queries / 10);
  EXPECT_LT(tally.hits, tally.queries * 9 / 10);
}

template <typename AnyBox>
void expectSameDistance(const Segment& segment, const AnyBox& box, Tally& tally) {
  const oracle::Nearest found = oracle::nearest(segment, box);
  const oracle::Interval inside = oracle::interval(segment, box);
  ++tally.queries;
  if (inside.hit()) {
    ++tally.hits;
    ASSERT_EQ(found.squared.numerator.sign(), 0);
    ASSERT_EQ(compare(found.t, inside.enter.value), 0);
    return;
  }
  const second_method::Nearest expected = second_method::nearest(
      second_method::RationalComponent(segment), second_method::RationalBox(box));
  ASSERT_EQ(found.squared.toRational(), expected.squared);
  ASSERT_EQ(found.t.toRational(), expected.t);
}

TEST_P(OracleOn, DistanceIsThatOfTheSecondMethod) {
  Tally tally;
  for (int i = 0; i < count() && !HasFatalFailure(); ++i) {
    SCOPED_TRACE(i);
    const Segment segment{input_.vector(3), input_.vector(3)};
    expectSameDistance(segment, input_.orientedBox(), tally);
    expectSameDistance(segment, input_.alignedBox(), tally);
  }
  EXPECT_GT(tally.hits, tally.queries / 10);
  EXPECT_LT(tally.hits, tally.queries * 9 / 10);
}

/// Sign of x - root, from the distance at x alone: before the minimum the distance falls strictly.
int signByDistance(const Segment& segment, const OrientedBox& box, double radius, double x) {
  const oracle::Fraction at{x, 1.0};
  const oracle::Fraction limit{oracle::square(radius), 1.0};
  if (compare(oracle::nearest(segment, box).t, at) < 0) {
    return 1;
  }
  return -compare(oracle::squaredDistanceAt(segment, box, at), limit);
}

TEST_P(OracleOn, FirstPlaceWithinTheRadiusSplitsTheSegment) {
  int roots = 0;
  int exact_roots = 0;
  for (int i = 0; i < count(); ++i) {
    SCOPED_TRACE(i);
    const Segment segment{input_.vector(3), input_.vector(3)};
    const OrientedBox box = input_.orientedBox();
    const double radius = input_.radius();
    const auto root = oracle::firstWithin(segment, box, radius);
    ASSERT_EQ(oracle::isClear(segment, box, radius), !root.has_value());
    if (!root) {
      continue;
    }
    const oracle::Fraction limit{oracle::square(radius), 1.0};
    if (compare(oracle::squaredDistanceAt(segment, box, {}), limit) <= 0) {
      ASSERT_EQ(compare(oracle::Root(0.0), *root), 0);
      continue;
    }
    ++roots;
    for (int k = 0; k <= 8; ++k) {
      const double x = 0.125 * k;
      ASSERT_EQ(compare(oracle::Root(x), *root), signByDistance(segment, box, radius, x)) << x;
      exact_roots += compare(oracle::Root(x), *root) == 0 ? 1 : 0;
    }
    // Next to the root, found by bisection.
    double low = 0.0;
    double high = 1.0;
    for (double middle = 0.5; low < middle && middle < high; middle = 0.5 * (low + high)) {
      (compare(oracle::Root(middle), *root) <= 0 ? low : high) = middle;
    }
    ASSERT_LE(signByDistance(segment, box, radius, low), 0);
    ASSERT_GE(signByDistance(segment, box, radius, high), 0);
    ASSERT_LE(oracle::stepsBefore(low, *root, 5), 1);
  }
  EXPECT_GT(roots, count() / 100);
  if (GetParam() == 0) {
    EXPECT_GT(exact_roots, 100);
  }
}

TEST_P(OracleOn, RootsCompareAsTheirHighPrecisionValues) {
  const auto value = [](const oracle::Root& r) {
    constexpr mp_bitcnt_t kBits = 20000;
    const mpf_class a(r.a.toRational(), kBits);
    const mpf_class b(r.b.toRational(), kBits);
    const mpf_class discriminant(r.discriminant.toRational(), kBits);
    return mpf_class((-b - sqrt(discriminant)) / a, kBits);
  };
  int ties = 0;
  int compared = 0;
  std::optional<oracle::Root> previous;
  for (int i = 0; i < 3 * count(); ++i) {
    const Segment segment{input_.vector(3), input_.vector(3)};
    // The same box twice, by different numbers.
    OrientedBox box = input_.orientedBox();
    const auto p = oracle::firstWithin(segment, box, 0.5);
    box.orientation.coeffs() *= -2.0;
    const auto same = oracle::firstWithin(segment, box, 0.5);
    ASSERT_EQ(p.has_value(), same.has_value());
    if (!p) {
      continue;
    }
    ASSERT_EQ(compare(*p, *same), 0);
    if (previous) {
      const int sign = compare(*p, *previous);
      ASSERT_EQ(compare(*previous, *p), -sign);
      const mpf_class difference = value(*p) - value(*previous);
      if (sign == 0) {
        ++ties;
        ASSERT_LT(abs(difference), mpf_class("1e-3000"));
      } else {
        ++compared;
        ASSERT_EQ(sgn(difference), sign);
      }
    }
    previous = p;
  }
  EXPECT_GT(ties, 10);
  EXPECT_GT(compared, 100);
}

std::string styleName(const testing::TestParamInfo<unsigned>& info) {
  const char* const names[] = {"Lattice", "Nudged", "MixedSizes"};
  return names[info.param];
}

INSTANTIATE_TEST_SUITE_P(Inputs, OracleOn, testing::Values(0U, 1U, 2U), styleName);

}  // namespace
}  // namespace box_query
