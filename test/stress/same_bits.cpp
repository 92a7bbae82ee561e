// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Prints a hash of all answers over the families, and of the questions: the same with every
/// compiler, optimisation and instruction set.
///
///     same_bits [SAMPLES_PER_FAMILY]
#include "stress/families.h"
#include "stress/scene_families.h"

#include <box_query/distance.h>
#include <box_query/intersection.h>
#include <box_query/scene.h>

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace box_query::stress {
namespace {

/// FNV-1a over 64-bit words. All NaNs are one.
class Hash {
 public:
  void add(std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte) {
      value_ = (value_ ^ (word >> (8 * byte) & 0xffU)) * 0x100000001b3U;
    }
  }
  void add(double x) {
    std::uint64_t word = 0x7ff8000000000000U;
    if (!std::isnan(x)) {
      std::memcpy(&word, &x, sizeof word);
    }
    add(word);
  }
  void add(bool yes) { add(static_cast<std::uint64_t>(yes ? 1 : 0)); }
  void add(const Vector3& v) {
    add(v[0]);
    add(v[1]);
    add(v[2]);
  }
  void add(FaceSet faces) { add(static_cast<std::uint64_t>(faces.bits())); }
  void add(const Intersection& i) {
    add(static_cast<std::uint64_t>(i.num_points));
    add(i.t_enter);
    add(i.t_exit);
    add(i.started_inside);
    add(i.entered);
    add(i.left);
    add(i.enter_point);
    add(i.exit_point);
  }
  void add(const Box& box) {
    if (const auto* aligned = std::get_if<AlignedBox>(&box)) {
      add(aligned->min);
      add(aligned->max);
    } else {
      const auto& oriented = std::get<OrientedBox>(box);
      add(oriented.center);
      for (const double c : numbersOf(oriented.orientation.coeffs())) {
        add(c);
      }
      add(oriented.half_extents);
    }
  }
  void add(const Sample& sample) {
    add(sample.box);
    add(sample.origin);
    add(sample.direction);
    add(sample.end);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

template <typename Component, typename AnyBox>
void addIntersections(const Component& component, const AnyBox& box, Hash& answers) {
  answers.add(testIntersection(component, box));
  answers.add(findIntersection(component, box));
  const IntersectionRanges ranges = findRanges(component, box);
  answers.add(ranges.enter);
  answers.add(ranges.exit);
}

void addPair(const Sample& sample, Hash& answers) {
  std::visit(
      [&](const auto& box) {
        addIntersections(sample.line(), box, answers);
        addIntersections(sample.ray(), box, answers);
        addIntersections(sample.segment(), box, answers);
        const SegmentDistance nearest = distance(sample.segment(), box);
        answers.add(nearest.distance);
        answers.add(nearest.t);
        answers.add(nearest.on_segment);
        answers.add(nearest.on_box);
        for (const double radius : {0.0, nearest.distance, 1.5 * nearest.distance + 0.1}) {
          if (std::isfinite(radius)) {
            answers.add(isClear(sample.segment(), box, radius));
            answers.add(blockedAt(sample.segment(), box, radius));
          }
        }
      },
      sample.box);
}

void addScene(const SceneSample& sample, Hash& answers) {
  const Scene scene(sample.boxes);
  for (const Sample& component : sample.components) {
    const Hit hit = scene.cast(component.ray());
    answers.add(hit.hit);
    answers.add(static_cast<std::uint64_t>(hit.box));
    answers.add(hit.range);
    answers.add(hit.exit_range);
    answers.add(hit.t);
    answers.add(hit.point);
    answers.add(hit.normal);
    answers.add(scene.castAny(component.ray(), 1.0));
    answers.add(static_cast<std::uint64_t>(scene.castClosest(component.ray(), 1.0).box));
    for (const BoxIntersection& found : scene.findAll(component.line())) {
      answers.add(static_cast<std::uint64_t>(found.box));
      answers.add(found.intersection);
    }
    const Clearance clearance = scene.clearance(component.segment());
    answers.add(static_cast<std::uint64_t>(clearance.box));
    answers.add(clearance.distance);
    answers.add(clearance.t);
    answers.add(clearance.on_segment);
    answers.add(clearance.on_box);
    if (std::isfinite(clearance.distance)) {
      answers.add(scene.isClear(component.segment(), clearance.distance));
      const Blockage blockage = scene.firstBlockage(component.segment(), clearance.distance);
      answers.add(static_cast<std::uint64_t>(blockage.box));
      answers.add(blockage.blocked_at);
    }
  }
}

void print(const std::string& family, const Hash& questions, const Hash& answers) {
  std::printf("%-22s questions %016" PRIx64 " answers %016" PRIx64 "\n", family.c_str(),
              questions.value(), answers.value());
}

void run(std::uint64_t count) {
  for (std::size_t family = 0; family < familyNames().size(); ++family) {
    Hash questions;
    Hash answers;
    for (std::uint64_t index = 0; index < count; ++index) {
      const Sample sample = makeSample(family, index % 2 == 0, 9, index);
      questions.add(sample);
      addPair(sample, answers);
    }
    print(familyNames()[family], questions, answers);
  }
  for (std::size_t family = 0; family < sceneFamilyNames().size(); ++family) {
    Hash questions;
    Hash answers;
    const std::uint64_t scenes = sceneCount(family, count * sceneFamilyNames().size() / 40);
    for (std::uint64_t index = 0; index < scenes; ++index) {
      const SceneSample scene = makeScene(family, 9, index);
      for (const Box& box : scene.boxes) {
        questions.add(box);
      }
      for (const Sample& component : scene.components) {
        questions.add(component);
      }
      addScene(scene, answers);
    }
    print(sceneFamilyNames()[family], questions, answers);
  }
}

}  // namespace
}  // namespace box_query::stress

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--kernels") == 0) {
    std::puts(box_query::activeKernels());
    return 0;
  }
  box_query::stress::run(argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 400);
}
