// SPDX-License-Identifier: BSD-3-Clause
#include "stress/families.h"

#include "stress/limits.h"
#include "stress/near_axes.h"
#include "stress/random.h"

#include <algorithm>

namespace box_query::stress {
namespace {

Vector3 ordinarySize(Random& random) {
  return random.uniformVector(0.1, 2.0);
}

Target ordinaryTarget(Random& random, bool oriented) {
  const Vector3 center = random.uniformVector(-5.0, 5.0);
  const Quaternion rotation = random.rotation();
  return makeTarget(oriented, center, rotation, ordinarySize(random));
}

Sample ordinary(Random& random, bool oriented) {
  const Target target = ordinaryTarget(random, oriented);
  return aim(random, target, through(random), 10.0, 0);
}

Sample nearParallel(Random& random, bool oriented) {
  const Target target = ordinaryTarget(random, oriented);
  Contact contact = inFacePlane(random);
  const auto [i, j, k] = random.axes();
  contact.direction = Vector3::Zero();
  contact.direction[i] = random.sign();
  contact.direction[j] = random.signedMagnitude(-57, -10);
  contact.direction[k] = random.chance(0.5) ? 0.0 : random.signedMagnitude(-57, -10);
  contact.place[j] = random.sign();
  contact.place[k] = random.chance(0.3) ? random.sign() : random.uniform(-1.0, 1.0);
  return aim(random, target, contact, 64.0, 4);
}

Sample grazing(Random& random, bool oriented) {
  const Target target = ordinaryTarget(random, oriented);
  return aim(random, target, anyGraze(random), 10.0, 4);
}

/// Small numbers on a lattice, at any scale: what touches does so exactly.
Sample exactTouch(Random& random, bool oriented) {
  Quaternion rotation(1.0, 0.0, 0.0, 0.0);
  if (oriented && random.chance(0.7)) {
    do {
      const double w = random.half(1);
      const Vector3 u = random.chance(0.5) ? Vector3(0.0, 0.0, random.half(1)) : random.halves(1);
      rotation = Quaternion(w, u[0], u[1], u[2]);
    } while ((rotation.coeffs().array() == 0.0).all());
  }
  const Vector3 center = random.halves(1);
  const Target target = makeTarget(oriented, center, rotation, random.halves(2).cwiseAbs());
  Sample sample{target.box(), random.halves(3), random.halves(2), random.halves(3)};
  const int power = random.chance(0.5) ? 0 : random.between(-30, 30);
  scalePlaces(sample, power);
  sample.direction = scaled(sample.direction, power);
  return sample;
}

Sample offset(Random& random, bool oriented) {
  Vector3 center;
  for (int i = 0; i < 3; ++i) {
    center[i] = random.signedMagnitude(10, 30);
  }
  const Quaternion rotation = random.rotation();
  const Target target = makeTarget(oriented, center, rotation, ordinarySize(random));
  return aim(random, target, random.chance(0.5) ? through(random) : anyGraze(random), 10.0, 2);
}

/// Along an axis of the box from far away, near the planes of its faces.
Sample farAndParallel(Random& random, bool oriented) {
  const Target target = ordinaryTarget(random, oriented);
  const auto [i, j, k] = random.axes();
  Contact contact;
  contact.direction = Vector3::Zero();
  contact.direction[i] = random.sign();
  contact.place[i] = -contact.direction[i];
  contact.place[j] = 1.0 + random.signedMagnitude(-52, -20);
  contact.place[j] *= random.sign();
  contact.place[k] = random.uniform(-1.0, 1.0);
  Sample sample = aim(random, target, contact, random.magnitude(10, 20), 2);
  if (random.chance(0.5)) {
    sample.direction = target.along(contact.direction);  // as doubles have the axis
  }
  return sample;
}

Sample extents(Random& random, bool oriented) {
  Vector3 size;
  for (int i = 0; i < 3; ++i) {
    size[i] = random.chance(0.25) ? 0.0 : random.magnitude(-30, 20);
  }
  const Vector3 center = random.chance(0.2) ? Vector3::Zero() : random.uniformVector(-5.0, 5.0);
  const Quaternion rotation =
      random.chance(0.3) ? Quaternion(1.0, 0.0, 0.0, 0.0) : random.rotation();
  const Target target = makeTarget(oriented, center, rotation, size);
  return aim(random, target, random.chance(0.5) ? through(random) : anyGraze(random), 10.0, 1);
}

Sample directions(Random& random, bool oriented) {
  const Target target = ordinaryTarget(random, oriented);
  Sample sample =
      aim(random, target, random.chance(0.3) ? through(random) : anyGraze(random), 10.0, 2);
  sample.direction = scaled(sample.direction, random.between(-996, 996));
  if (random.chance(0.2)) {
    const int axis = random.below(3);
    sample.direction[axis] = std::ldexp(sample.direction[axis], random.between(-60, 20));
  }
  if (random.chance(0.3)) {
    // A segment far shorter or longer than its box.
    const int power = random.chance(0.5) ? random.between(-80, -1) : random.between(1, 900);
    sample.end = onRay(sample.origin, std::ldexp(1.0, power),
                       {sample.end[0] - sample.origin[0], sample.end[1] - sample.origin[1],
                        sample.end[2] - sample.origin[2]});
  }
  return sample;
}

/// An exact touch or a graze, so small that its numbers lose bits, or all but a few.
Sample denormals(Random& random, bool oriented) {
  Sample sample = random.chance(0.5) ? exactTouch(random, oriented) : grazing(random, oriented);
  const int power = random.between(-1074, -1000);
  scalePlaces(sample, power);
  sample.direction =
      scaled(sample.direction, random.chance(0.5) ? power : random.between(-1074, 0));
  return sample;
}

Target turnedTarget(Random& random, bool oriented, const Vector3& center, const Vector3& size) {
  return makeTarget(oriented, center, quarterTurns(random), size);
}

Sample axisParallel(Random& random, bool oriented) {
  const Vector3 center = random.chance(0.5) ? random.halves(4) : random.uniformVector(-5.0, 5.0);
  const Target target = turnedTarget(random, oriented, center, ordinarySize(random));
  Contact contact;
  for (int i = 0; i < 3; ++i) {
    contact.place[i] = random.chance(0.5) ? random.sign() : random.uniform(-1.1, 1.1);
    contact.direction[i] = random.uniform(-1.0, 1.0);
  }
  const auto [i, j, k] = random.axes();
  contact.direction[i] = random.sign();
  contact.direction[j] = 0.0;
  if (random.chance(0.7)) {
    contact.direction[k] = 0.0;
  }
  Sample sample = aim(random, target, contact, 16.0, 1);
  // Zeros of both signs, and no denormal in place of a zero.
  for (int axis = 0; axis < 3; ++axis) {
    if (std::fabs(sample.direction[axis]) < 0x1p-500) {
      sample.direction[axis] = std::copysign(0.0, random.sign());
      if (random.chance(0.8)) {
        sample.end[axis] = sample.origin[axis];
      }
    }
  }
  return sample;
}

Vector3 onOrInBox(Random& random, const Target& target, int ulps) {
  Vector3 place;
  for (int i = 0; i < 3; ++i) {
    place[i] = random.chance(0.4) ? random.sign() : random.uniform(-1.0, 1.0);
  }
  if (random.chance(0.1)) {
    place[random.below(3)] = random.uniform(-1.2, 1.2);
  }
  return random.nudged(target.at(place), ulps);
}

Target anyTarget(Random& random, bool oriented) {
  if (random.chance(0.3)) {
    const Vector3 center = random.halves(2);
    return turnedTarget(random, oriented, center, random.halves(2).cwiseAbs());
  }
  return ordinaryTarget(random, oriented);
}

Sample zeroLength(Random& random, bool oriented) {
  const Target target = anyTarget(random, oriented);
  const Vector3 place = onOrInBox(random, target, 2);
  Sample sample{target.box(), place, Vector3::Zero(), place};
  for (int i = 0; i < 3; ++i) {
    sample.direction[i] = std::copysign(0.0, random.sign());
  }
  if (random.chance(0.2)) {
    sample.end = random.nudged(place, 1);  // a segment that is hardly more
    sample.direction[random.below(3)] = std::numeric_limits<double>::denorm_min();
  }
  return sample;
}

Sample originOnBox(Random& random, bool oriented) {
  const Target target = anyTarget(random, oriented);
  const Contact contact = random.chance(0.5) ? anyGraze(random) : through(random);
  const Vector3 direction = target.along(contact.direction);
  const Vector3 origin = onOrInBox(random, target, 1);
  Sample sample{target.box(), origin, direction,
                onRay(origin, random.uniform(0.0, 3.0), direction)};
  if (random.chance(0.3)) {
    sample.end = onOrInBox(random, target, 1);
  }
  if (random.chance(0.3)) {
    std::swap(sample.origin, sample.end);
  }
  return sample;
}

Sample quaternionOffUnit(Random& random, bool oriented) {
  Quaternion rotation = random.rotation();
  const double factor = random.chance(0.5) ? random.uniform(0.99, 1.01) : random.magnitude(-40, 40);
  rotation.coeffs() *= factor;
  const Vector3 center = random.uniformVector(-5.0, 5.0);
  const Target target = makeTarget(oriented, center, rotation, ordinarySize(random));
  return aim(random, target, anyGraze(random), 10.0, 4);
}

/// Along a box axis as doubles have it, at any distance: well inside, or by a face.
Sample roundedAxis(Random& random, bool oriented) {
  const Target target = ordinaryTarget(random, oriented);
  Contact contact;
  contact.direction = Vector3::Zero();
  contact.direction[random.below(3)] = random.sign();
  for (int i = 0; i < 3; ++i) {
    contact.place[i] = random.chance(0.3) ? random.sign() : random.uniform(-1.05, 1.05);
  }
  return aim(random, target, contact, random.magnitude(0, 12), 0);
}

/// Boards on decimal coordinates, rays in the planes of their faces.
Sample shelves(Random& random, bool oriented) {
  const Vector3 center{decimal(random, 3), decimal(random, 3), decimal(random, 3)};
  Vector3 size;
  for (int i = 0; i < 3; ++i) {
    size[i] = std::fabs(decimal(random, 1));
  }
  const Target target = turnedTarget(random, oriented, center, size);
  Sample sample{target.box(), Vector3(), Vector3(), Vector3()};
  for (int i = 0; i < 3; ++i) {
    const double side = random.sign();
    const Vector3 face = target.at(Vector3(side, side, side));
    sample.origin[i] = random.chance(0.6) ? face[i] : decimal(random, 3);
    sample.direction[i] = random.chance(0.5) ? 0.0 : decimal(random, 1);
    sample.end[i] = random.chance(0.5) ? sample.origin[i] : decimal(random, 3);
  }
  if (random.chance(0.5)) {
    // From outside, so that entering decides.
    sample.origin = onRay(sample.origin, -4.0, sample.direction);
    sample.end = onRay(sample.origin, 8.0, sample.direction);
  }
  return sample;
}

/// Every number of a magnitude of its own, out of all that there are.
Sample wholeRange(Random& random, bool oriented) {
  const auto anything = [&random] { return random.signedMagnitude(-1070, 1020); };
  Sample sample;
  Vector3 center;
  Vector3 size;
  for (int i = 0; i < 3; ++i) {
    center[i] = random.chance(0.5) ? 0.0 : anything();
    size[i] = random.chance(0.6) ? std::fabs(anything()) : random.magnitude(900, 1020);
  }
  Quaternion rotation = random.chance(0.4) ? quarterTurns(random) : random.rotation();
  if (random.chance(0.3)) {
    rotation.coeffs() *= random.magnitude(-1000, 1000);
  }
  if (random.chance(0.2)) {
    rotation.coeffs()[random.below(4)] = anything();
  }
  const Target target = makeTarget(oriented, center, rotation, size);
  sample.box = target.box();
  const Vector3 place = target.at({random.sign(), random.sign(), random.sign()});
  for (int i = 0; i < 3; ++i) {
    sample.origin[i] =
        random.chance(0.3) ? anything() : (random.chance(0.5) ? place[i] : center[i]);
    sample.direction[i] = random.chance(0.2) ? 0.0 : anything();
    sample.end[i] = random.chance(0.4) ? anything() : (random.chance(0.5) ? place[i] : center[i]);
  }
  if (random.chance(0.5)) {
    const auto [i, j, k] = random.axes();
    sample.direction[i] = place[i] - sample.origin[i];
    sample.direction[j] = place[j] - sample.origin[j];
    sample.direction[k] = random.chance(0.5) ? place[k] - sample.origin[k] : 0.0;
  }
  return sample;
}

struct Family {
  const char* name;
  Sample (*make)(Random& random, bool oriented);
};

const Family kFamilies[] = {
    {"random", ordinary},
    {"near_parallel", nearParallel},
    {"grazing", grazing},
    {"exact_touch", exactTouch},
    {"offset", offset},
    {"far_parallel", farAndParallel},
    {"extents", extents},
    {"directions", directions},
    {"denormals", denormals},
    {"axis_parallel", axisParallel},
    {"zero_length", zeroLength},
    {"origin_on_box", originOnBox},
    {"quaternion_off_unit", quaternionOffUnit},
    {"rounded_axis", roundedAxis},
    {"shelves", shelves},
    {"whole_range", wholeRange},
    {"nearly_aligned", nearlyAligned},
    {"turned_shelves", turnedShelves},
    {"hardly_sloping", hardlySloping},
    {"stage_limits", stageLimits},
};

Vector3 finite(const Vector3& v) {
  Vector3 result = v;
  for (double& x : numbersOf(result)) {
    if (std::isnan(x)) {
      x = 0.0;
    } else if (std::isinf(x)) {
      x = std::copysign(std::numeric_limits<double>::max(), x);
    }
  }
  return result;
}

}  // namespace

const std::vector<std::string>& familyNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const Family& family : kFamilies) {
      result.emplace_back(family.name);
    }
    return result;
  }();
  return names;
}

Sample makeSample(std::size_t family, bool oriented, std::uint64_t seed, std::uint64_t index) {
  Random random(seed, 2 * family + (oriented ? 1 : 0), index);
  Sample sample = kFamilies[family].make(random, oriented);
  sample.origin = finite(sample.origin);
  sample.direction = finite(sample.direction);
  sample.end = finite(sample.end);
  if (auto* box = std::get_if<AlignedBox>(&sample.box)) {
    *box = {finite(box->min), finite(box->max)};
  } else if (auto* turned = std::get_if<OrientedBox>(&sample.box)) {
    turned->center = finite(turned->center);
    turned->half_extents = finite(turned->half_extents);
    for (double& c : numbersOf(turned->orientation.coeffs())) {
      c = std::min(std::max(c, -0x1p1023), 0x1p1023);
    }
    if ((turned->orientation.coeffs().array() == 0.0).all()) {
      turned->orientation = Quaternion(1.0, 0.0, 0.0, 0.0);
    }
  }
  return sample;
}

}  // namespace box_query::stress
