// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed.h"
#include "reference/sampler.h"
#include "ros/box_csv.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace box_query::benchmark {
namespace {

using reference::Sampler;

Vector3 center(const std::string& kind, Sampler& sampler, double side,
               const std::vector<Vector3>& heaps) {
  if (kind == "clusters") {
    const Vector3& heap =
        heaps[static_cast<std::size_t>(sampler.index(static_cast<int>(heaps.size())))];
    return heap + sampler.vector(-6.0, 6.0);
  }
  if (kind == "shelves") {
    const Vector3 at = sampler.vector(0.0, side);
    return {std::round(at.x()), std::round(at.y()), 0.5 * std::round(at.z())};
  }
  return sampler.vector(0.0, side);
}

OrientedBox boxOf(const std::string& kind, Sampler& sampler, const Vector3& at) {
  if (kind == "needles") {
    return {at, sampler.rotation(), Vector3(0.1, 0.1, sampler.uniform(1.0, 3.0))};
  }
  if (kind == "shelves") {
    const double half_angle = 0.25 * static_cast<double>(sampler.index(3));
    return {at, Quaternion(std::cos(half_angle), 0.0, 0.0, std::sin(half_angle)),
            Vector3(0.5, sampler.uniform(0.1, 0.5), 0.02)};
  }
  return {at, sampler.rotation(), sampler.vector(0.1, 1.5)};
}

SpeedScene withRays(std::vector<OrientedBox> boxes, std::size_t rays, Sampler& sampler) {
  SpeedScene scene{std::move(boxes), {}};
  Vector3 lo = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 hi = -lo;
  for (const OrientedBox& box : scene.boxes) {
    lo = lo.cwiseMin(box.center);
    hi = hi.cwiseMax(box.center);
  }
  while (scene.rays.size() < rays) {
    const Vector3 share = sampler.vector(0.0, 1.0);
    scene.rays.push_back({lo + share.cwiseProduct(hi - lo), sampler.direction().normalized()});
  }
  return scene;
}

}  // namespace

const std::vector<std::string>& workloadKinds() {
  static const std::vector<std::string> kinds = {"sparse", "dense", "clusters", "needles",
                                                 "shelves"};
  return kinds;
}

Workload makeWorkload(const std::string& kind, std::size_t boxes, std::size_t rays,
                      std::uint64_t seed) {
  Sampler sampler(seed);
  const double spacing = kind == "sparse" || kind == "clusters" ? 10.0
                         : kind == "shelves"                    ? 1.5
                                                                : 4.0;
  const double side = spacing * std::cbrt(static_cast<double>(boxes));
  std::vector<Vector3> heaps;
  for (std::size_t i = 0; i < boxes / 40 + 1; ++i) {
    heaps.push_back(sampler.vector(0.0, side));
  }
  std::vector<OrientedBox> all;
  while (all.size() < boxes) {
    const Vector3 at = center(kind, sampler, side, heaps);
    all.push_back(boxOf(kind, sampler, at));
  }
  return {kind, {withRays(std::move(all), rays, sampler)}};
}

Workload pairWorkload(bool apart, std::size_t rays, std::uint64_t seed) {
  Sampler sampler(seed);
  Workload workload{apart ? "pairs apart" : "pairs", {}};
  for (int block = 0; block < 16; ++block) {
    SpeedScene scene;
    while (scene.boxes.size() < 16) {
      scene.boxes.push_back(
          {sampler.vector(-0.5, 0.5), sampler.rotation(), sampler.vector(0.5, 1.5)});
    }
    while (scene.rays.size() < rays / 16) {
      const Vector3 origin = 5.0 * sampler.direction().normalized();
      const Vector3 along = apart ? sampler.direction() : sampler.vector(-1.2, 1.2) - origin;
      scene.rays.push_back({origin, along.normalized()});
    }
    workload.scenes.push_back(std::move(scene));
  }
  return workload;
}

namespace {

/// The boxes of every n-th scene of each file.
std::vector<std::vector<std::vector<OrientedBox>>> recorded(const std::string& directory,
                                                            std::size_t every) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(directory + "/data")) {
    if (entry.path().extension() == ".csv") {
      paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::vector<std::vector<OrientedBox>>> files;
  std::size_t number = 0;
  for (const auto& path : paths) {
    files.emplace_back();
    for (const CsvScene& scene : readBoxCsvFile(path.string())) {
      if (number++ % every == 0) {
        std::vector<OrientedBox>& boxes = files.back().emplace_back();
        for (const CsvBox& box : scene.boxes) {
          boxes.push_back({box.center, box.orientation, 0.5 * box.size});
        }
      }
    }
  }
  return files;
}

}  // namespace

Workload recordedScenes(const std::string& directory, std::size_t every, std::size_t rays) {
  Workload workload{"recorded", {}};
  Sampler sampler(3);
  for (auto& file : recorded(directory, every)) {
    for (auto& boxes : file) {
      workload.scenes.push_back(withRays(std::move(boxes), rays, sampler));
    }
  }
  return workload;
}

Workload mergedScenes(const std::string& directory, std::size_t every, std::size_t rays) {
  constexpr std::size_t kMerged = 130;
  Workload workload{"merged", {}};
  Sampler sampler(4);
  for (const auto& file : recorded(directory, every)) {
    std::vector<OrientedBox> merged;
    for (const auto& boxes : file) {
      merged.insert(merged.end(), boxes.begin(), boxes.end());
      if (merged.size() >= kMerged) {
        merged.resize(kMerged);
        workload.scenes.push_back(withRays(std::move(merged), rays, sampler));
        merged.clear();
      }
    }
  }
  return workload;
}

}  // namespace box_query::benchmark
