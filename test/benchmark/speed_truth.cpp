// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed_truth.h"

#include <box_query/distance.h>
#include <box_query/intersection.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace box_query::benchmark {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNanometre = 1e-9;
/// [m] Far more than what is lost on the way to a distance of spheres.
constexpr double kAmple = 1e-3;

OrientedBox resized(OrientedBox box, double by) {
  box.half_extents = (box.half_extents.array() + by).max(0.0);
  return box;
}

double reachOf(Question question) {
  switch (question) {
    case Question::kClosest:
      return kInf;
    case Question::kSegment:
      return kSegmentLength;
    case Question::kWithin:
    case Question::kClearance:
      return kPathLength;
    default:
      return kRange;
  }
}

/// No point of the ray within its reach is nearer to any of the box.
double lowerBound(const Ray& ray, double reach, const OrientedBox& box) {
  const Vector3 to_center = box.center - ray.origin;
  const double t = std::min(std::max(0.0, to_center.dot(ray.direction)), reach);
  return (to_center - t * ray.direction).norm() - box.half_extents.norm() - kAmple;
}

/// Where a ray of unit direction enters a box; +inf if it does not.
double entryOf(const Ray& ray, const OrientedBox& box) {
  const Intersection i = findIntersection(ray, box);
  return i.num_points > 0 ? i.t_enter : kInf;
}

/// How many boxes would be met within the reach if all were larger by so much.
std::size_t countMet(Question question, const std::vector<OrientedBox>& boxes, const Ray& ray,
                     double by) {
  const double reach = reachOf(question);
  return static_cast<std::size_t>(
      std::count_if(boxes.begin(), boxes.end(), [&](const OrientedBox& box) {
        return lowerBound(ray, reach, box) <= 0.0 && entryOf(ray, resized(box, by)) <= reach + by;
      }));
}

SpeedAnswer allMet(const std::vector<OrientedBox>& boxes, const Ray& ray) {
  const Segment segment = segmentAlong(ray, kRange);
  return allOf(static_cast<std::size_t>(
      std::count_if(boxes.begin(), boxes.end(), [&](const OrientedBox& box) {
        return lowerBound(ray, kRange, box) <= 0.0 && testIntersection(segment, box);
      })));
}

/// What the best answer has least of, of one box; +inf if it does not count.
double valueOf(Question question, const OrientedBox& box, const Ray& ray) {
  if (question == Question::kClearance) {
    return distance(segmentAlong(ray, kPathLength), box).distance;
  }
  if (question == Question::kWithin) {
    return isClear(segmentAlong(ray, kPathLength), box, kPathRadius) ? kInf : 0.0;
  }
  if (question == Question::kSegment) {
    return testIntersection(segmentAlong(ray, kSegmentLength), box) ? 0.0 : kInf;
  }
  const double range = findRanges(ray, box).enter;
  return range <= reachOf(question) ? range : kInf;
}

bool wantsClosest(Question question) {
  return question == Question::kClosest30 || question == Question::kClosest ||
         question == Question::kRounded30;
}

bool isRightExactly(Question question, const SpeedAnswer& answer, const SpeedAnswer& truth) {
  if (question == Question::kAll30) {
    return answer.value == truth.value;
  }
  if (question == Question::kAny30 || question == Question::kSegment ||
      question == Question::kWithin) {
    return (answer.box == kNoBox) == (truth.box == kNoBox);
  }
  const bool has_value = question == Question::kRounded30 || question == Question::kClearance;
  return answer.box == truth.box &&
         (!has_value || truth.box == kNoBox || answer.value == truth.value);
}

/// Of a closest box that is another one than it should be, or one too much.
bool mayBeClosest(Question question, const std::vector<OrientedBox>& boxes, const Ray& ray,
                  const SpeedAnswer& answer, const SpeedAnswer& truth) {
  const double earliest = entryOf(ray, resized(boxes[answer.box], kNanometre));
  const double latest =
      truth.box == kNoBox ? kInf : entryOf(ray, resized(boxes[truth.box], -kNanometre));
  return earliest <= std::min(reachOf(question) + kNanometre, latest);
}

}  // namespace

SpeedAnswer truthOf(Question question, const std::vector<OrientedBox>& boxes, const Ray& ray) {
  if (question == Question::kAll30) {
    return allMet(boxes, ray);
  }
  SpeedAnswer truth{kNoBox, kInf};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double enough = question == Question::kClearance ? truth.value
                          : question == Question::kWithin  ? kPathRadius
                                                           : 0.0;
    if (lowerBound(ray, reachOf(question), boxes[i]) <= enough) {
      const double value = valueOf(question, boxes[i], ray);
      if (value < truth.value) {
        truth = {i, value};
      }
    }
  }
  return truth;
}

bool isWrong(Question question, const std::vector<OrientedBox>& boxes, const Ray& ray,
             const SpeedAnswer& answer, const SpeedAnswer& truth, bool exactly) {
  if (exactly || question == Question::kWithin) {
    return !isRightExactly(question, answer, truth);
  }
  if (question == Question::kClearance) {
    return !(std::fabs(answer.value - truth.value) <= kNanometre);
  }
  if (question == Question::kAll30) {
    const auto count = static_cast<std::size_t>(answer.value);
    return answer.value != truth.value && (count < countMet(question, boxes, ray, -kNanometre) ||
                                           count > countMet(question, boxes, ray, kNanometre));
  }
  const bool is_met = answer.box != kNoBox;
  if (is_met == (truth.box != kNoBox) && (!wantsClosest(question) || answer.box == truth.box)) {
    return false;
  }
  if (!is_met) {
    return countMet(question, boxes, ray, -kNanometre) > 0;
  }
  return wantsClosest(question) ? !mayBeClosest(question, boxes, ray, answer, truth)
                                : countMet(question, boxes, ray, kNanometre) == 0;
}

}  // namespace box_query::benchmark
