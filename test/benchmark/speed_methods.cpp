// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/methods_slab.h"
#include "benchmark/speed_peers.h"

#include <algorithm>
#include <limits>

namespace box_query::benchmark {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

class Ours final : public SpeedMethod {
 public:
  explicit Ours(const std::vector<OrientedBox>& boxes)
      : scene_(std::vector<Box>(boxes.begin(), boxes.end())) {}

  bool canAnswer(Question /*question*/) const override { return true; }
  SpeedAnswer ask(Question question, const Ray& ray) const override {
    switch (question) {
      case Question::kClosest30:
        return {scene_.castClosest(ray, kRange).box};
      case Question::kClosest:
        return {scene_.castClosest(ray).box};
      case Question::kRounded30: {
        const Hit hit = scene_.cast(ray, kRange);
        return {hit.box, hit.hit ? hit.range : 0.0};
      }
      case Question::kAny30:
        return {scene_.castAny(ray, kRange) ? 0 : kNoBox};
      case Question::kAll30:
        return allOf(scene_.findAll(segmentAlong(ray, kRange)).size());
      case Question::kSegment:
        return {scene_.isClear(segmentAlong(ray, kSegmentLength), 0.0) ? kNoBox : 0};
      case Question::kClearance: {
        const Clearance clearance = scene_.clearance(segmentAlong(ray, kPathLength));
        return {clearance.box, clearance.distance};
      }
      case Question::kBuild:
        break;
    }
    return {};
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf(*this, question, rays);
  }

 private:
  Scene scene_;
};

/// One plain slab test in double after the other.
class Scan final : public SpeedMethod {
 public:
  explicit Scan(const std::vector<OrientedBox>& boxes) {
    for (const OrientedBox& box : boxes) {
      boxes_.push_back(slabBox<double>(box));
    }
  }

  bool canAnswer(Question question) const override { return question != Question::kClearance; }
  SpeedAnswer ask(Question question, const Ray& ray) const override {
    const bool any = question == Question::kAny30 || question == Question::kSegment;
    SlabComponent<double> component = slabComponent<double>(ray);
    component.t_max = question == Question::kClosest   ? kInf
                      : question == Question::kSegment ? kSegmentLength
                                                       : kRange;
    if (question == Question::kAll30) {
      return allOf(static_cast<std::size_t>(
          std::count_if(boxes_.begin(), boxes_.end(), [&](const SlabBox<double>& box) {
            return clipBySlabs<double, NoPad>(component, box).hit;
          })));
    }
    SpeedAnswer result;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const Answer answer = clipBySlabs<double, NoPad>(component, boxes_[i]);
      if (answer.hit && (any || result.box == kNoBox || answer.t < component.t_max)) {
        result = {i, question == Question::kRounded30 ? answer.t : 0.0};
        component.t_max = answer.t;
        if (any) {
          return {0};
        }
      }
    }
    return result;
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf(*this, question, rays);
  }

 private:
  std::vector<SlabBox<double>> boxes_;
};

}  // namespace

const char* nameOf(Question question) {
  switch (question) {
    case Question::kClosest30:
      return "closest, 30 m";
    case Question::kClosest:
      return "closest";
    case Question::kRounded30:
      return "closest, 30 m, rounded range";
    case Question::kAny30:
      return "any, 30 m";
    case Question::kAll30:
      return "all, 30 m";
    case Question::kSegment:
      return "segment of 10 m";
    case Question::kClearance:
      return "clearance of 2 m";
    case Question::kBuild:
      return "build, a box";
  }
  return "";
}

std::vector<SpeedMethodKind> speedMethods() {
  std::vector<SpeedMethodKind> methods = {{"box_query", makeMethod<Ours>},
                                          {"plain scan", makeMethod<Scan>, false}};
  for (const Peer& peer : peers()) {
    methods.insert(methods.end(), peer.methods.begin(), peer.methods.end());
  }
  return methods;
}

std::vector<std::string> peerNotes() {
  std::vector<std::string> notes;
  for (const Peer& peer : peers()) {
    notes.push_back(peer.note);
  }
  return notes;
}

}  // namespace box_query::benchmark
