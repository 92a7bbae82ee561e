// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed.h"

#include <box_query/distance.h>
#include <box_query/intersection.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace box_query::benchmark {
namespace {

constexpr double kNanometre = 1e-9;

OrientedBox resized(OrientedBox box, double by) {
  box.half_extents = (box.half_extents.array() + by).max(0.0);
  return box;
}

double reachOf(Question question) {
  return question == Question::kClosest   ? std::numeric_limits<double>::infinity()
         : question == Question::kSegment ? kSegmentLength
                                          : kRange;
}

/// Where a ray of unit direction enters a box; +inf if it does not.
double entryOf(const Ray& ray, const OrientedBox& box) {
  const Intersection i = findIntersection(ray, box);
  return i.num_points > 0 ? i.t_enter : std::numeric_limits<double>::infinity();
}

/// The right answer, one box after the other.
SpeedAnswer truthOf(Question question, const std::vector<OrientedBox>& boxes, const Ray& ray) {
  SpeedAnswer truth{kNoBox, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    double d = 0.0;
    if (question == Question::kClearance) {
      d = distance(segmentAlong(ray, kPathLength), boxes[i]).distance;
    } else if (question == Question::kSegment) {
      d = testIntersection(segmentAlong(ray, kSegmentLength), boxes[i])
              ? 0.0
              : std::numeric_limits<double>::infinity();
    } else {
      d = findRanges(ray, boxes[i]).enter;
      d = d <= reachOf(question) ? d : std::numeric_limits<double>::infinity();
    }
    if (d < truth.distance) {
      truth = {i, d};
    }
  }
  return truth;
}

/// Whether any box would be met if all were larger by so much.
bool meetsAny(Question question, const std::vector<OrientedBox>& boxes, const Ray& ray, double by) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const OrientedBox& box) {
    return entryOf(ray, resized(box, by)) <= reachOf(question) + by;
  });
}

/// Of the library: not the right answer. Of others: not right for any boxes that differ from these
/// by less than a nanometre.
bool isWrong(Question question, const std::vector<OrientedBox>& boxes, const Ray& ray,
             const SpeedAnswer& answer, const SpeedAnswer& truth, bool exactly) {
  if (question == Question::kClearance) {
    return exactly ? answer.box != truth.box || answer.distance != truth.distance
                   : std::fabs(answer.distance - truth.distance) > kNanometre;
  }
  const bool closest = question != Question::kAny30 && question != Question::kSegment;
  const bool is_met = answer.box != kNoBox;
  const bool same = is_met == (truth.box != kNoBox) && (!closest || answer.box == truth.box);
  if (exactly) {
    return !same ||
           (question == Question::kRounded30 && is_met && answer.distance != truth.distance);
  }
  if (same) {
    return false;
  }
  if (!is_met) {
    return meetsAny(question, boxes, ray, -kNanometre);
  }
  if (!closest) {
    return !meetsAny(question, boxes, ray, kNanometre);
  }
  const double earliest = entryOf(ray, resized(boxes[answer.box], kNanometre));
  const double latest = truth.box == kNoBox ? std::numeric_limits<double>::infinity()
                                            : entryOf(ray, resized(boxes[truth.box], -kNanometre));
  return !(earliest <= std::min(reachOf(question) + kNanometre, latest));
}

}  // namespace

std::vector<SpeedRow> measureSpeed(const Workload& workload, int rounds, std::size_t sample) {
  const std::vector<SpeedMethodKind> kinds = speedMethods();
  std::vector<std::vector<std::unique_ptr<SpeedMethod>>> methods(kinds.size());
  std::size_t rays = 0;
  std::size_t boxes = 0;
  for (const SpeedScene& scene : workload.scenes) {
    rays += scene.rays.size();
    boxes += scene.boxes.size();
    for (std::size_t m = 0; m < kinds.size(); ++m) {
      methods[m].push_back(kinds[m].make(scene.boxes));
    }
  }
  std::vector<SpeedRow> rows;
  for (const Question question : kQuestions) {
    std::vector<Pass> passes;
    std::vector<std::size_t> who;
    for (std::size_t m = 0; m < kinds.size(); ++m) {
      // A scan of very many boxes tells nothing that it did not tell before.
      const bool too_slow = kinds[m].name == "plain scan" && boxes > 2000 * workload.scenes.size();
      if (methods[m].front()->canAnswer(question) && !too_slow) {
        who.push_back(m);
        passes.push_back([&, m, question] {
          std::uint64_t sum = 0;
          for (std::size_t s = 0; s < workload.scenes.size(); ++s) {
            sum = 31 * sum + methods[m][s]->pass(question, workload.scenes[s].rays);
          }
          return sum;
        });
      }
    }
    const std::vector<Timing> timings = timeSideBySide(passes, rays, rounds, 0);
    for (std::size_t k = 0; k < who.size(); ++k) {
      SpeedRow row{workload.name,
                   boxes / workload.scenes.size(),
                   question,
                   kinds[who[k]].name,
                   timings[k],
                   0,
                   0,
                   0};
      rows.push_back(row);
    }
    std::size_t left = sample;
    for (std::size_t s = 0; s < workload.scenes.size() && left > 0; ++s) {
      const SpeedScene& scene = workload.scenes[s];
      const std::size_t here = std::min(left, sample / workload.scenes.size() + 1);
      left -= here;
      for (std::size_t i = 0; i < here && i < scene.rays.size(); ++i) {
        const SpeedAnswer truth = truthOf(question, scene.boxes, scene.rays[i]);
        for (std::size_t k = 0; k < who.size(); ++k) {
          SpeedRow& row = rows[rows.size() - who.size() + k];
          const SpeedAnswer answer = methods[who[k]][s]->ask(question, scene.rays[i]);
          ++row.asked;
          row.hits += truth.box != kNoBox ? 1 : 0;
          row.wrong += isWrong(question, scene.boxes, scene.rays[i], answer, truth, who[k] == 0);
        }
      }
    }
  }
  return rows;
}

}  // namespace box_query::benchmark
