// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/scene_truth.h"

namespace box_query::benchmark {
namespace {

/// Whether the ray's line stays out of a sphere that is larger than the box by far more than any
/// rounding here: spares the oracle most boxes.
bool passesByFar(const Ray& ray, const OrientedBox& box) {
  const Vector3 p = ray.origin - box.center;
  const double reach = 1.01 * box.half_extents.norm() + 1e-6 * p.norm();
  return p.cross(ray.direction).norm() > reach * ray.direction.norm();
}

}  // namespace

std::vector<SceneTruth> truthOf(const std::vector<OrientedBox>& boxes,
                                const std::vector<Ray>& rays) {
  const std::vector<oracle::ExactBox> exact_boxes(boxes.begin(), boxes.end());
  std::vector<SceneTruth> result;
  for (const Ray& ray : rays) {
    const oracle::ExactComponent component(ray);
    SceneTruth truth;
    oracle::Bound closest;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (passesByFar(ray, boxes[i])) {
        continue;
      }
      const oracle::Interval interval = oracle::interval(component, exact_boxes[i]);
      if (interval.hit() && (!truth.hit() || compare(interval.enter, closest) < 0)) {
        truth.box = i;
        closest = interval.enter;
      }
    }
    if (truth.hit()) {
      truth.squared_range = oracle::squaredRange(closest.value, component);
    }
    result.push_back(truth);
  }
  return result;
}

}  // namespace box_query::benchmark
