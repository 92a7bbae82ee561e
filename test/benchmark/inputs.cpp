// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/inputs.h"

#include "reference/sampler.h"
#include "stress/families.h"

#include <cmath>
#include <string>
#include <type_traits>
#include <variant>

namespace box_query::benchmark {
namespace {

using reference::Sampler;

/// A component through two points, which a segment ends at.
template <typename Component>
Component through(const Vector3& a, const Vector3& b) {
  if constexpr (std::is_same_v<Component, Segment>) {
    return {a, b};
  } else {
    return {a, b - a};
  }
}

Vector3 pointOf(const OrientedBox& box, const Vector3& y) {
  return box.center + box.orientation * Vector3(y.cwiseProduct(box.half_extents));
}

OrientedBox randomBox(Sampler& sampler, double reach) {
  const Vector3 center = sampler.vector(-reach, reach);
  const Quaternion orientation = sampler.rotation();
  return {center, orientation, sampler.vector(0.1, 1.5)};
}

template <typename Component>
void addRandomPair(Sampler& sampler, Pairs<Component>& pairs) {
  const OrientedBox box = randomBox(sampler, 10.0);
  const Vector3 start = sampler.vector(-10.0, 10.0);
  const Vector3 aim = pointOf(box, sampler.vector(-1.6, 1.6));
  pairs.components.push_back(
      through<Component>(start, start + sampler.uniform(0.7, 1.7) * (aim - start)));
  pairs.boxes.push_back(box);
}

/// Numbers of the families of the stress test that are hostile.
std::vector<std::size_t> hostileFamilies() {
  const std::vector<std::string>& names = stress::familyNames();
  std::vector<std::size_t> families;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] != "random") {
      families.push_back(i);
    }
  }
  return families;
}

template <typename Component>
Pairs<Component> hostilePairs(std::size_t count, std::uint64_t seed) {
  const std::vector<std::size_t> families = hostileFamilies();
  Pairs<Component> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const auto sample = stress::makeSample(families[i % families.size()], true, seed, i);
    if constexpr (std::is_same_v<Component, Segment>) {
      pairs.components.push_back(sample.segment());
    } else {
      pairs.components.push_back({sample.origin, sample.direction});
    }
    pairs.boxes.push_back(std::get<OrientedBox>(sample.box));
  }
  return pairs;
}

/// Multiples of 1/64 m: sums of a few are exact and faces meet exactly. Of 1/100 m: they meet as
/// far as doubles can, as on any shelf that people have measured.
constexpr double kBinary = 64.0;
constexpr double kDecimal = 100.0;

double onGrid(Sampler& sampler, int low, int high, double steps = kBinary) {
  return (low + sampler.index(high - low + 1)) / steps;
}
Vector3 gridVector(Sampler& sampler, int low, int high, double steps = kBinary) {
  const double x = onGrid(sampler, low, high, steps);
  const double y = onGrid(sampler, low, high, steps);
  const double z = onGrid(sampler, low, high, steps);
  return {x, y, z};
}

/// 0 to 3 quarter turns about z. Those of 1 and 3 are turns by exactly 90 degrees, whatever the
/// root of 1/2 rounds to.
Quaternion quarterTurns(int turns) {
  const double half = std::sqrt(0.5);
  const Quaternion all[] = {Quaternion(1.0, 0.0, 0.0, 0.0), Quaternion(half, 0.0, 0.0, half),
                            Quaternion(0.0, 0.0, 0.0, 1.0), Quaternion(half, 0.0, 0.0, -half)};
  return all[turns];
}

/// A box with these extents along the axes of the world.
OrientedBox turnedBox(const Vector3& center, const Vector3& e, int turns) {
  return {center, quarterTurns(turns), turns % 2 == 0 ? e : Vector3(e.y(), e.x(), e.z())};
}

/// The extents of such a box along the axes of the world.
Vector3 worldExtents(const OrientedBox& box) {
  const bool turned = box.orientation.w() != 0.0 && box.orientation.z() != 0.0;
  return turnedBox(box.center, box.half_extents, turned ? 1 : 0).half_extents;
}

template <typename Component>
void addShelfPair(Sampler& sampler, Pairs<Component>& pairs) {
  const double steps = sampler.chance(0.5) ? kBinary : kDecimal;
  const Vector3 center = gridVector(sampler, -640, 640, steps);
  const Vector3 e = gridVector(sampler, 1, 48, steps);
  Vector3 start = gridVector(sampler, -640, 640, steps);
  Vector3 aim = center;
  for (int i = 0; i < 3; ++i) {
    aim[i] += sampler.uniform(-1.6, 1.6) * e[i];
  }
  // One coordinate in the plane of a face; in one pair of four a second one: along an edge.
  const int axis = sampler.index(3);
  const int axes = sampler.chance(0.25) ? 2 : 1;
  for (int i = 0; i < axes; ++i) {
    const int k = (axis + i) % 3;
    start[k] = aim[k] = center[k] + sampler.sign() * e[k];
  }
  pairs.components.push_back(through<Component>(start, aim));
  pairs.boxes.push_back(turnedBox(center, e, sampler.index(4)));
}

/// A rack of four levels: on each a board, and fifteen boxes on it, side by side.
std::vector<OrientedBox> rack(Sampler& sampler) {
  std::vector<OrientedBox> boxes;
  for (int level = 0; level < 4; ++level) {
    boxes.push_back(turnedBox({0.0, 0.0, level - 1.0 / 64.0}, {2.0, 0.5, 1.0 / 64.0}, 0));
    double x = -2.0;
    for (int i = 0; i < 15; ++i) {
      const double e_x = onGrid(sampler, 3, 8);
      const double e_y = onGrid(sampler, 10, 32);
      const double e_z = onGrid(sampler, 8, 30);
      boxes.push_back(
          turnedBox({x + e_x, e_y - 0.5, level + e_z}, {e_x, e_y, e_z}, sampler.index(4)));
      x += 2.0 * e_x;
    }
  }
  return boxes;
}

/// A ray in the plane of a face, through a point of it.
Ray shelfRay(Sampler& sampler, const std::vector<OrientedBox>& boxes) {
  const OrientedBox& box = boxes[static_cast<std::size_t>(sampler.index(64))];
  Vector3 start = gridVector(sampler, -192, 192);
  const Vector3 aim = pointOf(box, sampler.vector(-1.0, 1.0));
  const int k = sampler.index(3);
  Vector3 direction = aim - start;
  start[k] = box.center[k] + sampler.sign() * worldExtents(box)[k];
  direction[k] = 0.0;
  return {start, direction};
}

/// A block of 4 x 4 x 4 equal boxes under one rotation, face to face as far as doubles can, in one
/// scene of two at map coordinates; and rays from corner to corner.
RayScene hostileScene(Sampler& sampler, std::size_t rays) {
  RayScene scene;
  const Vector3 offset = sampler.chance(0.5) ? Vector3(4.5e5, 5.4e6, 120.0) : Vector3::Zero();
  const Quaternion orientation = sampler.rotation();
  const Vector3 e = sampler.vector(0.2, 1.0);
  for (int i = 0; i < 64; ++i) {
    const Vector3 cell(i % 4 - 1.5, i / 4 % 4 - 1.5, i / 16 - 1.5);
    const Vector3 from_middle = orientation * Vector3(2.0 * cell.cwiseProduct(e));
    scene.boxes.push_back({offset + from_middle, orientation, e});
  }
  const auto corner = [&](double reach) {
    const OrientedBox& box = scene.boxes[static_cast<std::size_t>(sampler.index(64))];
    const double x = reach * sampler.sign();
    const double y = reach * sampler.sign();
    return pointOf(box, {x, y, reach * sampler.sign()});
  };
  while (scene.rays.size() < rays) {
    const Vector3 a = corner(1.0 + 2.0 * sampler.index(4));
    const Vector3 b = corner(1.0);
    if (a != b) {
      scene.rays.push_back(Ray{a, b - a});
    }
  }
  return scene;
}

}  // namespace

const char* nameOf(Input input) {
  switch (input) {
    case Input::kRandom:
      return "random";
    case Input::kHostile:
      return "hostile";
    case Input::kShelf:
      return "shelf";
  }
  return "";
}

template <typename Component>
Pairs<Component> makePairs(Input input, std::size_t count, std::uint64_t seed) {
  if (input == Input::kHostile) {
    return hostilePairs<Component>(count, seed);
  }
  Sampler sampler(seed);
  Pairs<Component> pairs;
  while (pairs.boxes.size() < count) {
    if (input == Input::kShelf) {
      addShelfPair(sampler, pairs);
    } else {
      addRandomPair(sampler, pairs);
    }
  }
  return pairs;
}
template Pairs<Line> makePairs(Input, std::size_t, std::uint64_t);
template Pairs<Ray> makePairs(Input, std::size_t, std::uint64_t);
template Pairs<Segment> makePairs(Input, std::size_t, std::uint64_t);

RayScene makeScene(Input input, std::size_t rays, std::uint64_t seed) {
  Sampler sampler(seed);
  if (input == Input::kHostile) {
    return hostileScene(sampler, rays);
  }
  RayScene scene;
  if (input == Input::kShelf) {
    scene.boxes = rack(sampler);
  }
  while (scene.boxes.size() < 64) {
    scene.boxes.push_back(randomBox(sampler, 8.0));
  }
  while (scene.rays.size() < rays) {
    if (input == Input::kShelf) {
      scene.rays.push_back(shelfRay(sampler, scene.boxes));
    } else {
      const Vector3 origin = sampler.vector(-8.0, 8.0);
      scene.rays.push_back({origin, sampler.direction()});
    }
  }
  return scene;
}

RayScene touchedRow(std::size_t count, std::size_t rays, std::uint64_t seed) {
  Sampler sampler(seed);
  RayScene scene;
  double x = 0.0;
  while (scene.boxes.size() < count) {
    const Vector3 e = gridVector(sampler, 8, 48);
    scene.boxes.push_back(turnedBox({x + e.x(), 0.0, 1.0 - e.z()}, e, 0));
    x += 2.0 * e.x();
  }
  while (scene.rays.size() < rays) {
    // Within the narrowest box all along the row.
    const double y = onGrid(sampler, -4, 4);
    const double slope = sampler.uniform(-1.0, 1.0) / 64.0 / x;
    scene.rays.push_back({Vector3(-onGrid(sampler, 64, 640), y, 1.0), Vector3(1.0, slope, 0.0)});
  }
  return scene;
}

RayScene sharedFronts(std::size_t count, std::size_t rays, std::uint64_t seed) {
  Sampler sampler(seed);
  RayScene scene;
  while (scene.boxes.size() < count) {
    const Vector3 e = gridVector(sampler, 32, 96);
    scene.boxes.push_back(turnedBox({e.x(), 0.0, 0.0}, e, 0));
  }
  while (scene.rays.size() < rays) {
    const Vector3 start(-onGrid(sampler, 64, 640), onGrid(sampler, -16, 16),
                        onGrid(sampler, -16, 16));
    scene.rays.push_back({start, Vector3(1.0, sampler.uniform(-0.01, 0.01), 0.0)});
  }
  return scene;
}

RayScene jittered(RayScene scene, double distance, std::uint64_t seed) {
  Sampler sampler(seed);
  for (OrientedBox& box : scene.boxes) {
    box.center += sampler.vector(-distance, distance);
  }
  return scene;
}

}  // namespace box_query::benchmark
