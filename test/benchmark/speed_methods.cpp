// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed_peers.h"
#include "benchmark/speed_scans.h"

namespace box_query::benchmark {
namespace {

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
                                          {"plain scan", makeScan, false}};
  for (const Peer& peer : peers()) {
    methods.insert(methods.end(), peer.methods.begin(), peer.methods.end());
  }
  return methods;
}

std::vector<SpeedMethodKind> pairMethods() {
  return {{"box_query", makeMethod<Ours>},
          {"double slabs, one by one", makeScan, false},
          {"double slabs, eight at once", makeSlabsOfEight, false},
          {"listing 9, one by one", makeFindScan, false}};
}

std::vector<std::string> peerNotes() {
  std::vector<std::string> notes;
  for (const Peer& peer : peers()) {
    notes.push_back(peer.note);
  }
  return notes;
}

}  // namespace box_query::benchmark
