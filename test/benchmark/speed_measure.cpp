// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed.h"
#include "benchmark/speed_truth.h"
#include "reference/sampler.h"

#include <algorithm>

namespace box_query::benchmark {
namespace {

/// What others take to build more is known from fewer.
constexpr std::size_t kMostToBuild = 100000;
/// Boxes that answers are compared with, one by one, for a line of the table.
constexpr std::size_t kMostCompared = 100000000;

/// Rays of a scene that are asked about one by one; in a batch, all.
constexpr std::size_t kSingles = 2048;

/// One way of one method.
struct Contender {
  std::size_t method;
  std::string name;
  std::size_t way = 0;  ///< Of a batch.
};

/// All methods, each with all scenes of a workload.
class Measurement {
 public:
  Measurement(const Workload& workload, const SpeedOptions& options,
              const std::vector<SpeedMethodKind>& kinds)
      : workload_(workload), options_(options), kinds_(kinds), methods_(kinds.size()) {
    for (const SpeedScene& scene : workload.scenes) {
      const std::size_t singles = std::min(kSingles, scene.rays.size());
      singles_.emplace_back(scene.rays.begin(),
                            scene.rays.begin() + static_cast<std::ptrdiff_t>(singles));
      rays_ += singles;
      boxes_ += scene.boxes.size();
    }
    for (std::size_t m = 0; m < kinds_.size(); ++m) {
      for (const SpeedScene& scene : workload.scenes) {
        if (boxesOfAScene() <= kinds_[m].most_boxes) {
          methods_[m].push_back(kinds_[m].make(scene.boxes));
        }
      }
    }
  }

  /// Of several scenes at a time there is no batch.
  bool hasBatches() const { return workload_.scenes.size() == 1; }

  void single(Question question) {
    std::vector<Contender> contenders;
    std::vector<Pass> passes;
    for (std::size_t m = 0; m < kinds_.size(); ++m) {
      if (!methods_[m].empty() && methods_[m].front()->canAnswer(question)) {
        contenders.push_back({m, kinds_[m].name});
        passes.emplace_back([this, m, question] { return pass(m, question); });
      }
    }
    time(question, Mode::kSingle, contenders, passes, rays_);
    compare(question, contenders,
            [&](const Contender& contender, std::size_t scene, std::size_t ray) {
              return methods_[contender.method][scene]->ask(question,
                                                            workload_.scenes[scene].rays[ray]);
            });
  }

  /// On one thread, beside what others have for it.
  void batch(Question question) {
    std::vector<Contender> contenders = {{0, kinds_[0].name}};
    for (std::size_t m = 1; m < kinds_.size(); ++m) {
      if (!methods_[m].empty()) {
        const std::vector<std::string> ways = methods_[m].front()->batchWays(question);
        for (std::size_t way = 0; way < ways.size(); ++way) {
          contenders.push_back({m, kinds_[m].name + ", " + ways[way], way});
        }
      }
    }
    batch(question, Mode::kBatch, contenders);
  }

  /// Of the first method, one after the other, beside the last of them.
  void threads(Question question) {
    std::vector<Contender> contenders;
    const std::vector<std::string> ways = methods_[0].front()->batchWays(question);
    for (std::size_t way = 0; way < ways.size(); ++way) {
      contenders.push_back({0, kinds_[0].name + ", " + ways[way], way});
    }
    batch(question, Mode::kThreads, contenders);
  }

  /// All that a method does before it can be asked.
  void build() {
    std::vector<Contender> contenders;
    std::vector<Pass> passes;
    for (std::size_t m = 0; m < kinds_.size(); ++m) {
      if (kinds_[m].is_built && !methods_[m].empty() &&
          (m == 0 || boxesOfAScene() <= kMostToBuild)) {
        contenders.push_back({m, kinds_[m].name});
        passes.emplace_back([this, m] {
          std::uint64_t made = 0;
          for (const SpeedScene& scene : workload_.scenes) {
            made += kinds_[m].make(scene.boxes) != nullptr ? 1 : 0;
          }
          return made;
        });
      }
    }
    time(Question::kBuild, Mode::kSingle, contenders, passes, boxes_);
  }

  void update() {
    constexpr double kStep = 0.01;  // [m], about what moves between two messages of a sensor
    std::vector<std::vector<OrientedBox>> moved;
    reference::Sampler sampler(11);
    for (const SpeedScene& scene : workload_.scenes) {
      moved.push_back(scene.boxes);
      for (OrientedBox& box : moved.back()) {
        box.center += sampler.vector(-kStep, kStep);
      }
    }
    std::vector<Contender> contenders;
    std::vector<Pass> passes;
    for (std::size_t m = 0; m < kinds_.size(); ++m) {
      if (!methods_[m].empty() && methods_[m].front()->canUpdate()) {
        contenders.push_back({m, kinds_[m].name});
        passes.emplace_back([&, m] {
          std::uint64_t sum = 0;
          for (std::size_t s = 0; s < moved.size(); ++s) {
            sum += methods_[m][s]->update(moved[s]);
          }
          return sum;
        });
      }
    }
    time(Question::kUpdate, Mode::kSingle, contenders, passes, boxes_);
  }

  std::vector<SpeedRow> take() { return std::move(rows_); }

 private:
  std::size_t boxesOfAScene() const { return boxes_ / workload_.scenes.size(); }

  std::uint64_t pass(std::size_t m, Question question) const {
    std::uint64_t sum = 0;
    for (std::size_t s = 0; s < workload_.scenes.size(); ++s) {
      sum = 31 * sum + methods_[m][s]->pass(question, singles_[s]);
    }
    return sum;
  }

  void batch(Question question, Mode mode, const std::vector<Contender>& contenders) {
    const std::vector<Ray>& rays = workload_.scenes.front().rays;
    std::vector<std::vector<SpeedAnswer>> answers(contenders.size());
    std::vector<Pass> passes;
    for (std::size_t k = 0; k < contenders.size(); ++k) {
      answers[k].resize(rays.size());
      passes.emplace_back([&, k] {
        methods_[contenders[k].method].front()->askEach(question, rays, contenders[k].way,
                                                        answers[k]);
        // (All are compared later, so that none is left out; to add them up would count as work.)
        return hashOf(answers[k].back());
      });
    }
    time(question, mode, contenders, passes, rays.size());
    compare(question, contenders, [&](const Contender& contender, std::size_t, std::size_t ray) {
      return answers[static_cast<std::size_t>(&contender - contenders.data())][ray];
    });
  }

  /// Adds a row for each.
  void time(Question question, Mode mode, const std::vector<Contender>& contenders,
            const std::vector<Pass>& passes, std::size_t queries) {
    const bool on_threads = mode == Mode::kThreads;
    const std::vector<Timing> timings =
        timeSideBySide(passes, queries, options_.rounds, on_threads ? passes.size() - 1 : 0,
                       on_threads ? Clock::kWall : Clock::kThread);
    for (std::size_t k = 0; k < contenders.size(); ++k) {
      rows_.push_back(
          {workload_.name, boxesOfAScene(), question, mode, contenders[k].name, timings[k]});
    }
  }

  /// Counts in the last rows what answer(contender, scene, ray) is wrong.
  template <typename AnswerOf>
  void compare(Question question, const std::vector<Contender>& contenders,
               const AnswerOf& answer) {
    SpeedRow* rows = &rows_[rows_.size() - contenders.size()];
    const std::size_t scenes = workload_.scenes.size();
    const std::size_t all =
        std::max<std::size_t>(20, std::min(options_.sample, kMostCompared / boxesOfAScene()));
    std::size_t left = all;
    for (std::size_t s = 0; s < scenes && left > 0; ++s) {
      const SpeedScene& scene = workload_.scenes[s];
      const std::size_t here = std::min({left, all / scenes + 1, scene.rays.size()});
      left -= here;
      for (std::size_t i = 0; i < here; ++i) {
        const SpeedAnswer truth = truthOf(question, scene.boxes, scene.rays[i]);
        for (std::size_t k = 0; k < contenders.size(); ++k) {
          const QueryCounters before = queryCounters();
          const SpeedAnswer given = answer(contenders[k], s, i);
          rows[k].work += queryCounters() - before;
          ++rows[k].asked;
          rows[k].hits += truth.box != kNoBox ? 1 : 0;
          rows[k].wrong +=
              isWrong(question, scene.boxes, scene.rays[i], given, truth, contenders[k].method == 0)
                  ? 1
                  : 0;
        }
      }
    }
  }

  const Workload& workload_;
  const SpeedOptions& options_;
  const std::vector<SpeedMethodKind>& kinds_;
  std::vector<std::vector<std::unique_ptr<SpeedMethod>>> methods_;
  std::vector<std::vector<Ray>> singles_;
  std::size_t rays_ = 0;
  std::size_t boxes_ = 0;
  std::vector<SpeedRow> rows_;
};

}  // namespace

std::vector<SpeedRow> measureSpeed(const Workload& workload, const SpeedOptions& options,
                                   const std::vector<SpeedMethodKind>& methods) {
  Measurement measurement(workload, options, methods);
  for (const Question question : kQuestions) {
    if (question == Question::kBuild) {
      measurement.build();
    } else if (question == Question::kUpdate) {
      measurement.update();
    } else {
      measurement.single(question);
    }
  }
  if (measurement.hasBatches()) {
    for (const Question question : kBatchQuestions) {
      measurement.batch(question);
    }
  }
  if (measurement.hasBatches() && options.threads) {
    for (const Question question : kThreadQuestions) {
      measurement.threads(question);
    }
  }
  return measurement.take();
}

}  // namespace box_query::benchmark
