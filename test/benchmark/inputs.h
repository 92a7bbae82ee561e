// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the methods are asked about. A seed gives the same input everywhere.
#pragma once

#include <box_query/geometry.h>

#include <cstdint>
#include <vector>

namespace box_query::benchmark {

enum class Input {
  kRandom,   ///< Boxes of 0.2 to 3 m, any rotation, within 10 m: no two things touch.
  kHostile,  ///< The stress test's families, each as often; blocks of boxes face to face.
  kShelf     ///< Boxes that stand on and against each other, components in the planes of faces.
};
constexpr Input kInputs[] = {Input::kRandom, Input::kHostile, Input::kShelf};
const char* nameOf(Input input);

/// Component i belongs to box i.
template <typename Component>
struct Pairs {
  std::vector<Component> components;
  std::vector<OrientedBox> boxes;
};

template <typename Component>
Pairs<Component> makePairs(Input input, std::size_t count, std::uint64_t seed);
extern template Pairs<Line> makePairs(Input, std::size_t, std::uint64_t);
extern template Pairs<Ray> makePairs(Input, std::size_t, std::uint64_t);
extern template Pairs<Segment> makePairs(Input, std::size_t, std::uint64_t);

/// Every ray is asked about all boxes.
struct RayScene {
  std::vector<OrientedBox> boxes;
  std::vector<Ray> rays;
};

/// 64 boxes.
RayScene makeScene(Input input, std::size_t rays, std::uint64_t seed);

/// `count` boxes side by side in a row along x, all with their tops in the plane z = 1, and rays in
/// that plane, along the row: every ray touches every box.
RayScene touchedRow(std::size_t count, std::size_t rays, std::uint64_t seed);

/// `count` boxes with their fronts in the plane x = 0, around the x axis, and rays along it: every
/// ray enters every box at the same t.
RayScene sharedFronts(std::size_t count, std::size_t rays, std::uint64_t seed);

/// Every box moved at random, by up to `distance` along each axis: what touched does no more.
RayScene jittered(RayScene scene, double distance, std::uint64_t seed);

}  // namespace box_query::benchmark
