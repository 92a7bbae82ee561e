// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/accuracy.h"
#include "benchmark/methods.h"
#include "benchmark/scene_methods.h"
#include "benchmark/scene_truth.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

namespace box_query::benchmark {
namespace {

/// Rays asked of one scene before the next is made.
constexpr std::size_t kRaysAScene = 64;

using Ask = std::function<SceneAnswer(const Ray&)>;

/// A method behind one type.
struct Contender {
  const char* name;
  std::function<Pass(const RayScene&)> bind;
  std::function<Ask(const RayScene&)> asker;
};

template <typename Method>
Contender contender() {
  const auto bind = [](const RayScene& scene) -> Pass {
    return [&rays = scene.rays, method = std::make_shared<Method>(scene.boxes)] {
      std::uint64_t sum = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        sum += rotated(hashOf((*method)(rays[i])), i);
      }
      return sum;
    };
  };
  const auto asker = [](const RayScene& scene) -> Ask {
    return
        [method = std::make_shared<Method>(scene.boxes)](const Ray& ray) { return (*method)(ray); };
  };
  return {Method::kName, bind, asker};
}

template <typename... Methods>
std::vector<Contender> anyContenders(MethodList<Methods...> /*scans*/) {
  return {contender<ScanAny<Methods>>()..., contender<SceneAny>()};
}

template <typename... Methods>
std::vector<Contender> closestContenders(MethodList<Methods...> /*scans*/) {
  return {contender<ScanClosest<Methods>>()..., contender<SceneClosest>(),
          contender<DoubleDoubleClosest>(), contender<ExactClosest>()};
}

void compare(const Ask& ask, const RayScene& scene, const std::vector<SceneTruth>& truth,
             bool closest, Errors& errors) {
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const SceneAnswer answer = ask(scene.rays[i]);
    ++errors.asked;
    errors.hits += truth[i].hit() ? 1 : 0;
    errors.false_hits += answer.hit && !truth[i].hit() ? 1 : 0;
    errors.false_misses += !answer.hit && truth[i].hit() ? 1 : 0;
    if (closest && answer.hit && truth[i].hit()) {
      errors.wrong_boxes += answer.box != truth[i].box ? 1 : 0;
      errors.ulps.push_back(oracle::ulpErrorSqrt(answer.range, truth[i].squared_range));
    }
  }
}

void measure(const char* table, bool closest, const std::vector<Contender>& methods, Input input,
             const Options& options, std::vector<Row>& rows) {
  std::vector<Errors> errors(methods.size());
  for (std::size_t done = 0; done < options.scene_sample;) {
    const std::size_t count = std::min(kRaysAScene, options.scene_sample - done);
    done += count;
    const RayScene scene = makeScene(input, count, options.seed + done);
    const std::vector<SceneTruth> truth = truthOf(scene.boxes, scene.rays);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      compare(methods[m].asker(scene), scene, truth, closest, errors[m]);
    }
  }
  const RayScene timed = makeScene(input, options.timed_rays, options.seed);
  std::vector<Pass> passes;
  std::size_t base = 0;
  for (const Contender& method : methods) {
    base = method.name == std::string(DoubleSlab::kName) ? passes.size() : base;
    passes.push_back(method.bind(timed));
  }
  const auto timings = timeSideBySide(passes, options.timed_rays, options.rounds, base);
  for (std::size_t m = 0; m < methods.size(); ++m) {
    rows.push_back(
        {table, nameOf(input), "box", methods[m].name, timings[m], std::move(errors[m])});
  }
}

}  // namespace

std::vector<Row> measureScenes(const Options& options) {
  std::vector<Row> rows;
  for (const Input input : kInputs) {
    measure("any", false, anyContenders(AnyMethods()), input, options, rows);
    measure("closest", true, closestContenders(ClosestMethods()), input, options, rows);
  }
  return rows;
}

}  // namespace box_query::benchmark
