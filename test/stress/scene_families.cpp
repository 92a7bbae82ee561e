// SPDX-License-Identifier: BSD-3-Clause
#include "stress/scene_families.h"

#include "stress/families.h"
#include "stress/limits.h"
#include "stress/near_axes.h"
#include "stress/random.h"

#include <cmath>
#include <utility>
#include <variant>

namespace box_query::stress {
namespace {

/// Mostly a shelf's worth of boxes, at times enough for any index to have some depth.
int boxCount(Random& random) {
  if (random.chance(0.02)) {
    return random.between(100, 300);
  }
  return random.chance(0.3) ? random.between(1, 9) : random.between(10, 40);
}

Target targetOf(const Box& box) {
  return std::visit([](const auto& b) { return Target(b); }, box);
}

/// Components that graze boxes of the scene or pass through them.
void aimAtBoxes(Random& random, SceneSample& scene, int ulps) {
  const int count = scene.boxes.size() > 50 ? 2 : 6;
  for (int i = 0; i < count; ++i) {
    const Box& box =
        scene.boxes[static_cast<std::size_t>(random.below(static_cast<int>(scene.boxes.size())))];
    const Contact contact = random.chance(0.5) ? through(random) : anyGraze(random);
    scene.components.push_back(aim(random, targetOf(box), contact, 10.0, ulps));
  }
}

SceneSample uniform(Random& random) {
  SceneSample scene;
  for (int i = boxCount(random); i > 0; --i) {
    const Vector3 center = random.uniformVector(-5.0, 5.0);
    const Vector3 size = random.uniformVector(0.1, 1.5);
    const bool oriented = random.chance(0.7);
    scene.boxes.push_back(makeTarget(oriented, center, random.rotation(), size).box());
  }
  aimAtBoxes(random, scene, 0);
  return scene;
}

/// Boards and uprights on decimal coordinates that share their faces' planes; components in them.
SceneSample shelves(Random& random) {
  SceneSample scene;
  const int columns = random.between(1, 4);
  const int rows = random.between(1, 4);
  const bool oriented = random.chance(0.5);
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      const Vector3 center{0.9 * column, 0.0, 0.4 * row};
      scene.boxes.push_back(makeTarget(oriented && random.chance(0.7), center,
                                       Quaternion(1.0, 0.0, 0.0, 0.0), Vector3(0.45, 0.3, 0.02))
                                .box());
      const Vector3 upright{0.9 * column - 0.45, 0.0, 0.4 * row + 0.2};
      scene.boxes.push_back(makeTarget(oriented && random.chance(0.7), upright,
                                       Quaternion(1.0, 0.0, 0.0, 1.0), Vector3(0.3, 0.02, 0.2))
                                .box());
    }
  }
  for (int i = 0; i < 6; ++i) {
    const auto pick = static_cast<std::size_t>(random.below(static_cast<int>(scene.boxes.size())));
    const Target target = targetOf(scene.boxes[pick]);
    Sample sample{target.box(), Vector3(), Vector3(), Vector3()};
    for (int axis = 0; axis < 3; ++axis) {
      const double side = random.sign();
      const Vector3 face = target.at(Vector3(side, side, side));
      sample.origin[axis] = random.chance(0.7) ? face[axis] : random.uniform(-2.0, 4.0);
      sample.direction[axis] = random.chance(0.6) ? 0.0 : random.sign();
    }
    sample.origin = onRay(sample.origin, random.chance(0.7) ? -5.0 : 0.0, sample.direction);
    sample.end = onRay(sample.origin, random.uniform(0.0, 12.0), sample.direction);
    scene.components.push_back(sample);
  }
  return scene;
}

/// Everything on a small lattice: boxes touch each other, components touch boxes, distances tie.
SceneSample lattice(Random& random) {
  SceneSample scene;
  for (int i = boxCount(random); i > 0; --i) {
    const Vector3 center = random.halves(3);
    const Vector3 size = random.halves(1).cwiseAbs();
    Quaternion rotation(1.0, 0.0, 0.0, 0.0);
    if (random.chance(0.5)) {
      rotation = Quaternion{1.0 + random.below(2), 0.0, 0.0, random.half(1)};
    }
    scene.boxes.push_back(makeTarget(random.chance(0.5), center, rotation, size).box());
  }
  for (int i = 0; i < 6; ++i) {
    scene.components.push_back(
        Sample{scene.boxes[0], random.halves(5), random.halves(1), random.halves(5)});
  }
  return scene;
}

/// The same solid in other numbers.
OrientedBox rewritten(Random& random, const OrientedBox& box) {
  OrientedBox result = box;
  const Quaternion& q = box.orientation;
  switch (random.below(4)) {
    case 0:
      result.orientation.coeffs() = -q.coeffs();
      break;
    case 1:
      result.orientation.coeffs() *= std::ldexp(1.0, random.between(-20, 20));
      break;
    case 2:  // q times i
      result.orientation = Quaternion(-q.x(), q.w(), q.z(), -q.y());
      break;
    default:
      break;
  }
  return result;
}

/// Few solids, many times over.
SceneSample duplicates(Random& random) {
  SceneSample scene;
  std::vector<OrientedBox> solids;
  for (int i = random.between(1, 4); i > 0; --i) {
    const Vector3 center = random.uniformVector(-2.0, 2.0);
    const Quaternion rotation = random.rotation();
    solids.push_back({center, rotation, random.uniformVector(0.1, 1.5)});
  }
  for (int i = boxCount(random); i > 0; --i) {
    const auto pick = static_cast<std::size_t>(random.below(static_cast<int>(solids.size())));
    scene.boxes.emplace_back(rewritten(random, solids[pick]));
  }
  aimAtBoxes(random, scene, 1);
  return scene;
}

/// Copies of one box, each number up to an ulp off: entries and distances that nearly tie.
SceneSample nearTies(Random& random) {
  SceneSample scene;
  const Vector3 center = random.uniformVector(-5.0, 5.0);
  const Quaternion rotation = random.rotation();
  const Vector3 size = random.uniformVector(0.1, 1.5);
  const bool oriented = random.chance(0.7);
  for (int i = boxCount(random); i > 0; --i) {
    Box box = makeTarget(oriented, random.nudged(center, 1), rotation, size).box();
    if (auto* turned = std::get_if<OrientedBox>(&box)) {
      turned->half_extents = random.nudged(size, 1);
      turned->orientation.x() = random.nudged(rotation.x(), 1);
    }
    scene.boxes.push_back(box);
  }
  aimAtBoxes(random, scene, 1);
  return scene;
}

/// Boxes of all sizes around one place, far from the origin of the map.
SceneSample farNest(Random& random) {
  SceneSample scene;
  Vector3 place;
  for (double& coordinate : numbersOf(place)) {
    coordinate = random.signedMagnitude(10, 25);
  }
  for (int i = boxCount(random); i > 0; --i) {
    const Vector3 center = random.chance(0.5) ? place : random.nudged(place, 4);
    Vector3 size;
    for (double& extent : numbersOf(size)) {
      extent = random.chance(0.1) ? 0.0 : random.magnitude(-6, 3);
    }
    const bool oriented = random.chance(0.7);
    scene.boxes.push_back(makeTarget(oriented, center, random.rotation(), size).box());
  }
  aimAtBoxes(random, scene, 2);
  return scene;
}

/// Boxes of the pairs' families, with their components.
SceneSample hostilePairs(Random& random) {
  SceneSample scene;
  const auto families = static_cast<int>(familyNames().size());
  const int family = random.below(families);
  const int count = random.between(1, 30);
  for (int i = 0; i < count; ++i) {
    const int own = random.chance(0.8) ? family : random.below(families);
    const bool oriented = random.chance(0.5);
    const std::uint64_t seed = random.bits();
    const Sample sample = makeSample(static_cast<std::size_t>(own), oriented, seed, 0);
    scene.boxes.push_back(sample.box);
    if (i < 6) {
      scene.components.push_back(sample);
    }
  }
  return scene;
}

/// A shelf that stands askew: at most of its planes many boxes tie, or nearly.
SceneSample turnedShelf(Random& random) {
  SceneSample scene;
  const TurnedShelf shelf(random, random.chance(0.8));
  const int columns = random.between(1, 8);
  const int rows = random.between(1, 2);
  const int layers = random.between(1, 4);
  const auto cellOf = [&](int i) {
    return Vector3(i % columns, i / columns % rows, i / (columns * rows));
  };
  const int count = columns * rows * layers;
  for (int i = 0; i < count; ++i) {
    if (i == 0 || random.chance(0.9)) {
      scene.boxes.push_back(shelf.boxAt(cellOf(i)).box());
    }
  }
  for (int i = 0; i < 6; ++i) {
    scene.components.push_back(shelf.along(random, cellOf(random.below(count))));
  }
  return scene;
}

/// Scenes of any size, and rays whose directions are of any length: all times powers of two, so
/// that what ties still does.
SceneSample unusual(Random& random) {
  SceneSample scene = random.chance(0.5) ? nearTies(random) : lattice(random);
  const double size = std::ldexp(1.0, random.chance(0.5) ? 0 : random.between(-60, 60));
  for (Box& any : scene.boxes) {
    if (auto* aligned = std::get_if<AlignedBox>(&any)) {
      aligned->min *= size;
      aligned->max *= size;
    } else {
      auto& oriented = std::get<OrientedBox>(any);
      oriented.center *= size;
      oriented.half_extents *= size;
    }
  }
  for (Sample& sample : scene.components) {
    sample.origin *= size;
    sample.end *= size;
    sample.direction *= std::ldexp(1.0, random.between(-90, 90));
  }
  return scene;
}

/// Thousands of boxes on a lattice, each with its mirror image: what is entered first, and what is
/// nearest, is so with others at the far end of the scene, of far higher numbers.
SceneSample large(Random& random) {
  SceneSample scene;
  const int pairs = random.between(500, 2500);
  const bool oriented = random.chance(0.5);
  const Random start(random.bits(), 0, 0);
  for (const double side : {1.0, -1.0}) {
    Random same = start;
    for (int i = 0; i < pairs; ++i) {
      Vector3 center = same.halves(40);
      Vector3 size = same.halves(1).cwiseAbs();
      if (same.chance(0.04)) {
        size[same.between(1, 2)] = 30.0;  // a board: its front is that of others
      }
      center[1] = side * (std::fabs(center[1]) + 1.0);
      const Quaternion turn(1.0, 0.0, 0.0, same.chance(0.2) ? side : 0.0);
      scene.boxes.push_back(makeTarget(oriented, center, turn, size).box());
    }
  }
  for (int i = 0; i < 6; ++i) {
    Sample sample{scene.boxes[0], random.halves(40), random.halves(2), random.halves(40)};
    // In the plane of the mirror, where ends of long boards meet, and elsewhere.
    if (random.chance(0.7)) {
      sample.origin[1] = 0.0;
      sample.direction[1] = 0.0;
      sample.end[1] = 0.0;
    }
    scene.components.push_back(sample);
  }
  return scene;
}

/// A box turned by the angle of sine 4/5, and points outside it along the normal of a face, which
/// has length 5, or along (-7, 24) from an edge, which has length 25: distances and ranges are
/// halfway between two doubles, or off that by 2^-49 to 2^-116.
SceneSample midpoints(Random& random) {
  SceneSample scene;
  const bool of_edge = random.chance(0.5);
  const Vector3 away = of_edge ? Vector3(-7.0, 24.0, 0.0) : Vector3(3.0, 4.0, 0.0);
  const Vector3 corner = of_edge ? Vector3(-0.25, 1.75, 0.0) : Vector3(0.0, 0.0, 0.0);
  const double side = random.sign();
  const double off = random.chance(0.4) ? 0.0 : std::ldexp(side, -random.between(54, 118));
  Quaternion turn(2.0, 0.0, 0.0, 1.0);
  turn.coeffs() *= random.magnitude(-20, 20);
  const OrientedBox box{off * away, turn, Vector3(1.25, 1.25, 4.0)};
  scene.boxes.emplace_back(box);
  for (int i = random.chance(0.4) ? 0 : boxCount(random); i > 0; --i) {
    const Vector3 center = random.uniformVector(-30.0, 30.0) + Vector3(0.0, 0.0, 400.0);
    const Quaternion rotation = random.rotation();
    scene.boxes.push_back(
        makeTarget(random.chance(0.7), center, rotation, Vector3(1.0, 1.0, 1.0)).box());
  }
  for (int i = 0; i < 6; ++i) {
    // 25 or 5 times it is an odd multiple of half an ulp.
    const int digits = of_edge ? 48 : 50;
    const double times =
        std::floor(std::ldexp(random.uniform(of_edge ? 1.3 : 1.9, 2.0), digits - 1));
    const double length = std::ldexp(2.0 * times + 1.0, -digits);
    const Vector3 place = corner + length * away + Vector3(0.0, 0.0, random.half(1));
    Sample sample{box, place, random.sign() * away, place};
    if (of_edge) {
      const Vector3 across(24.0, 7.0, 0.0);
      sample.origin -= std::ldexp(random.below(512), -10) * across;
      sample.end += std::ldexp(random.below(512), -10) * across;
    } else if (random.chance(0.8)) {
      const Vector3 further = away + Vector3(0.0, 0.0, random.half(1));
      sample.end += random.uniform(0.0, 2.0) * further;
    }
    scene.components.push_back(sample);
  }
  return scene;
}

struct SceneFamily {
  const char* name;
  SceneSample (*make)(Random& random);
  std::uint64_t worth;  ///< how many scenes of others take as long
};

const SceneFamily kFamilies[] = {
    {"scene_uniform", uniform, 1},      {"scene_shelves", shelves, 1},
    {"scene_lattice", lattice, 1},      {"scene_duplicates", duplicates, 1},
    {"scene_near_ties", nearTies, 1},   {"scene_far_nest", farNest, 1},
    {"scene_hostile", hostilePairs, 1}, {"scene_turned_shelf", turnedShelf, 1},
    {"scene_limits", sceneLimits, 1},   {"scene_unusual", unusual, 1},
    {"scene_large", large, 40},         {"scene_midpoints", midpoints, 1},
};

}  // namespace

const std::vector<std::string>& sceneFamilyNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const SceneFamily& family : kFamilies) {
      result.emplace_back(family.name);
    }
    return result;
  }();
  return names;
}

std::uint64_t sceneCount(std::size_t family, std::uint64_t scenes) {
  const std::uint64_t share = sceneFamilyNames().size() * kFamilies[family].worth;
  return (scenes + share - 1) / share;
}

SceneSample makeScene(std::size_t family, std::uint64_t seed, std::uint64_t index) {
  Random random(seed, 2000 + family, index);
  return kFamilies[family].make(random);
}

}  // namespace box_query::stress
