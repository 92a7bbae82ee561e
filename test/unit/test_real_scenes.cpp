// SPDX-License-Identifier: BSD-3-Clause
//
// Scenes of the real world, shelves, cages and traffic, against exact arithmetic, to the last bit.
// Each scene is asked 52 rays and 52 segments: at least a quarter of either outcome, and more
// than a tenth that touch a box or run along its face. Skipped where the environment variable
// BOX_QUERY_SHARED does not name the directory that holds data/. BOX_QUERY_SCENE_STEP=n asks only
// every n-th scene, for slow builds.
#include "reference/oracle.h"
#include "reference/scene_queries.h"
#include "ros/box_csv.h"

#include <box_query/scene.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace box_query {
namespace {

using reference::RayQuery;
using reference::Sampler;
using reference::SceneQueries;
using reference::SegmentQuery;

constexpr int kQueries = 52;   ///< of a kind and a scene
constexpr int kTouching = 12;  ///< of them
constexpr double kPointUlps = 4.0;

struct File {
  const char* name;
  int scenes;
  int touchable;  ///< scenes with a face that can be touched exactly
};

std::ostream& operator<<(std::ostream& out, const File& file) {
  return out << file.name;
}

oracle::Fraction squared(double x) {
  return {oracle::square(oracle::Dyadic(x)), oracle::Dyadic(1.0)};
}

/// The box without its surface, nearly: what only touches the box misses this one.
OrientedBox shrunk(OrientedBox box) {
  for (int i = 0; i < 3; ++i) {
    box.half_extents[i] = std::nextafter(box.half_extents[i], 0.0);
  }
  return box;
}

/// Boxes as given and as the oracle knows them.
struct Boxes {
  std::vector<OrientedBox> given;
  std::vector<oracle::ExactBox> exact;

  std::size_t size() const { return given.size(); }
};

/// Exact intervals of a component with every box.
std::vector<oracle::Interval> intervals(const oracle::ExactComponent& component,
                                        const Boxes& boxes) {
  std::vector<oracle::Interval> all;
  all.reserve(boxes.size());
  for (const oracle::ExactBox& box : boxes.exact) {
    all.push_back(oracle::interval(component, box));
  }
  return all;
}

/// Boxes that are met, by exact entry and index.
std::vector<std::size_t> inOrder(const std::vector<oracle::Interval>& exact) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (exact[i].hit()) {
      order.push_back(i);
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return compare(exact[a].enter, exact[b].enter) < 0;
  });
  return order;
}

/// The box that a ray meets first within its range.
std::optional<std::size_t> closest(const RayQuery& query,
                                   const std::vector<oracle::Interval>& exact) {
  const std::vector<std::size_t> order = inOrder(exact);
  if (order.empty()) {
    return std::nullopt;
  }
  const oracle::Fraction range = oracle::squaredRange(exact[order.front()].enter.value, query.ray);
  const bool reached = std::isinf(query.max_range) || compare(range, squared(query.max_range)) <= 0;
  return reached ? std::make_optional(order.front()) : std::nullopt;
}

/// Whether a query touches one of the boxes exactly, or reaches it with the last of its range.
bool touches(const RayQuery& query, const Boxes& boxes,
             const std::vector<oracle::Interval>& exact) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (exact[i].hit() && (!oracle::interval(query.ray, shrunk(boxes.given[i])).hit() ||
                           (std::isfinite(query.max_range) &&
                            compare(oracle::squaredRange(exact[i].enter.value, query.ray),
                                    squared(query.max_range)) == 0))) {
      return true;
    }
  }
  return false;
}

bool touches(const SegmentQuery& query, const Boxes& boxes,
             const std::vector<oracle::Nearest>& exact) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (query.radius > 0.0 ? compare(exact[i].squared, squared(query.radius)) == 0
                           : exact[i].squared.numerator.sign() == 0 &&
                                 !oracle::interval(query.segment, shrunk(boxes.given[i])).hit()) {
      return true;
    }
  }
  return false;
}

template <typename Component>
void expectAllFound(const Scene& scene, const Component& component, const Boxes& boxes) {
  const std::vector<oracle::Interval> exact = intervals(component, boxes);
  const std::vector<std::size_t> order = inOrder(exact);
  const std::vector<BoxIntersection> found = scene.findAll(component);
  ASSERT_EQ(found.size(), order.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    ASSERT_EQ(found[k].box, order[k]);
    const Intersection& ours = found[k].intersection;
    const oracle::Interval& truth = exact[order[k]];
    EXPECT_EQ(ours.num_points, truth.num_points);
    EXPECT_TRUE(oracle::isCorrectlyRounded(ours.t_enter, truth.enter));
    EXPECT_TRUE(oracle::isCorrectlyRounded(ours.t_exit, truth.exit));
    EXPECT_EQ(ours.entered, truth.entered);
    EXPECT_EQ(ours.left, truth.left);
    EXPECT_EQ(ours.started_inside, truth.started_inside);
  }
}

std::size_t sceneStep() {
  const char* step = std::getenv("BOX_QUERY_SCENE_STEP");
  return step ? static_cast<std::size_t>(std::max(1, std::atoi(step))) : 1;
}

class RealScenes : public testing::TestWithParam<File> {
 protected:
  void SetUp() override {
    const char* shared = std::getenv("BOX_QUERY_SHARED");
    if (shared == nullptr) {
      GTEST_SKIP() << "BOX_QUERY_SHARED is not set: it names the directory that holds data/";
    }
    const std::string path = std::string(shared) + "/data/" + GetParam().name + ".csv";
    if (!std::ifstream(path)) {
      GTEST_SKIP() << "BOX_QUERY_SHARED: there is no " << path;
    }
    for (const CsvScene& csv : readBoxCsvFile(path)) {
      Boxes boxes;
      for (const CsvBox& box : csv.boxes) {
        boxes.given.push_back({box.center, box.orientation, box.size / 2.0});
        boxes.exact.emplace_back(boxes.given.back());
      }
      scenes_.push_back(std::move(boxes));
    }
    ASSERT_EQ(static_cast<int>(scenes_.size()), GetParam().scenes);
  }

  /// Calls ask(scene, boxes, query, exact) for the queries of every scene.
  ///
  /// @param random, touching draw a query, the latter the n-th
  /// @param answer the exact answers of one
  /// @param outcome of an exact answer: each is had by a quarter of a scene's queries
  template <typename Random, typename Touching, typename Answer, typename Outcome, typename Ask>
  void forEachQuery(const Random& random, const Touching& touching, const Answer& answer,
                    const Outcome& outcome, const Ask& ask) {
    int touchable = 0;
    const std::size_t step = sceneStep();
    for (std::size_t s = 0; s < scenes_.size() && !HasFailure(); s += step) {
      const Boxes& boxes = scenes_[s];
      const Scene scene(std::vector<Box>(boxes.given.begin(), boxes.given.end()));
      Sampler sampler(s);
      SceneQueries queries(boxes.given, sampler);
      touchable += queries.canTouchExactly();
      int asked = 0;
      int touched = 0;
      int counts[2] = {0, 0};
      for (int attempt = 0; asked < kQueries && attempt < 100 * kQueries; ++attempt) {
        const bool touch = attempt < kTouching;
        const auto query = touch ? touching(queries, attempt) : random(queries);
        const auto exact = answer(query, boxes);
        int& count = counts[outcome(query, exact) ? 1 : 0];
        if (!touch && count == kQueries * 3 / 4) {
          continue;  // There are enough of this outcome.
        }
        SCOPED_TRACE("scene " + std::to_string(s) + ", query " + std::to_string(attempt));
        ask(scene, boxes, query, exact);
        touched += touch && touches(query, boxes, exact);
        ++count;
        ++asked;
      }
      ASSERT_EQ(asked, kQueries) << "scene " << s;
      ASSERT_GE(std::min(counts[0], counts[1]), kQueries / 4) << "scene " << s;
      if (queries.canTouchExactly()) {
        ASSERT_GE(touched, kQueries / 10) << "scene " << s;
      }
    }
    if (step == 1) {
      EXPECT_EQ(touchable, GetParam().touchable);
    }
  }

  template <typename Ask>
  void forEachRay(const Ask& ask) {
    forEachQuery(
        [](SceneQueries& queries) { return queries.randomRay(); },
        [](SceneQueries& queries, int n) { return queries.touchingRay(n); },
        [](const RayQuery& query, const Boxes& boxes) { return intervals(query.ray, boxes); },
        [](const RayQuery& query, const std::vector<oracle::Interval>& exact) {
          return closest(query, exact).has_value();
        },
        ask);
  }

  template <typename Ask>
  void forEachSegment(const Ask& ask) {
    forEachQuery([](SceneQueries& queries) { return queries.randomSegment(); },
                 [](SceneQueries& queries, int n) { return queries.touchingSegment(n); },
                 [](const SegmentQuery& query, const Boxes& boxes) {
                   std::vector<oracle::Nearest> all;
                   const oracle::ExactComponent segment = query.segment;
                   for (const oracle::ExactBox& box : boxes.exact) {
                     all.push_back(oracle::nearest(segment, box));
                   }
                   return all;
                 },
                 [](const SegmentQuery& query, const std::vector<oracle::Nearest>& exact) {
                   return std::all_of(exact.begin(), exact.end(), [&](const auto& nearest) {
                     return compare(nearest.squared, squared(query.radius)) > 0;
                   });
                 },
                 ask);
  }

  std::vector<Boxes> scenes_;
};

TEST_P(RealScenes, RaysHitTheClosestBoxAtItsRange) {
  forEachRay([](const Scene& scene, const Boxes& boxes, const RayQuery& query,
                const std::vector<oracle::Interval>& exact) {
    const std::optional<std::size_t> box = closest(query, exact);
    const Hit hit = scene.cast(query.ray, query.max_range);
    ASSERT_EQ(hit.hit, box.has_value());
    EXPECT_EQ(scene.castAny(query.ray, query.max_range), hit.hit);
    if (!box) {
      EXPECT_EQ(hit.box, kNoBox);
      return;
    }
    ASSERT_EQ(hit.box, *box);
    const oracle::Interval& truth = exact[*box];
    const oracle::Fraction range = oracle::squaredRange(truth.enter.value, query.ray);
    const oracle::Fraction exit_range = oracle::squaredRange(truth.exit.value, query.ray);
    EXPECT_TRUE(oracle::isCorrectlyRoundedSqrt(hit.range, range));
    EXPECT_TRUE(oracle::isCorrectlyRoundedSqrt(hit.exit_range, exit_range));
    EXPECT_TRUE(oracle::isCorrectlyRounded(hit.t, truth.enter));
    EXPECT_EQ(hit.started_inside, truth.started_inside);
    EXPECT_EQ(hit.entered, truth.entered);
    const double scale = std::max(oracle::largestCoordinate(query.ray),
                                  oracle::largestCoordinate(boxes.given[*box]));
    const oracle::ExactPoint point = oracle::pointAt(query.ray, truth.enter.value);
    EXPECT_LE(oracle::pointError(hit.point, point, scale), kPointUlps);
  });
}

TEST_P(RealScenes, AllHitsAreFoundInTheOrderOfTheirEntry) {
  forEachRay([](const Scene& scene, const Boxes& boxes, const RayQuery& query,
                const std::vector<oracle::Interval>&) {
    expectAllFound(scene, query.ray, boxes);
    expectAllFound(scene, Line{query.ray.origin, query.ray.direction}, boxes);
    const Vector3 end = query.ray.origin + query.ray.direction;
    expectAllFound(scene, Segment{query.ray.origin, end}, boxes);
  });
}

TEST_P(RealScenes, SegmentsAreAsFarFromTheNearestBoxAsTheyAre) {
  forEachSegment([](const Scene& scene, const Boxes& boxes, const SegmentQuery& query,
                    const std::vector<oracle::Nearest>& exact) {
    const auto truth = std::min_element(
        exact.begin(), exact.end(),
        [](const auto& a, const auto& b) { return compare(a.squared, b.squared) < 0; });
    const Clearance clearance = scene.clearance(query.segment);
    ASSERT_EQ(clearance.box, static_cast<std::size_t>(truth - exact.begin()));
    EXPECT_TRUE(oracle::isCorrectlyRoundedSqrt(clearance.distance, truth->squared));
    EXPECT_TRUE(oracle::isCorrectlyRounded(clearance.t, truth->t));
    const OrientedBox& box = boxes.given[clearance.box];
    const double scale =
        std::max(oracle::largestCoordinate(query.segment), oracle::largestCoordinate(box));
    EXPECT_LE(
        oracle::pointError(clearance.on_segment, oracle::pointAt(query.segment, truth->t), scale),
        kPointUlps);
    EXPECT_LE(oracle::pointError(clearance.on_box,
                                 oracle::nearestOnBox(query.segment, box, truth->t), scale),
              kPointUlps);
  });
}

TEST_P(RealScenes, SegmentsAreClearOrBlockedWhereTheyAre) {
  forEachSegment([](const Scene& scene, const Boxes& boxes, const SegmentQuery& query,
                    const std::vector<oracle::Nearest>& exact) {
    std::optional<oracle::Root> first;
    std::size_t first_box = kNoBox;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (compare(exact[i].squared, squared(query.radius)) <= 0) {
        const auto within = oracle::firstWithin(query.segment, boxes.exact[i], query.radius);
        ASSERT_TRUE(within.has_value());
        if (!first || compare(*within, *first) < 0) {
          first = within;
          first_box = i;
        }
      }
    }
    EXPECT_EQ(scene.isClear(query.segment, query.radius), !first);
    const Blockage blockage = scene.firstBlockage(query.segment, query.radius);
    ASSERT_EQ(blockage.blocked, first.has_value());
    ASSERT_EQ(blockage.box, first_box);
    if (first && query.radius == 0.0) {
      EXPECT_TRUE(oracle::isCorrectlyRounded(
          blockage.blocked_at, oracle::interval(query.segment, boxes.exact[first_box]).enter));
    } else if (first) {
      const int steps = oracle::stepsBefore(blockage.blocked_at, *first, 5);
      EXPECT_GE(steps, 0) << "late";
      EXPECT_LE(steps, 4) << "early";
    }
  });
}

INSTANTIATE_TEST_SUITE_P(
    Files, RealScenes,
    testing::Values(File{"driving_commonroad", 303, 303}, File{"manip_mbm_baxter", 300, 300},
                    File{"manip_mbm_fetch", 700, 600}, File{"manip_mbm_panda", 700, 656},
                    File{"manip_mbm_ur5", 700, 600}, File{"manip_robowflex", 24, 13}),
    [](const auto& file) { return std::string(file.param.name); });

}  // namespace
}  // namespace box_query
