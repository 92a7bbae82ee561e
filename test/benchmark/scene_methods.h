// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How the methods for one box find the closest of many, or whether there is any: one after the
/// other. The library's Scene is asked as anybody would.
#pragma once

#include "benchmark/answer.h"
#include "benchmark/methods_library.h"
#include "exact/clip.h"

#include <box_query/scene.h>

#include <limits>
#include <utility>
#include <vector>

namespace box_query::benchmark {

struct SceneAnswer {
  bool hit = false;
  std::size_t box = kNoBox;  ///< Closest queries only.
  double range = std::numeric_limits<double>::infinity();
};

inline std::uint64_t hashOf(const SceneAnswer& answer) {
  return answer.hit ? bitsOf(answer.range) ^ (answer.box + 1) : 0;
}

template <typename Method>
class ScanClosest {
 public:
  static constexpr const char* kName = Method::kName;

  explicit ScanClosest(const std::vector<OrientedBox>& boxes) : boxes_(prepareAll<Method>(boxes)) {}
  SceneAnswer operator()(const Ray& ray) const {
    SceneAnswer closest;
    double t = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const Answer answer = Method::ask(ray, boxes_[i]);
      if (answer.hit && answer.t < t) {
        closest.hit = true;
        closest.box = i;
        t = answer.t;
      }
    }
    closest.range = t * ray.direction.norm();
    return closest;
  }

 private:
  std::vector<typename Method::Prepared> boxes_;
};

template <typename Method>
class ScanAny {
 public:
  static constexpr const char* kName = Method::kName;

  explicit ScanAny(const std::vector<OrientedBox>& boxes) : boxes_(prepareAll<Method>(boxes)) {}
  SceneAnswer operator()(const Ray& ray) const {
    SceneAnswer any;
    for (std::size_t i = 0; i < boxes_.size() && !any.hit; ++i) {
      any.hit = Method::ask(ray, boxes_[i]).hit;
    }
    return any;
  }

 private:
  std::vector<typename Method::Prepared> boxes_;
};

inline Scene sceneOf(const std::vector<OrientedBox>& boxes) {
  return Scene(std::vector<Box>(boxes.begin(), boxes.end()));
}

class SceneClosest {
 public:
  static constexpr const char* kName = "box_query, rounded range";
  explicit SceneClosest(const std::vector<OrientedBox>& boxes) : scene_(sceneOf(boxes)) {}
  SceneAnswer operator()(const Ray& ray) const {
    const Hit hit = scene_.cast(ray);
    return {hit.hit, hit.box, hit.range};
  }

 private:
  Scene scene_;
};

class SceneAny {
 public:
  static constexpr const char* kName = "box_query, yes or no";
  explicit SceneAny(const std::vector<OrientedBox>& boxes) : scene_(sceneOf(boxes)) {}
  SceneAnswer operator()(const Ray& ray) const { return {scene_.castAny(ray)}; }

 private:
  Scene scene_;
};

/// Compares exact parameters, rounds the range once.
class ExactClosest {
 public:
  static constexpr const char* kName = ExactAlways::kName;
  explicit ExactClosest(const std::vector<OrientedBox>& boxes)
      : boxes_(boxes.begin(), boxes.end()) {}
  SceneAnswer operator()(const Ray& ray) const {
    const exact::Component component = exact::component(ray);
    SceneAnswer closest;
    exact::Parameter t;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const exact::Clip clip = exact::clip(component, boxes_[i]);
      if (clip.num_points > 0 && (!closest.hit || compare(clip.enter, t) < 0)) {
        closest.hit = true;
        closest.box = i;
        t = clip.enter;
      }
    }
    if (closest.hit) {
      closest.range = exact::roundedRange(t, dot(component.direction, component.direction));
    }
    return closest;
  }

 private:
  std::vector<Box> boxes_;
};

/// Compares correctly rounded parameters, and where they are equal exact ones.
class DoubleDoubleClosest {
 public:
  static constexpr const char* kName = DoubleDoubleAlways::kName;
  explicit DoubleDoubleClosest(std::vector<OrientedBox> boxes) : boxes_(std::move(boxes)) {}
  SceneAnswer operator()(const Ray& ray) const {
    const exact::Component component = exact::component(ray);
    SceneAnswer closest;
    double t = 0.0;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const Answer answer = DoubleDoubleAlways::ask(ray, boxes_[i]);
      if (answer.hit &&
          (!closest.hit || answer.t < t ||
           (answer.t == t && compare(exact::clip(component, boxes_[i]).enter,
                                     exact::clip(component, boxes_[closest.box]).enter) < 0))) {
        closest.hit = true;
        closest.box = i;
        t = answer.t;
      }
    }
    if (closest.hit) {
      closest.range = exact::roundedRange(exact::clip(component, boxes_[closest.box]).enter,
                                          dot(component.direction, component.direction));
    }
    return closest;
  }

 private:
  std::vector<OrientedBox> boxes_;
};

}  // namespace box_query::benchmark
