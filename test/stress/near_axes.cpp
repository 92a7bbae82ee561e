// SPDX-License-Identifier: BSD-3-Clause
#include "stress/near_axes.h"

#include <cmath>

namespace box_query::stress {
namespace {

/// Of about 1e-16 to 1e-3.
double hardlyAny(Random& random) {
  return random.chance(0.3) ? 0.0 : random.signedMagnitude(-54, -10);
}

/// Quarter turns, and next to nothing besides.
Quaternion nearQuarterTurns(Random& random) {
  const Quaternion q = quarterTurns(random);
  const double x = hardlyAny(random);
  const double y = hardlyAny(random);
  const double z = hardlyAny(random);
  // The product q (1, x, y, z), in a fixed order.
  return {
      ((q.w() - q.x() * x) - q.y() * y) - q.z() * z, ((q.x() + q.w() * x) + q.y() * z) - q.z() * y,
      ((q.y() + q.w() * y) + q.z() * x) - q.x() * z, ((q.z() + q.w() * z) + q.x() * y) - q.y() * x};
}

/// A place of a box, by local coordinates of which at least one is on a face.
Vector3 onFace(Random& random) {
  Vector3 place;
  for (int i = 0; i < 3; ++i) {
    place[i] = random.chance(0.4) ? random.sign() : random.uniform(-1.1, 1.1);
  }
  place[random.below(3)] = random.sign();
  return place;
}

double decimalSize(Random& random) {
  return static_cast<double>(random.between(1, 10)) / 10.0;
}

}  // namespace

Quaternion quarterTurns(Random& random) {
  static const double kQuaternions[5][4] = {
      {1, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 0}, {0, 1, 1, 0}, {1, 1, 1, 1}};
  const auto& row = kQuaternions[random.below(5)];
  const auto [i, j, k] = random.axes();
  Vector3 u;
  u[i] = random.sign() * row[1];
  u[j] = random.sign() * row[2];
  u[k] = random.sign() * row[3];
  return {row[0], u[0], u[1], u[2]};
}

double decimal(Random& random, int limit) {
  return static_cast<double>(random.between(-10 * limit, 10 * limit)) / 10.0;
}

Sample nearlyAligned(Random& random, bool oriented) {
  const Vector3 center = random.chance(0.5) ? random.halves(4) : random.uniformVector(-5.0, 5.0);
  const Vector3 size = random.uniformVector(0.1, 2.0);
  const Target target = makeTarget(oriented, center, nearQuarterTurns(random), size);
  const auto [i, j, k] = random.axes();
  Contact contact;
  contact.place = onFace(random);
  contact.direction[i] = random.sign();
  contact.direction[j] = hardlyAny(random);
  contact.direction[k] = random.chance(0.5) ? hardlyAny(random) : random.uniform(-1.0, 1.0);
  Sample sample = aim(random, target, contact, std::ldexp(1.0, random.between(0, 12)), 1);
  if (random.chance(0.3)) {
    // Exactly along the axes of the world.
    for (int axis = 0; axis < 3; ++axis) {
      if (std::fabs(sample.direction[axis]) < 0x1p-8) {
        sample.direction[axis] = 0.0;
        sample.end[axis] = sample.origin[axis];
      }
    }
  }
  return sample;
}

TurnedShelf::TurnedShelf(Random& random, bool oriented)
    : rotation_(random.rotation()), oriented_(oriented), middle_(AlignedBox{{0, 0, 0}, {0, 0, 0}}) {
  if (random.chance(0.6)) {
    rotation_.x() = 0.0;  // it stands upright
    rotation_.y() = 0.0;
    rotation_.w() += rotation_.w() < 0.0 ? -0.1 : 0.1;
  }
  for (double& size : numbersOf(half_extents_)) {
    size = decimalSize(random);
  }
  const double x = decimal(random, 5);
  const double y = decimal(random, 5);
  const Vector3 center{x, y, decimal(random, 1)};
  middle_ = makeTarget(oriented_, center, rotation_, half_extents_);
}

Target TurnedShelf::boxAt(const Vector3& cell) const {
  return makeTarget(oriented_, middle_.at(2.0 * cell), rotation_, half_extents_);
}

Sample TurnedShelf::along(Random& random, const Vector3& cell) const {
  Contact contact;
  for (int i = 0; i < 3; ++i) {
    const double place = random.chance(0.6) ? random.sign() : random.uniform(-1.3, 1.3);
    contact.place[i] = 2.0 * cell[i] + place;
    contact.direction[i] = random.chance(0.5) ? 0.0 : decimal(random, 1);
  }
  contact.direction[random.below(3)] = random.sign();
  return aim(random, middle_, contact, 16.0, random.chance(0.5) ? 0 : 1);
}

Sample turnedShelves(Random& random, bool oriented) {
  const TurnedShelf shelf(random, oriented);
  const double column = random.between(-3, 3);
  const double row = random.between(0, 1);
  const Vector3 cell{column, row, static_cast<double>(random.between(0, 3))};
  Sample sample = shelf.along(random, cell);
  sample.box = shelf.boxAt(cell).box();
  return sample;
}

Sample hardlySloping(Random& random, bool oriented) {
  const Vector3 center = random.chance(0.5) ? random.halves(4) : random.uniformVector(-5.0, 5.0);
  const Quaternion rotation = random.chance(0.7) ? quarterTurns(random) : random.rotation();
  const Target target = makeTarget(oriented, center, rotation, random.uniformVector(0.1, 2.0));
  const auto [i, j, k] = random.axes();
  Vector3 direction;
  direction[i] = random.sign();
  direction[i] *= random.uniform(0.5, 2.0);
  direction[j] = direction[i] * random.signedMagnitude(-60, -27);
  direction[k] = random.chance(0.5) ? random.chance(0.5) ? 0.0 : random.uniform(-0.5, 0.5)
                                    : direction[i] * random.signedMagnitude(-60, -27);
  const Vector3 place = target.at(onFace(random));
  const double t = random.magnitude(-1, 24);
  Sample sample{target.box(), onRay(place, -t, direction), direction, place};
  sample.origin = random.nudged(sample.origin, 1);
  if (random.chance(0.8)) {
    sample.end = onRay(sample.origin, random.uniform(0.3, 1.8) * t, direction);
  }
  return sample;
}

}  // namespace box_query::stress
