// SPDX-License-Identifier: BSD-3-Clause
#include "stress/check_scene.h"

#include "reference/oracle.h"

#include <box_query/distance.h>
#include <box_query/scene.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace box_query::stress {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

bool same(const Vector3& a, const Vector3& b) {
  for (int i = 0; i < 3; ++i) {
    if (a[i] != b[i] && !(std::isnan(a[i]) && std::isnan(b[i]))) {
      return false;
    }
  }
  return true;
}

bool same(const Hit& a, const Hit& b) {
  return a.hit == b.hit && a.box == b.box && a.range == b.range && a.t == b.t &&
         (a.exit_range == b.exit_range || !a.hit) && a.started_inside == b.started_inside &&
         a.entered == b.entered && same(a.point, b.point) && same(a.normal, b.normal);
}

Box movedBy(const Box& any, const Vector3& by) {
  if (const auto* box = std::get_if<AlignedBox>(&any)) {
    return AlignedBox{box->min + by, box->max + by};
  }
  OrientedBox box = std::get<OrientedBox>(any);
  box.center += by;
  return box;
}

/// A scene of these boxes: new, or made from one in which they had other numbers, some were
/// elsewhere and some were not there.
Scene sceneOf(const std::vector<Box>& boxes, Random& random) {
  if (random.chance(0.5)) {
    return Scene(boxes);
  }
  std::vector<Box> before;
  std::vector<std::size_t> previous(boxes.size(), kNoBox);
  for (std::size_t i = boxes.size(); i-- > 0;) {
    if (random.chance(0.05)) {
      before.push_back(boxes[i]);  // gone since
    }
    if (random.chance(0.95)) {
      previous[i] = before.size();
      before.push_back(random.chance(0.3) ? movedBy(boxes[i], random.uniformVector(-1.0, 1.0))
                                          : boxes[i]);
    }
  }
  return Scene(before).updated(boxes, previous);
}

/// One scene, as the library and as the oracle have it.
class SceneCheck {
 public:
  SceneCheck(const SceneSample& sample, Random& random, Tally& tally)
      : sample_(sample), random_(random), tally_(tally), scene_(sceneOf(sample.boxes, random)) {
    exact_boxes_.assign(sample.boxes.begin(), sample.boxes.end());
    if (random.chance(0.4)) {
      mask_.emplace(sample.boxes.size());
      for (std::size_t i = 0; i < sample.boxes.size(); ++i) {
        mask_->set(i, random.chance(0.7));
      }
    }
  }

  void checkAll() {
    for (const Sample& component : sample_.components) {
      component_ = &component;
      checkCasts(component.ray());
      checkFindAll(component.line(), "findAll(Line)");
      checkFindAll(component.ray(), "findAll(Ray)");
      checkFindAll(component.segment(), "findAll(Segment)");
      checkSegment(component.segment());
    }
    checkCastsTogether();
    checkSegmentsTogether();
  }

 private:
  using Intervals = std::vector<oracle::Interval>;

  const BoxMask* mask() const { return mask_ ? &*mask_ : nullptr; }
  bool looksAt(std::size_t i) const { return !mask_ || (*mask_)[i]; }

  void expect(bool right, const std::string& query, double got, double expected) {
    if (right) {
      return;
    }
    std::string input = "origin " + hex(component_->origin) + " direction " +
                        hex(component_->direction) + " end " + hex(component_->end);
    for (std::size_t i = 0; i < sample_.boxes.size() && i < 40; ++i) {
      input += "\n      " + std::to_string(i) + (looksAt(i) ? " " : " (masked) ") +
               hex(sample_.boxes[i]);
    }
    tally_.fail(input, query + " is " + hex(got) + ", expected about " + hex(expected));
  }

  void checkCasts(const Ray& ray) {
    const oracle::ExactComponent exact(ray);
    Intervals intervals(exact_boxes_.size());
    std::size_t first = kNoBox;
    for (std::size_t i = 0; i < exact_boxes_.size(); ++i) {
      if (looksAt(i)) {
        intervals[i] = oracle::interval(exact, exact_boxes_[i]);
        if (intervals[i].hit() &&
            (first == kNoBox || compare(intervals[i].enter, intervals[first].enter) < 0)) {
          first = i;
        }
      }
    }
    ++tally_.queries;
    tally_.hits += first != kNoBox ? 1 : 0;
    const Hit unlimited = scene_.cast(ray, kInf, mask());
    checkHit(ray, exact, unlimited, first, intervals);
    expect(scene_.castAny(ray, kInf, mask()) == (first != kNoBox), "castAny", first == kNoBox, 0.0);

    double limit =
        first == kNoBox ? random_.uniform(0.0, 10.0) : random_.nudged(unlimited.range, 1);
    if (random_.chance(0.2)) {
      limit *= random_.uniform(0.0, 2.0);
    }
    if (!(limit >= 0.0)) {
      limit = 0.0;
    }
    const bool within = first != kNoBox && isWithin(intervals[first].enter, exact, limit);
    const std::string argument = "(max_range " + hex(limit) + ")";
    const Hit limited = scene_.cast(ray, limit, mask());
    expect(limited.hit == within && limited.box == (within ? first : kNoBox), "cast" + argument,
           limited.hit, within);
    expect(!within || (limited.range == unlimited.range && limited.t == unlimited.t),
           "range of cast" + argument, limited.range, unlimited.range);
    expect(scene_.castAny(ray, limit, mask()) == within, "castAny" + argument, !within, within);
    const ClosestBox closest = scene_.castClosest(ray, limit, mask());
    expect(closest.hit == within && closest.box == limited.box, "castClosest" + argument,
           closest.hit, within);
    expect(closest.t_lower <= limited.t && limited.t <= closest.t_upper,
           "enclosure of castClosest" + argument, closest.t_lower, limited.t);
  }

  /// Rays that are cast together, each with limits of its own, against each alone.
  void checkCastsTogether() {
    std::vector<Ray> rays;
    std::vector<double> limits;
    for (const Sample& component : sample_.components) {
      const double range = scene_.cast(component.ray(), kInf, mask()).range;
      for (const double limit : {kInf, random_.nudged(range, 1), random_.uniform(0.0, 10.0)}) {
        rays.push_back(component.ray());
        limits.push_back(limit >= 0.0 ? limit : 0.0);
      }
    }
    const std::size_t count = rays.size();
    const MaxRanges each(limits.data());
    std::vector<Hit> hits(count);
    std::vector<ClosestBox> closest(count);
    std::vector<std::uint8_t> any(count);
    scene_.cast(rays.data(), count, hits.data(), each, mask());
    scene_.castClosest(rays.data(), count, closest.data(), each, mask());
    scene_.castAny(rays.data(), count, any.data(), each, mask());
    for (std::size_t i = 0; i < count; ++i) {
      component_ = &sample_.components[i / 3];
      const std::string argument = " together (max_range " + hex(limits[i]) + ")";
      const Hit alone = scene_.cast(rays[i], limits[i], mask());
      expect(same(hits[i], alone), "cast" + argument, hits[i].t, alone.t);
      const ClosestBox& c = closest[i];
      expect(
          c.hit == alone.hit && c.box == alone.box && c.t_lower <= alone.t && alone.t <= c.t_upper,
          "castClosest" + argument, c.t_lower, alone.t);
      expect((any[i] != 0) == alone.hit, "castAny" + argument, any[i], alone.hit);
    }
  }

  /// Segments that are asked about together, more than are under way at once, against each alone.
  void checkSegmentsTogether() {
    std::vector<Segment> segments;
    while (segments.size() < 20) {
      for (const Sample& component : sample_.components) {
        segments.push_back(component.segment());
        const Vector3 middle = 0.5 * component.origin + 0.5 * component.end;
        segments.push_back({component.origin, random_.chance(0.5) ? component.origin : middle});
      }
    }
    std::vector<Clearance> clearances(segments.size());
    scene_.clearance(segments.data(), segments.size(), clearances.data(), mask());
    const double radius = std::min(std::fabs(random_.nudged(clearances[0].distance, 1)), 1e300);
    std::vector<std::uint8_t> clear(segments.size());
    std::vector<std::uint8_t> farther(segments.size());
    scene_.isClear(segments.data(), segments.size(), clear.data(), 0.0, mask());
    scene_.isClear(segments.data(), segments.size(), farther.data(), radius, mask());
    for (std::size_t i = 0; i < segments.size(); ++i) {
      component_ = &sample_.components[i / 2 % sample_.components.size()];
      const Clearance alone = scene_.clearance(segments[i], mask());
      const Clearance& c = clearances[i];
      expect(c.box == alone.box && c.distance == alone.distance &&
                 (c.t == alone.t || c.box == kNoBox) && same(c.on_segment, alone.on_segment) &&
                 same(c.on_box, alone.on_box),
             "clearance together", c.distance, alone.distance);
      const bool is_clear = scene_.isClear(segments[i], 0.0, mask());
      expect((clear[i] != 0) == is_clear, "isClear together", clear[i], is_clear);
      const bool is_apart = scene_.isClear(segments[i], radius, mask());
      expect((farther[i] != 0) == is_apart, "isClear at " + hex(radius), farther[i], is_apart);
    }
  }

  static bool isWithin(const oracle::Bound& t, const oracle::ExactComponent& ray, double limit) {
    if (std::isinf(limit)) {
      return true;
    }
    const oracle::Fraction squared_limit{oracle::square(limit), 1.0};
    return compare(oracle::squaredRange(t.value, ray), squared_limit) <= 0;
  }

  void checkHit(const Ray& ray, const oracle::ExactComponent& exact, const Hit& hit,
                std::size_t first, const Intervals& intervals) {
    expect(hit.hit == (first != kNoBox), "cast: hit", hit.hit, first != kNoBox);
    expect(hit.box == first, "cast: box", static_cast<double>(hit.box), static_cast<double>(first));
    if (first == kNoBox) {
      expect(hit.range == kInf && std::isnan(hit.exit_range) && hit.t == kInf, "range of a miss",
             hit.range, kInf);
      return;
    }
    const oracle::Interval& interval = intervals[first];
    tally_.worst_t = std::max(tally_.worst_t, oracle::ulpError(hit.t, interval.enter));
    expect(oracle::isCorrectlyRounded(hit.t, interval.enter), "cast: t", hit.t,
           oracle::approximate(interval.enter.value));
    expect(hit.entered == interval.entered, "cast: entered", hit.entered.bits(),
           interval.entered.bits());
    expect(hit.started_inside == interval.started_inside, "cast: started_inside",
           hit.started_inside, interval.started_inside);
    checkRange("cast: range", hit.range, interval.enter, exact);
    checkRange("cast: exit_range", hit.exit_range, interval.exit, exact);

    const double scale =
        std::max(oracle::largestCoordinate(ray), oracle::largestCoordinate(sample_.boxes[first]));
    const double error =
        oracle::pointError(hit.point, oracle::pointAt(exact, interval.enter.value), scale);
    tally_.worst_point = std::max(tally_.worst_point, error);
    expect(error <= kPointUlps, "cast: error of point", error, 0.0);
    checkNormal(hit, exact_boxes_[first]);
  }

  void checkRange(const char* query, double got, const oracle::Bound& t,
                  const oracle::ExactComponent& component) {
    if (t.infinity != 0) {
      expect(got == 0.0 && component.isPoint(), query, got, 0.0);
      return;
    }
    const oracle::Fraction squared = oracle::squaredRange(t.value, component);
    tally_.worst_range = std::max(tally_.worst_range, oracle::ulpErrorSqrt(got, squared));
    expect(oracle::isCorrectlyRoundedSqrt(got, squared), query, got,
           std::sqrt(oracle::approximate(squared)));
  }

  /// Outward, of the lowest entered axis; zero where the ray starts inside.
  void checkNormal(const Hit& hit, const oracle::ExactBox& box) {
    const auto face = [&hit](int axis, bool positive) {
      return hit.entered.contains(axis, positive);
    };
    int axis = 0;
    while (axis < 3 && !face(axis, false) && !face(axis, true)) {
      ++axis;
    }
    oracle::ExactPoint exact{{}, 1.0};
    if (!hit.started_inside && axis < 3) {
      const auto i = static_cast<std::size_t>(axis);
      exact.numerator[i] = 1.0;
      exact = {box.toWorld(exact.numerator), box.n};
      if (face(axis, false)) {
        exact.numerator = {-exact.numerator[0], -exact.numerator[1], -exact.numerator[2]};
      }
    }
    const double error = oracle::pointError(hit.normal, exact, 1.0);
    tally_.worst_point = std::max(tally_.worst_point, error);
    expect(error <= kPointUlps, "cast: error of normal", error, 0.0);
  }

  template <typename Component>
  void checkFindAll(const Component& component, const char* query) {
    const oracle::ExactComponent exact(component);
    std::vector<std::pair<oracle::Bound, std::size_t>> expected;
    for (std::size_t i = 0; i < exact_boxes_.size(); ++i) {
      if (looksAt(i)) {
        const oracle::Interval interval = oracle::interval(exact, exact_boxes_[i]);
        if (interval.hit()) {
          expected.emplace_back(interval.enter, i);
        }
      }
    }
    std::stable_sort(expected.begin(), expected.end(),
                     [](const auto& a, const auto& b) { return compare(a.first, b.first) < 0; });
    const std::vector<BoxIntersection> found = scene_.findAll(component, mask());
    expect(found.size() == expected.size(), query, static_cast<double>(found.size()),
           static_cast<double>(expected.size()));
    for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
      const Intersection& a = found[i].intersection;
      const Intersection b =
          std::visit([&](const auto& box) { return findIntersection(component, box); },
                     sample_.boxes[found[i].box]);
      const bool equal = a.num_points == b.num_points && a.t_enter == b.t_enter &&
                         a.t_exit == b.t_exit && a.started_inside == b.started_inside &&
                         a.entered == b.entered && a.left == b.left &&
                         same(a.enter_point, b.enter_point) && same(a.exit_point, b.exit_point);
      expect(found[i].box == expected[i].second && equal, query, static_cast<double>(found[i].box),
             static_cast<double>(expected[i].second));
    }
  }

  void checkSegment(const Segment& segment) {
    const oracle::ExactComponent exact(segment);
    std::vector<oracle::Nearest> nearest(exact_boxes_.size());
    std::size_t best = kNoBox;
    for (std::size_t i = 0; i < exact_boxes_.size(); ++i) {
      if (looksAt(i)) {
        nearest[i] = oracle::nearest(exact, exact_boxes_[i]);
        if (best == kNoBox || nearest[i].squared < nearest[best].squared) {
          best = i;
        }
      }
    }
    const Clearance found = scene_.clearance(segment, mask());
    expect(found.box == best, "clearance: box", static_cast<double>(found.box),
           static_cast<double>(best));
    if (best == kNoBox) {
      expect(found.distance == kInf && std::isnan(found.t), "clearance: distance of nothing",
             found.distance, kInf);
    } else {
      const oracle::Fraction& squared = nearest[best].squared;
      tally_.worst_distance =
          std::max(tally_.worst_distance, oracle::ulpErrorSqrt(found.distance, squared));
      expect(oracle::isCorrectlyRoundedSqrt(found.distance, squared), "clearance: distance",
             found.distance, std::sqrt(oracle::approximate(squared)));
      expect(oracle::isCorrectlyRounded(found.t, nearest[best].t), "clearance: t", found.t,
             oracle::approximate(nearest[best].t));
      const SegmentDistance pair =
          std::visit([&](const auto& box) { return distance(segment, box); }, sample_.boxes[best]);
      expect(same(found.on_segment, pair.on_segment) && same(found.on_box, pair.on_box),
             "clearance: points", 0.0, 1.0);
    }
    const double close = std::isfinite(found.distance) ? random_.nudged(found.distance, 1) : 1.0;
    for (const double radius : {0.0, close, close * 2.0 + random_.magnitude(-10, 1)}) {
      if (radius >= 0.0 && std::isfinite(radius)) {
        checkRadius(segment, exact, radius, nearest);
      }
    }
  }

  void checkRadius(const Segment& segment, const oracle::ExactComponent& exact, double radius,
                   const std::vector<oracle::Nearest>& nearest) {
    std::size_t first = kNoBox;
    std::optional<oracle::Root> earliest;
    for (std::size_t i = 0; i < exact_boxes_.size(); ++i) {
      if (looksAt(i)) {
        const auto root = oracle::firstWithin(exact, exact_boxes_[i], radius, nearest[i]);
        if (root && (!earliest || compare(*root, *earliest) < 0)) {
          earliest = root;
          first = i;
        }
      }
    }
    const std::string argument = "(radius " + hex(radius) + ")";
    const bool clear = scene_.isClear(segment, radius, mask());
    expect(clear == !earliest, "isClear" + argument, clear, !earliest);
    const Blockage found = scene_.firstBlockage(segment, radius, mask());
    expect(found.blocked == earliest.has_value() && found.box == first,
           "firstBlockage: box" + argument, static_cast<double>(found.box),
           static_cast<double>(first));
    if (earliest) {
      const double expected = std::visit(
          [&](const auto& box) { return blockedAt(segment, box, radius); }, sample_.boxes[first]);
      expect(found.blocked_at == expected, "firstBlockage: blocked_at" + argument, found.blocked_at,
             expected);
    }
  }

  const SceneSample& sample_;
  Random& random_;
  Tally& tally_;
  const Scene scene_;
  std::vector<oracle::ExactBox> exact_boxes_;
  std::optional<BoxMask> mask_;
  const Sample* component_ = nullptr;
};

}  // namespace

void checkScene(const SceneSample& sample, Random& random, Tally& tally) {
  SceneCheck(sample, random, tally).checkAll();
}

}  // namespace box_query::stress
