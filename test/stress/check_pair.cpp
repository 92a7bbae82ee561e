// SPDX-License-Identifier: BSD-3-Clause
#include "stress/check_pair.h"

#include <box_query/distance.h>
#include <box_query/intersection.h>

#include <algorithm>
#include <cmath>
#include <variant>

namespace box_query::stress {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

std::string describe(const Sample& sample) {
  return hex(sample.box) + " origin " + hex(sample.origin) + " direction " + hex(sample.direction) +
         " end " + hex(sample.end);
}

const char* name(oracle::Kind kind) {
  switch (kind) {
    case oracle::Kind::kLine:
      return "Line";
    case oracle::Kind::kRay:
      return "Ray";
    default:
      return "Segment";
  }
}

/// Notes what is wrong about the answers to one sample.
class Judge {
 public:
  Judge(const Sample& sample, Tally& tally) : sample_(sample), tally_(tally) {}

  void expect(bool right, const std::string& query, const char* what, double got, double about) {
    if (!right) {
      tally_.fail(describe(sample_),
                  query + ": " + what + " is " + hex(got) + ", expected about " + hex(about));
    }
  }
  Tally& tally() { return tally_; }

 private:
  const Sample& sample_;
  Tally& tally_;
};

double approximate(const oracle::Bound& bound) {
  return bound.infinity != 0 ? bound.infinity * kInf : oracle::approximate(bound.value);
}

void judgeParameter(Judge& judge, const std::string& query, const char* what, double got,
                    const oracle::Bound& exact) {
  judge.tally().worst_t = std::max(judge.tally().worst_t, oracle::ulpError(got, exact));
  judge.expect(oracle::isCorrectlyRounded(got, exact), query, what, got, approximate(exact));
}

/// A range is a square root with the sign of its parameter; infinite with it, 0 for a point.
void judgeRange(Judge& judge, const std::string& query, const char* what, double got,
                const oracle::Bound& t, const oracle::ExactComponent& component) {
  if (component.isPoint() || t.infinity != 0) {
    const double expected = component.isPoint() ? 0.0 : t.infinity * kInf;
    judge.expect(got == expected, query, what, got, expected);
    return;
  }
  const oracle::Fraction squared = oracle::squaredRange(t.value, component);
  const double sign = t.value.numerator.sign() < 0 ? -1.0 : 1.0;
  judge.tally().worst_range =
      std::max(judge.tally().worst_range, oracle::ulpErrorSqrt(sign * got, squared));
  judge.expect(oracle::isCorrectlyRoundedSqrt(sign * got, squared), query, what, got,
               sign * std::sqrt(oracle::approximate(squared)));
}

bool contains(const Box& box, const Vector3& point) {
  const auto* aligned = std::get_if<AlignedBox>(&box);
  return aligned == nullptr || ((aligned->min.array() <= point.array()).all() &&
                                (point.array() <= aligned->max.array()).all());
}

void judgePoint(Judge& judge, const std::string& query, const char* what, const Vector3& got,
                const oracle::ExactPoint& exact, double scale) {
  const double error = oracle::pointError(got, exact, scale);
  judge.tally().worst_point = std::max(judge.tally().worst_point, error);
  judge.expect(error <= kPointUlps, query, what, error, 0.0);
}

template <typename Component, typename AnyBox>
void judgeIntersection(const Component& component, const AnyBox& box, const Box& any_box,
                       const oracle::ExactBox& exact_box, Judge& judge) {
  const oracle::ExactComponent exact_component(component);
  const oracle::Interval exact = oracle::interval(exact_component, exact_box);
  ++judge.tally().queries;
  judge.tally().hits += exact.hit() ? 1 : 0;
  const std::string kind = name(exact_component.kind);

  const bool hit = testIntersection(component, box);
  judge.expect(hit == exact.hit(), "testIntersection(" + kind + ")", "hit", hit, exact.hit());

  const Intersection found = findIntersection(component, box);
  const std::string find = "findIntersection(" + kind + ")";
  judge.expect(found.num_points == exact.num_points, find, "num_points", found.num_points,
               exact.num_points);
  const IntersectionRanges ranges = findRanges(component, box);
  const std::string find_ranges = "findRanges(" + kind + ")";
  if (!exact.hit()) {
    judge.expect(found.t_enter == kInf && found.t_exit == -kInf, find, "t_enter of a miss",
                 found.t_enter, kInf);
    judge.expect(ranges.enter == kInf && ranges.exit == -kInf, find_ranges, "enter of a miss",
                 ranges.enter, kInf);
    judge.expect(found.entered.empty() && found.left.empty() && !found.started_inside, find,
                 "faces of a miss", found.entered.bits(), 0.0);
    return;
  }
  judgeParameter(judge, find, "t_enter", found.t_enter, exact.enter);
  judgeParameter(judge, find, "t_exit", found.t_exit, exact.exit);
  judge.expect(found.entered == exact.entered, find, "entered", found.entered.bits(),
               exact.entered.bits());
  judge.expect(found.left == exact.left, find, "left", found.left.bits(), exact.left.bits());
  judge.expect(found.started_inside == exact.started_inside, find, "started_inside",
               found.started_inside, exact.started_inside);
  judgeRange(judge, find_ranges, "enter", ranges.enter, exact.enter, exact_component);
  judgeRange(judge, find_ranges, "exit", ranges.exit, exact.exit, exact_component);

  // Of a point every parameter is the same place: that at 0, the default of a Fraction.
  const double scale =
      std::max(oracle::largestCoordinate(component), oracle::largestCoordinate(box));
  const auto place = [&exact_component](const oracle::Bound& t) {
    return oracle::pointAt(exact_component, t.infinity != 0 ? oracle::Fraction{} : t.value);
  };
  judgePoint(judge, find, "error of enter_point", found.enter_point, place(exact.enter), scale);
  judgePoint(judge, find, "error of exit_point", found.exit_point, place(exact.exit), scale);
  judge.expect(contains(any_box, found.enter_point) && contains(any_box, found.exit_point), find,
               "point in the box", 0.0, 1.0);
}

void checkRadius(const Segment& segment, const Box& box, const oracle::ExactComponent& component,
                 const oracle::ExactBox& exact_box, const oracle::Nearest& nearest, double radius,
                 Judge& judge) {
  const auto root = oracle::firstWithin(component, exact_box, radius, nearest);
  const std::string argument = "(radius " + hex(radius) + ")";
  const bool clear = std::visit([&](const auto& b) { return isClear(segment, b, radius); }, box);
  judge.expect(clear == !root, "isClear" + argument, "clear", clear, !root);
  const double at = std::visit([&](const auto& b) { return blockedAt(segment, b, radius); }, box);
  const std::string blocked = "blockedAt" + argument;
  if (!root) {
    judge.expect(at == kInf, blocked, "parameter", at, kInf);
  } else if (radius == 0.0) {
    judgeParameter(judge, blocked, "parameter", at, oracle::Bound{0, nearest.t});
  } else {
    const int steps = oracle::stepsBefore(at, *root, kBlockedSteps + 1);
    judge.tally().worst_blocked = std::max(judge.tally().worst_blocked, steps);
    judge.expect(steps >= 0 && steps <= kBlockedSteps && at >= 0.0, blocked, "parameter", at,
                 oracle::approximate(*root));
  }
}

}  // namespace

void checkIntersection(const Sample& sample, oracle::Kind kind, Tally& tally) {
  Judge judge(sample, tally);
  const oracle::ExactBox exact_box(sample.box);
  const auto check = [&](const auto& component) {
    std::visit(
        [&](const auto& box) { judgeIntersection(component, box, sample.box, exact_box, judge); },
        sample.box);
  };
  switch (kind) {
    case oracle::Kind::kLine:
      return check(sample.line());
    case oracle::Kind::kRay:
      return check(sample.ray());
    default:
      check(sample.segment());
  }
}

void checkIntersections(const Sample& sample, Tally& tally) {
  for (const oracle::Kind kind :
       {oracle::Kind::kLine, oracle::Kind::kRay, oracle::Kind::kSegment}) {
    checkIntersection(sample, kind, tally);
  }
}

void checkDistances(const Sample& sample, Random& random, Tally& tally) {
  Judge judge(sample, tally);
  const Segment segment = sample.segment();
  const oracle::ExactComponent component(segment);
  const oracle::ExactBox exact_box(sample.box);
  const oracle::Nearest exact = oracle::nearest(component, exact_box);
  ++tally.queries;
  tally.hits += exact.squared.numerator.sign() == 0 ? 1 : 0;

  const SegmentDistance found =
      std::visit([&](const auto& box) { return distance(segment, box); }, sample.box);
  tally.worst_distance =
      std::max(tally.worst_distance, oracle::ulpErrorSqrt(found.distance, exact.squared));
  judge.expect(oracle::isCorrectlyRoundedSqrt(found.distance, exact.squared), "distance",
               "distance", found.distance, std::sqrt(oracle::approximate(exact.squared)));
  judgeParameter(judge, "distance", "t", found.t, oracle::Bound{0, exact.t});
  const double scale =
      std::max(oracle::largestCoordinate(segment), oracle::largestCoordinate(sample.box));
  judgePoint(judge, "distance", "error of on_segment", found.on_segment,
             oracle::pointAt(component, exact.t), scale);
  judgePoint(judge, "distance", "error of on_box", found.on_box,
             oracle::nearestOnBox(component, exact_box, exact.t), scale);
  judge.expect(contains(sample.box, found.on_box), "distance", "on_box in the box", 0.0, 1.0);

  // A radius of zero, one at the distance, and one that the segment comes within on its way.
  const double at_distance = random.nudged(found.distance, 1);
  const double size = found.distance > 0.0 ? found.distance : scale * random.magnitude(-20, 0);
  for (const double radius : {0.0, at_distance, size * random.uniform(0.5, 4.0)}) {
    if (radius >= 0.0 && std::isfinite(radius)) {
      checkRadius(segment, sample.box, component, exact_box, exact, radius, judge);
    }
  }
}

}  // namespace box_query::stress
