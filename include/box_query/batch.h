// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Many queries against one scene, on all cores: the answers of the single calls, in their order.
#pragma once

#include <box_query/counters.h>
#include <box_query/geometry.h>
#include <box_query/scene.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace box_query {

/// How a batch is worked on.
struct BatchOptions {
  /// [m] of each ray; +inf: unlimited.
  double max_range = std::numeric_limits<double>::infinity();
  /// Which boxes to look at; null: all. It has as many entries as the scene has boxes.
  const BoxMask* mask = nullptr;
  /// Threads that work at once, the caller's among them; 0: as many as there are cores. A small
  /// batch stays on the caller's.
  int max_threads = 0;
  /// What the queries did on all threads is added to it, unless it is null.
  QueryCounters* counters = nullptr;
};

/// Calls work(begin, end) for parts that make up [0, count), each index once, on up to
/// `max_threads` threads at once (0: as many as there are cores), and returns when all are done.
/// The threads are shared by all batches of the process.
///
/// @throws what `work` throws for the lowest part that throws; other parts may or may not have been
/// worked on.
void forEachPart(std::size_t count, int max_threads,
                 const std::function<void(std::size_t begin, std::size_t end)>& work);

/// Scene::cast() of each ray.
/// @pre isValid() of each, max_range >= 0
std::vector<Hit> castEach(const Scene& scene, const std::vector<Ray>& rays,
                          const BatchOptions& options = {});

/// Scene::castClosest() of each ray.
/// @pre isValid() of each, max_range >= 0
std::vector<ClosestBox> castClosestEach(const Scene& scene, const std::vector<Ray>& rays,
                                        const BatchOptions& options = {});

/// Scene::castAny() of each ray, 1 for true.
/// @pre isValid() of each, max_range >= 0
std::vector<std::uint8_t> castAnyEach(const Scene& scene, const std::vector<Ray>& rays,
                                      const BatchOptions& options = {});

/// Scene::isClear() of each segment with `radius` [m], 1 for true.
/// @pre isValid() of each, radius finite and >= 0
std::vector<std::uint8_t> isClearEach(const Scene& scene, const std::vector<Segment>& segments,
                                      double radius, const BatchOptions& options = {});

/// Scene::clearance() of each segment.
/// @pre isValid() of each
std::vector<Clearance> clearanceEach(const Scene& scene, const std::vector<Segment>& segments,
                                     const BatchOptions& options = {});

/// Scene::firstBlockage() of each segment with `radius` [m].
/// @pre isValid() of each, radius finite and >= 0
std::vector<Blockage> firstBlockageEach(const Scene& scene, const std::vector<Segment>& segments,
                                        double radius, const BatchOptions& options = {});

}  // namespace box_query
