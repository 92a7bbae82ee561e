// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed_scans.h"

#include "benchmark/methods_paper.h"
#include "benchmark/plain_distance.h"

#include <box_query/distance.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace box_query::benchmark {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

bool isYesOrNo(Question question) {
  return question == Question::kAny30 || question == Question::kSegment;
}

double endOf(Question question) {
  return question == Question::kClosest   ? kInf
         : question == Question::kSegment ? kSegmentLength
                                          : kRange;
}

class Scan final : public SpeedMethod {
 public:
  explicit Scan(const std::vector<OrientedBox>& boxes) {
    for (const OrientedBox& box : boxes) {
      boxes_.push_back(slabBox<double>(box));
    }
  }

  bool canAnswer(Question /*question*/) const override { return true; }
  SpeedAnswer ask(Question question, const Ray& ray) const override {
    if (question == Question::kClearance) {
      return nearest(slabComponent<double>(segmentAlong(ray, kPathLength)));
    }
    if (question == Question::kWithin) {
      return {isWithin(slabComponent<double>(segmentAlong(ray, kPathLength))) ? 0 : kNoBox};
    }
    SlabComponent<double> component = slabComponent<double>(ray);
    component.t_max = endOf(question);
    if (question == Question::kAll30) {
      return allOf(static_cast<std::size_t>(
          std::count_if(boxes_.begin(), boxes_.end(), [&](const SlabBox<double>& box) {
            return clipBySlabs<double, NoPad>(component, box).hit;
          })));
    }
    SpeedAnswer result;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const Answer answer = clipBySlabs<double, NoPad>(component, boxes_[i]);
      if (answer.hit && isYesOrNo(question)) {
        return {0};
      }
      if (answer.hit && (result.box == kNoBox || answer.t < component.t_max)) {
        result = {i, question == Question::kRounded30 ? answer.t : 0.0};
        component.t_max = answer.t;
      }
    }
    return result;
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf(*this, question, rays);
  }

 private:
  bool isWithin(const SlabComponent<double>& segment) const {
    return std::any_of(boxes_.begin(), boxes_.end(), [&](const SlabBox<double>& box) {
      return plainDistance(segment, box) <= kPathRadius;
    });
  }
  SpeedAnswer nearest(const SlabComponent<double>& segment) const {
    SpeedAnswer best{kNoBox, kInf};
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const double d = plainDistance(segment, boxes_[i]);
      if (d < best.value) {
        best = {i, d};
      }
    }
    return best;
  }

  std::vector<SlabBox<double>> boxes_;
};

/// Vectors of GCC and Clang: what the CPU has of them is used.
using Double8 __attribute__((vector_size(64))) = double;
using Index8 __attribute__((vector_size(64))) = std::int64_t;

struct alignas(64) Slabs8 {
  Double8 axes[3][3];
  Double8 center[3];
  Double8 half_extents[3];
};

struct alignas(64) Closest8 {
  Double8 t;
  Index8 box;
};

/// The closest box of every lane. (In one function: what it called would not be cloned with it. Not
/// under ThreadSanitizer, which has not begun when a clone is chosen.)
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void closestOfEach(const Slabs8* blocks, std::size_t count, const SlabComponent<double>& ray,
                   Closest8& closest) {
  const Double8 zero = {};
  const Index8 lanes = {0, 1, 2, 3, 4, 5, 6, 7};
  Double8 best = zero + ray.t_max;
  Index8 box = Index8{} - 1;  // none
  for (std::size_t b = 0; b < count; ++b) {
    const Slabs8& block = blocks[b];
    const Double8 p[3] = {ray.origin[0] - block.center[0], ray.origin[1] - block.center[1],
                          ray.origin[2] - block.center[2]};
    Double8 t0 = zero + ray.t_min;
    Double8 t1 = best;
    for (int i = 0; i < 3; ++i) {
      const Double8* axis = block.axes[i];
      const Double8 y = axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
      const Double8 d =
          axis[0] * ray.direction[0] + axis[1] * ray.direction[1] + axis[2] * ray.direction[2];
      const Double8 r = 1.0 / d;
      const Double8 from = (-block.half_extents[i] - y) * r;
      const Double8 to = (block.half_extents[i] - y) * r;
      const Double8 near = from < to ? from : to;
      const Double8 far = from < to ? to : from;
      t0 = t0 > near ? t0 : near;
      t1 = t1 < far ? t1 : far;
    }
    const Index8 hit = t0 <= t1;
    best = hit ? t0 : best;
    box = hit ? lanes + static_cast<std::int64_t>(8 * b) : box;
  }
  closest = {best, box};
}

class SlabsOfEight final : public SpeedMethod {
 public:
  explicit SlabsOfEight(const std::vector<OrientedBox>& boxes) : blocks_((boxes.size() + 7) / 8) {
    for (std::size_t i = 0; i < 8 * blocks_.size(); ++i) {
      Slabs8& block = blocks_[i / 8];
      // Where there is none, one that is inside out.
      SlabBox<double> box = slabBox<double>(boxes[std::min(i, boxes.size() - 1)]);
      for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k) {
          block.axes[j][k][i % 8] = box.axes[j][k];
        }
        block.center[j][i % 8] = box.center[j];
        block.half_extents[j][i % 8] = i < boxes.size() ? box.half_extents[j] : -kInf;
      }
    }
  }

  bool canAnswer(Question question) const override {
    return question == Question::kClosest30 || question == Question::kClosest ||
           question == Question::kRounded30;
  }
  SpeedAnswer ask(Question question, const Ray& ray) const override {
    SlabComponent<double> component = slabComponent<double>(ray);
    component.t_max = endOf(question);
    Closest8 closest;
    closestOfEach(blocks_.data(), blocks_.size(), component, closest);
    SpeedAnswer result;
    double t = kInf;
    for (int lane = 0; lane < 8; ++lane) {
      if (closest.box[lane] >= 0 && closest.t[lane] < t) {
        t = closest.t[lane];
        result = {static_cast<std::size_t>(closest.box[lane]),
                  question == Question::kRounded30 ? t : 0.0};
      }
    }
    return result;
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf(*this, question, rays);
  }

 private:
  std::vector<Slabs8> blocks_;
};

class FindScan final : public SpeedMethod {
 public:
  explicit FindScan(const std::vector<OrientedBox>& boxes) : boxes_(prepareAll<Find>(boxes)) {}

  bool canAnswer(Question question) const override {
    return question == Question::kClosest30 || question == Question::kClosest ||
           question == Question::kRounded30;
  }
  SpeedAnswer ask(Question question, const Ray& ray) const override {
    SpeedAnswer result;
    double closest = endOf(question);
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const Answer answer = Find::ask(ray, boxes_[i]);
      if (answer.hit && answer.t < closest) {
        closest = answer.t;
        result = {i, question == Question::kRounded30 ? answer.t : 0.0};
      }
    }
    return result;
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf(*this, question, rays);
  }

 private:
  std::vector<listings::OrientedBox3> boxes_;
};

class ExactScan final : public SpeedMethod {
 public:
  explicit ExactScan(std::vector<OrientedBox> boxes) : boxes_(std::move(boxes)) {}

  bool canAnswer(Question question) const override { return question == Question::kClearance; }
  SpeedAnswer ask(Question /*question*/, const Ray& ray) const override {
    const Segment segment = segmentAlong(ray, kPathLength);
    SpeedAnswer best{kNoBox, kInf};
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const double d = distance(segment, boxes_[i]).distance;
      if (d < best.value) {
        best = {i, d};
      }
    }
    return best;
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf(*this, question, rays);
  }

 private:
  std::vector<OrientedBox> boxes_;
};

}  // namespace

std::unique_ptr<SpeedMethod> makeScan(const std::vector<OrientedBox>& boxes) {
  return std::make_unique<Scan>(boxes);
}
std::unique_ptr<SpeedMethod> makeSlabsOfEight(const std::vector<OrientedBox>& boxes) {
  return std::make_unique<SlabsOfEight>(boxes);
}
std::unique_ptr<SpeedMethod> makeFindScan(const std::vector<OrientedBox>& boxes) {
  return std::make_unique<FindScan>(boxes);
}

std::unique_ptr<SpeedMethod> makeExactScan(const std::vector<OrientedBox>& boxes) {
  return std::make_unique<ExactScan>(boxes);
}

}  // namespace box_query::benchmark
