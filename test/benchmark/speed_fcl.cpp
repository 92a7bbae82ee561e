// SPDX-License-Identifier: BSD-3-Clause
// FCL as its documentation has it: a dynamic AABB tree manager with the callbacks that come with
// it. It has no rays: segments are capsules without a radius, asked for a collision or a distance.
#include "benchmark/speed_peers.h"

#include <limits>

#include <fcl/fcl.h>

namespace box_query::benchmark {
namespace {

class Fcl final : public SpeedMethod {
 public:
  explicit Fcl(const std::vector<OrientedBox>& boxes) {
    std::vector<fcl::CollisionObjectd*> all;
    for (const OrientedBox& box : boxes) {
      fcl::Transform3d pose = fcl::Transform3d::Identity();
      pose.linear() = box.orientation.normalized().toRotationMatrix();
      pose.translation() = box.center;
      const Vector3 sides = 2.0 * box.half_extents;
      objects_.push_back(
          std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Boxd>(sides), pose));
      // NOLINTNEXTLINE(performance-no-int-to-ptr): a number, followed by nobody
      objects_.back()->setUserData(reinterpret_cast<void*>(objects_.size() - 1));
      all.push_back(objects_.back().get());
    }
    manager_.registerObjects(all);
    manager_.setup();
  }

  bool canAnswer(Question question) const override {
    return question == Question::kAny30 || question == Question::kSegment ||
           question == Question::kClearance;
  }
  SpeedAnswer ask(Question question, const Ray& ray) const override {
    if (question != Question::kClearance) {
      fcl::CollisionObjectd segment =
          capsule(ray, question == Question::kAny30 ? kRange : kSegmentLength);
      fcl::DefaultCollisionData<double> data;
      manager_.collide(&segment, &data, fcl::DefaultCollisionFunction);
      return {data.result.isCollision() ? 0 : kNoBox};
    }
    fcl::CollisionObjectd segment = capsule(ray, kPathLength);
    Nearest nearest;
    nearest.segment = &segment;
    manager_.distance(&segment, &nearest, nearer);
    return {nearest.box, std::max(0.0, nearest.data.result.min_distance)};
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf(*this, question, rays);
  }
  std::vector<std::string> batchWays(Question question) const override {
    return question == Question::kClearance ? std::vector<std::string>{kOneByOne}
                                            : std::vector<std::string>{};
  }

 private:
  struct Nearest {
    const fcl::CollisionObjectd* segment = nullptr;
    fcl::DefaultDistanceData<double> data;
    std::size_t box = kNoBox;
  };

  /// FCL's own callback, and which box it was.
  static bool nearer(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* context,
                     double& distance) {
    auto& nearest = *static_cast<Nearest*>(context);
    const double before = nearest.data.result.min_distance;
    const bool done = fcl::DefaultDistanceFunction(a, b, &nearest.data, distance);
    if (nearest.data.result.min_distance < before) {
      nearest.box = numberOf(a == nearest.segment ? b : a);
    }
    return done;
  }

  static std::size_t numberOf(const fcl::CollisionObjectd* object) {
    return reinterpret_cast<std::size_t>(object->getUserData());
  }

  static fcl::CollisionObjectd capsule(const Ray& ray, double length) {
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    pose.linear() =
        fcl::Quaterniond::FromTwoVectors(fcl::Vector3d::UnitZ(), ray.direction).toRotationMatrix();
    pose.translation() = ray.origin + 0.5 * length * ray.direction;
    return {std::make_shared<fcl::Capsuled>(0.0, length), pose};
  }

  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
};

}  // namespace

Peer fclPeer() {
  return {"FCL " FCL_VERSION, {{"FCL", makeMethod<Fcl>}}};
}

}  // namespace box_query::benchmark
