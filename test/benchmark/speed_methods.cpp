// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed_peers.h"
#include "benchmark/speed_scans.h"

#include <box_query/batch.h>

#include <algorithm>
#include <numeric>

namespace box_query::benchmark {
namespace {

class Ours final : public SpeedMethod {
 public:
  explicit Ours(const std::vector<OrientedBox>& boxes)
      : scene_(std::vector<Box>(boxes.begin(), boxes.end())), same_(boxes.size()) {
    std::iota(same_.begin(), same_.end(), std::size_t{0});
  }

  bool canAnswer(Question /*question*/) const override { return true; }
  SpeedAnswer ask(Question question, const Ray& ray) const override {
    switch (question) {
      case Question::kClosest30:
        return {scene_.castClosest(ray, kRange).box};
      case Question::kClosest:
        return {scene_.castClosest(ray).box};
      case Question::kRounded30:
        return answerOf(scene_.cast(ray, kRange));
      case Question::kAny30:
        return {scene_.castAny(ray, kRange) ? 0 : kNoBox};
      case Question::kAll30:
        return allOf(scene_.findAll(segmentAlong(ray, kRange)).size());
      case Question::kSegment:
        return {scene_.isClear(segmentAlong(ray, kSegmentLength), 0.0) ? kNoBox : 0};
      case Question::kWithin:
        return {scene_.isClear(segmentAlong(ray, kPathLength), kPathRadius) ? kNoBox : 0};
      case Question::kClearance: {
        const Clearance clearance = scene_.clearance(segmentAlong(ray, kPathLength));
        return {clearance.box, clearance.distance};
      }
      case Question::kBuild:
      case Question::kUpdate:
        break;
    }
    return {};
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf(*this, question, rays);
  }

  bool canUpdate() const override { return true; }
  std::uint64_t update(const std::vector<OrientedBox>& moved) const override {
    const Scene scene = scene_.updated({moved.begin(), moved.end()}, same_);
    return scene.update().moved;
  }

  std::vector<std::string> batchWays(Question /*question*/) const override {
    return {"1 thread", "2 threads"};
  }
  void askEach(Question question, const std::vector<Ray>& rays, std::size_t way,
               std::vector<SpeedAnswer>& answers) const override {
    const BatchOptions options{kRange, nullptr, static_cast<int>(way + 1)};
    switch (question) {
      case Question::kClosest30:
        take(castClosestEach(scene_, rays, options), answers,
             [](const ClosestBox& closest) { return SpeedAnswer{closest.box}; });
        break;
      case Question::kRounded30:
        take(castEach(scene_, rays, options), answers, answerOf);
        break;
      case Question::kAny30:
        take(castAnyEach(scene_, rays, options), answers,
             [](std::uint8_t any) { return SpeedAnswer{any != 0 ? 0 : kNoBox}; });
        break;
      case Question::kSegment:
        take(isClearEach(scene_, segments(rays, kSegmentLength), 0.0, options), answers, notClear);
        break;
      case Question::kWithin:
        take(isClearEach(scene_, segments(rays, kPathLength), kPathRadius, options), answers,
             notClear);
        break;
      case Question::kClearance:
        take(clearanceEach(scene_, segments(rays, kPathLength), options), answers,
             [](const Clearance& clearance) {
               return SpeedAnswer{clearance.box, clearance.distance};
             });
        break;
      default:
        break;
    }
  }

 private:
  static SpeedAnswer notClear(std::uint8_t clear) { return {clear != 0 ? kNoBox : 0}; }
  static SpeedAnswer answerOf(const Hit& hit) { return {hit.box, hit.hit ? hit.range : 0.0}; }
  /// As a caller has them: those of the last call stay.
  const std::vector<Segment>& segments(const std::vector<Ray>& rays, double length) const {
    if (rays.data() != rays_of_segments_ || segments_.size() != rays.size() || length != length_) {
      segments_.clear();
      for (const Ray& ray : rays) {
        segments_.push_back(segmentAlong(ray, length));
      }
      rays_of_segments_ = rays.data();
      length_ = length;
    }
    return segments_;
  }
  template <typename Found, typename Convert>
  static void take(const std::vector<Found>& found, std::vector<SpeedAnswer>& answers,
                   const Convert& convert) {
    std::transform(found.begin(), found.end(), answers.begin(), convert);
  }

  Scene scene_;
  std::vector<std::size_t> same_;  ///< Each box is the one that it was.
  mutable std::vector<Segment> segments_;
  mutable const Ray* rays_of_segments_ = nullptr;
  mutable double length_ = 0.0;
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
    case Question::kWithin:
      return "within 0.3 m of 2 m";
    case Question::kClearance:
      return "clearance of 2 m";
    case Question::kBuild:
      return "build, a box";
    case Question::kUpdate:
      return "update, a box";
  }
  return "";
}

const char* nameOf(Mode mode) {
  switch (mode) {
    case Mode::kSingle:
      return "single";
    case Mode::kBatch:
      return "batch";
    case Mode::kThreads:
      return "threads";
  }
  return "";
}

std::vector<SpeedMethodKind> speedMethods() {
  std::vector<SpeedMethodKind> methods = {{"box_query", makeMethod<Ours>},
                                          {"plain scan", makeScan, false, 2000}};
  for (const Peer& peer : peers()) {
    methods.insert(methods.end(), peer.methods.begin(), peer.methods.end());
  }
  return methods;
}

std::vector<SpeedMethodKind> pairMethods() {
  return {{"box_query", makeMethod<Ours>},
          {"double slabs, one by one", makeScan, false},
          {"double slabs, eight at once", makeSlabsOfEight, false},
          {"listing 9, one by one", makeFindScan, false},
          {"exact distances, one by one", makeExactScan, false}};
}

std::vector<std::string> peerNotes() {
  std::vector<std::string> notes;
  for (const Peer& peer : peers()) {
    notes.push_back(peer.note);
  }
  return notes;
}

}  // namespace box_query::benchmark
