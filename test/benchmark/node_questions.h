// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the batch services are asked, what the library is asked instead, and what is right.
#pragma once

#include <box_query/CastRays.h>
#include <box_query/CheckSegments.h>
#include <box_query/scene.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace box_query::benchmark {

template <class Service>
struct BatchQuestion {
  std::string service;
  std::string asks;
  std::size_t queries;
  typename Service::Request request;
  /// Asks the library for the same.
  std::function<void()> ask;
  /// How many of the answers are not those of the library, to the last bit.
  std::function<std::size_t(const typename Service::Response&)> wrong;
};

/// "closest": hits and ranges. "any": hits. "everything": the closest with all that can be wanted.
/// @param scene outlives the questions
/// @param threads that the library works with; 0: as many as there are cores
std::vector<BatchQuestion<CastRays>> rayQuestions(const Scene& scene, const std::vector<Ray>& rays,
                                                  int threads);

/// Segments along the rays, with a radius. "states": only whether they are blocked. "clearances":
/// those too. "everything": nearest points, first blocked places and boxes as well.
std::vector<BatchQuestion<CheckSegments>> segmentQuestions(const Scene& scene,
                                                           const std::vector<Ray>& rays,
                                                           int threads);

}  // namespace box_query::benchmark
