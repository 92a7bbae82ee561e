// SPDX-License-Identifier: BSD-3-Clause
#include "stress/limits.h"

#include <algorithm>
#include <cmath>

namespace box_query::stress {
namespace {

/// The exponent of a power of two at one of the limits, near it, or well beyond it.
template <std::size_t kCount>
int near(Random& random, const int (&limits)[kCount]) {
  const int limit = limits[random.below(static_cast<int>(kCount))];
  return limit + (random.chance(0.8) ? random.between(-3, 3) : random.between(-200, 200));
}
template <std::size_t kCount>
double signedNear(Random& random, const int (&limits)[kCount]) {
  const double side = random.sign();
  return std::ldexp(side, near(random, limits));
}

/// A box on small numbers, and a component that touches it exactly, grazes it or goes through.
Sample around(Random& random, bool oriented) {
  const bool on_lattice = random.chance(0.5);
  const Vector3 center = on_lattice ? random.halves(1) : random.uniformVector(-5.0, 5.0);
  const Vector3 size =
      on_lattice ? Vector3(random.halves(2).cwiseAbs()) : random.uniformVector(0.1, 2.0);
  const Quaternion rotation =
      on_lattice ? Quaternion(1.0, 0.0, 0.0, random.half(1)) : random.rotation();
  const Target target = makeTarget(oriented, center, rotation, size);
  if (on_lattice && random.chance(0.5)) {
    const Vector3 origin = random.halves(3);
    const Vector3 direction = random.halves(2);
    return {target.box(), origin, direction, random.halves(3)};
  }
  return aim(random, target, random.chance(0.4) ? through(random) : anyGraze(random), 8.0, 2);
}

/// Makes it a segment of the smallest doubles, or nearly so: beside zeros its end is not its start.
void shrinkSegment(Random& random, Sample& sample) {
  static constexpr int kPowers[] = {-1074, -1074, -1060, -800};
  const int power = kPowers[random.below(4)];
  const bool at_zero = random.chance(0.7);
  for (int i = 0; i < 3; ++i) {
    sample.origin[i] = at_zero || random.chance(0.4) ? 0.0 : sample.origin[i];
    sample.end[i] = sample.origin[i] + std::ldexp(2.0 * random.half(4), power);
  }
}

void limitDirection(Random& random, Vector3& direction) {
  static constexpr int kWhole[] = {-200, -100, -20, 20, 100};
  static constexpr int kComponents[] = {-300, -200, -100, -60};
  direction = scaled(direction, near(random, kWhole));
  if (random.chance(0.4)) {
    direction[random.below(3)] = signedNear(random, kComponents);
  }
}

}  // namespace

Vector3 scaled(const Vector3& v, int power) {
  return {std::ldexp(v[0], power), std::ldexp(v[1], power), std::ldexp(v[2], power)};
}

void scalePlaces(Sample& sample, int power) {
  sample.origin = scaled(sample.origin, power);
  sample.end = scaled(sample.end, power);
  if (auto* box = std::get_if<AlignedBox>(&sample.box)) {
    *box = {scaled(box->min, power), scaled(box->max, power)};
  } else if (auto* turned = std::get_if<OrientedBox>(&sample.box)) {
    turned->center = scaled(turned->center, power);
    turned->half_extents = scaled(turned->half_extents, power);
  }
}

Sample stageLimits(Random& random, bool oriented) {
  static constexpr int kPlaces[] = {-800, -400, -200, -100, 40, 60, 100};
  static constexpr int kNorms[] = {-100, -50, 50, 100};
  Sample sample = around(random, oriented);
  if (random.chance(0.5)) {
    scalePlaces(sample, near(random, kPlaces));
  }
  if (random.chance(0.2)) {
    shrinkSegment(random, sample);
  }
  if (random.chance(0.6)) {
    limitDirection(random, sample.direction);
  }
  if (auto* box = std::get_if<OrientedBox>(&sample.box)) {
    if (random.chance(0.5)) {
      box->orientation.coeffs() *= std::ldexp(1.0, near(random, kNorms));
    }
    if (random.chance(0.2)) {
      box->orientation.z() = signedNear(random, kNorms);
    }
  }
  return sample;
}

SceneSample sceneLimits(Random& random) {
  static constexpr int kReaches[] = {20, 40, 60};
  static constexpr int kLengths[] = {-100, -20, 0, 20, 100};
  const int reach = near(random, kReaches);
  const bool around_zero = random.chance(0.5);
  const Vector3 middle = around_zero ? Vector3::Zero() : scaled(random.halves(4), reach);
  SceneSample scene;
  const int count = random.chance(0.5) ? random.between(1, 16) : random.between(17, 60);
  for (int i = 0; i < count; ++i) {
    // Most are large enough to be met from afar.
    const int power = reach - (random.chance(0.7) ? random.between(0, 3) : random.between(4, 40));
    const int farther = random.chance(0.05) ? random.between(1, 45) : 0;
    const Vector3 place = scaled(random.uniformVector(-1.0, 1.0), reach + farther);
    const Vector3 center{middle[0] + place[0], middle[1] + place[1], middle[2] + place[2]};
    const Vector3 size = scaled(random.uniformVector(0.0, 1.0), power);
    const bool oriented = random.chance(0.6);
    scene.boxes.push_back(makeTarget(oriented, center, random.rotation(), size).box());
  }
  for (int i = 0; i < 6; ++i) {
    const Box& box = scene.boxes[static_cast<std::size_t>(random.below(count))];
    const Target target = std::visit([](const auto& b) { return Target(b); }, box);
    const Contact contact = random.chance(0.5) ? through(random) : anyGraze(random);
    // The direction is about of unit length: from as far as the boxes are from each other.
    Sample sample = aim(random, target, contact, std::ldexp(1.0, reach + random.between(-1, 1)), 2);
    sample.direction = scaled(sample.direction, near(random, kLengths));
    scene.components.push_back(sample);
  }
  return scene;
}

}  // namespace box_query::stress
