// SPDX-License-Identifier: BSD-3-Clause
#include "stress/target.h"

namespace box_query::stress {
namespace {

Vector3 anyDirection(Random& random) {
  Vector3 result = random.uniformVector(-1.0, 1.0);
  for (int i = 0; i < 3; ++i) {
    result[i] += result[i] < 0.0 ? -0.01 : 0.01;
  }
  return result;
}

}  // namespace

Target::Target(const AlignedBox& box)
    : box_(box), columns_{Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()} {
  for (int i = 0; i < 3; ++i) {
    center_[i] = 0.5 * box.min[i] + 0.5 * box.max[i];
    half_extents_[i] = 0.5 * box.max[i] - 0.5 * box.min[i];
  }
}

Target::Target(const OrientedBox& box)
    : box_(box), center_(box.center), half_extents_(box.half_extents) {
  const Quaternion& q = box.orientation;
  double largest = 0.0;
  for (const double c : {q.w(), q.x(), q.y(), q.z()}) {
    largest = std::fmax(largest, std::fabs(c));
  }
  const int k = -std::ilogb(largest);
  const double w = std::ldexp(q.w(), k);
  const double x = std::ldexp(q.x(), k);
  const double y = std::ldexp(q.y(), k);
  const double z = std::ldexp(q.z(), k);
  const double n = ((w * w + x * x) + y * y) + z * z;
  columns_[0] = {(((w * w + x * x) - y * y) - z * z) / n, 2.0 * (x * y + w * z) / n,
                 2.0 * (x * z - w * y) / n};
  columns_[1] = {2.0 * (x * y - w * z) / n, (((w * w - x * x) + y * y) - z * z) / n,
                 2.0 * (y * z + w * x) / n};
  columns_[2] = {2.0 * (x * z + w * y) / n, 2.0 * (y * z - w * x) / n,
                 (((w * w - x * x) - y * y) + z * z) / n};
}

Vector3 Target::along(const Vector3& local) const {
  Vector3 result;
  for (int i = 0; i < 3; ++i) {
    result[i] = (columns_[0][i] * local[0] + columns_[1][i] * local[1]) + columns_[2][i] * local[2];
  }
  return result;
}

Vector3 Target::at(const Vector3& local) const {
  if (const auto* aligned = std::get_if<AlignedBox>(&box_)) {
    Vector3 result;
    for (int i = 0; i < 3; ++i) {
      // Exactly the bound where the local coordinate says so.
      if (local[i] == -1.0) {
        result[i] = aligned->min[i];
      } else if (local[i] == 1.0) {
        result[i] = aligned->max[i];
      } else {
        result[i] = center_[i] + local[i] * half_extents_[i];
      }
    }
    return result;
  }
  Vector3 scaled;
  for (int i = 0; i < 3; ++i) {
    scaled[i] = local[i] * half_extents_[i];
  }
  const Vector3 offset = along(scaled);
  return {center_[0] + offset[0], center_[1] + offset[1], center_[2] + offset[2]};
}

Target makeTarget(bool oriented, const Vector3& center, const Quaternion& rotation,
                  const Vector3& half_extents) {
  if (oriented) {
    return Target(OrientedBox{center, rotation, half_extents});
  }
  AlignedBox box;
  for (int i = 0; i < 3; ++i) {
    box.min[i] = center[i] - half_extents[i];
    box.max[i] = center[i] + half_extents[i];
  }
  return Target(box);
}

Contact grazingEdge(Random& random) {
  const auto [i, j, k] = random.axes();
  Contact contact;
  contact.place[i] = random.sign();
  contact.place[j] = random.sign();
  contact.place[k] = random.uniform(-1.2, 1.2);
  // In the plane across the edge the direction leaves one slab as it enters the other.
  contact.direction = anyDirection(random);
  const double turn = contact.place[i] * contact.place[j];
  contact.direction[i] = std::fabs(contact.direction[i]);
  contact.direction[j] = -turn * std::fabs(contact.direction[j]);
  if (random.chance(0.5)) {
    contact.direction = -contact.direction;
  }
  if (random.chance(0.3)) {
    contact.direction[k] = 0.0;
  }
  return contact;
}

Contact grazingCorner(Random& random) {
  Contact contact;
  contact.place = {random.sign(), random.sign(), random.sign()};
  contact.direction = anyDirection(random);
  const auto [i, j, k] = random.axes();
  // Not all outwards nor all inwards.
  if (contact.direction[i] * contact.place[i] * contact.direction[j] * contact.place[j] > 0.0 &&
      contact.direction[i] * contact.place[i] * contact.direction[k] * contact.place[k] > 0.0) {
    contact.direction[i] = -contact.direction[i];
  }
  return contact;
}

Contact inFacePlane(Random& random) {
  const auto [i, j, k] = random.axes();
  Contact contact;
  contact.place[i] = random.sign();
  contact.place[j] = random.uniform(-1.2, 1.2);
  contact.place[k] = random.uniform(-1.2, 1.2);
  contact.direction = anyDirection(random);
  contact.direction[i] = 0.0;
  return contact;
}

Contact through(Random& random) {
  return {random.uniformVector(-1.3, 1.3), anyDirection(random)};
}

Contact anyGraze(Random& random) {
  switch (random.below(4)) {
    case 0:
      return grazingCorner(random);
    case 1:
      return inFacePlane(random);
    default:
      return grazingEdge(random);
  }
}

Vector3 onRay(const Vector3& p, double t, const Vector3& d) {
  return {p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2]};
}

Sample aim(Random& random, const Target& target, const Contact& contact, double reach, int ulps) {
  const Vector3 place = target.at(contact.place);
  const Vector3 direction = target.along(contact.direction);
  const int farthest = std::ilogb(reach) + 1;
  double t = random.chance(0.5) ? random.uniform(0.0, reach)
                                : std::ldexp(1.0, random.between(std::min(-2, farthest), farthest));
  if (random.chance(0.15)) {
    t = random.chance(0.5) ? -t : 0.0;
  }
  Sample sample{target.box(), onRay(place, -t, direction), direction, place};
  sample.origin = random.nudged(sample.origin, ulps);
  if (random.chance(0.5)) {
    sample.direction = random.nudged(sample.direction, ulps);
  }
  const double length = t != 0.0 ? 2.0 * t : 1.0;
  if (random.chance(0.8)) {
    sample.end = onRay(sample.origin, random.uniform(0.3, 1.3) * length, sample.direction);
  }
  sample.end = random.nudged(sample.end, ulps);
  return sample;
}

}  // namespace box_query::stress
