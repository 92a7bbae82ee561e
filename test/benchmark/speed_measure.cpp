// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed.h"
#include "benchmark/speed_truth.h"

#include <algorithm>

namespace box_query::benchmark {
namespace {

/// A scan of very many boxes tells nothing that it did not tell before.
constexpr std::size_t kMostToScan = 2000;
/// What others take to build more is known from fewer.
constexpr std::size_t kMostToBuild = 100000;
/// Boxes that answers are compared with, one by one, for a line of the table.
constexpr std::size_t kMostCompared = 100000000;

/// All methods, each with all scenes of a workload.
class Measurement {
 public:
  Measurement(const Workload& workload, const SpeedOptions& options,
              const std::vector<SpeedMethodKind>& kinds)
      : workload_(workload), options_(options), kinds_(kinds), methods_(kinds.size()) {
    for (const SpeedScene& scene : workload.scenes) {
      rays_ += scene.rays.size();
      boxes_ += scene.boxes.size();
      for (std::size_t m = 0; m < kinds_.size(); ++m) {
        if (!isTooSlow(m)) {
          methods_[m].push_back(kinds_[m].make(scene.boxes));
        }
      }
    }
  }

  std::vector<SpeedRow> ask(Question question) const {
    std::vector<std::size_t> who;
    std::vector<Pass> passes;
    for (std::size_t m = 0; m < kinds_.size(); ++m) {
      if (!methods_[m].empty() && methods_[m].front()->canAnswer(question)) {
        who.push_back(m);
        passes.push_back([this, m, question] { return pass(m, question); });
      }
    }
    std::vector<SpeedRow> rows = time(question, who, passes, rays_);
    compare(question, who, rows);
    return rows;
  }

  /// A box at a time, all that a method does before it can be asked.
  std::vector<SpeedRow> build() const {
    std::vector<std::size_t> who;
    std::vector<Pass> passes;
    for (std::size_t m = 0; m < kinds_.size(); ++m) {
      if (kinds_[m].is_built && (m == 0 || boxesOfAScene() <= kMostToBuild)) {
        who.push_back(m);
        passes.push_back([this, m] {
          std::uint64_t made = 0;
          for (const SpeedScene& scene : workload_.scenes) {
            made += kinds_[m].make(scene.boxes) != nullptr ? 1 : 0;
          }
          return made;
        });
      }
    }
    return time(Question::kBuild, who, passes, boxes_);
  }

 private:
  std::size_t boxesOfAScene() const { return boxes_ / workload_.scenes.size(); }
  bool isTooSlow(std::size_t m) const {
    return kinds_[m].name == "plain scan" && boxesOfAScene() > kMostToScan;
  }

  std::uint64_t pass(std::size_t m, Question question) const {
    std::uint64_t sum = 0;
    for (std::size_t s = 0; s < workload_.scenes.size(); ++s) {
      sum = 31 * sum + methods_[m][s]->pass(question, workload_.scenes[s].rays);
    }
    return sum;
  }

  std::vector<SpeedRow> time(Question question, const std::vector<std::size_t>& who,
                             const std::vector<Pass>& passes, std::size_t queries) const {
    const std::vector<Timing> timings = timeSideBySide(passes, queries, options_.rounds, 0);
    std::vector<SpeedRow> rows;
    for (std::size_t k = 0; k < who.size(); ++k) {
      rows.push_back({workload_.name, boxesOfAScene(), question, kinds_[who[k]].name, timings[k]});
    }
    return rows;
  }

  void compare(Question question, const std::vector<std::size_t>& who,
               std::vector<SpeedRow>& rows) const {
    const std::size_t scenes = workload_.scenes.size();
    const std::size_t all =
        std::max<std::size_t>(20, std::min(options_.sample, kMostCompared / boxesOfAScene()));
    std::size_t left = all;
    for (std::size_t s = 0; s < scenes && left > 0; ++s) {
      const SpeedScene& scene = workload_.scenes[s];
      const std::size_t here = std::min({left, all / scenes + 1, scene.rays.size()});
      left -= here;
      for (std::size_t i = 0; i < here; ++i) {
        const Ray& ray = scene.rays[i];
        const SpeedAnswer truth = truthOf(question, scene.boxes, ray);
        for (std::size_t k = 0; k < who.size(); ++k) {
          const SpeedAnswer answer = methods_[who[k]][s]->ask(question, ray);
          ++rows[k].asked;
          rows[k].hits += truth.box != kNoBox ? 1 : 0;
          rows[k].wrong += isWrong(question, scene.boxes, ray, answer, truth, who[k] == 0) ? 1 : 0;
        }
      }
    }
  }

  const Workload& workload_;
  const SpeedOptions& options_;
  const std::vector<SpeedMethodKind>& kinds_;
  std::vector<std::vector<std::unique_ptr<SpeedMethod>>> methods_;
  std::size_t rays_ = 0;
  std::size_t boxes_ = 0;
};

}  // namespace

std::vector<SpeedRow> measureSpeed(const Workload& workload, const SpeedOptions& options,
                                   const std::vector<SpeedMethodKind>& methods) {
  const Measurement measurement(workload, options, methods);
  std::vector<SpeedRow> rows;
  for (const Question question : kQuestions) {
    for (SpeedRow& row :
         question == Question::kBuild ? measurement.build() : measurement.ask(question)) {
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace box_query::benchmark
