// SPDX-License-Identifier: BSD-3-Clause
// Bullet in double, as its manual has it: static collision objects in a world with a dynamic
// bounding volume tree, asked by rayTest(). The nearest box it cannot be asked for: that is a
// search of its tree with its own distance of two convex shapes.
#include "benchmark/speed_peers.h"

#include <deque>
#include <limits>

#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <btBulletCollisionCommon.h>

namespace box_query::benchmark {
namespace {

btVector3 toBullet(const Vector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// Nothing that comes after it is closer.
struct AnyHit : btCollisionWorld::RayResultCallback {
  btScalar addSingleResult(btCollisionWorld::LocalRayResult& result, bool /*normal*/) override {
    m_collisionObject = result.m_collisionObject;
    return m_closestHitFraction = 0.0;
  }
};

class Bullet final : public SpeedMethod {
 public:
  explicit Bullet(const std::vector<OrientedBox>& boxes) : extent_(boxes) {
    for (const OrientedBox& box : boxes) {
      // Bullet's margin is for contacts: a box of the very size has none.
      shapes_.emplace_back(toBullet(box.half_extents)).setMargin(0.0);
      const Quaternion q = box.orientation.normalized();
      btCollisionObject& object = objects_.emplace_back();
      object.setCollisionShape(&shapes_.back());
      object.setWorldTransform(btTransform({q.x(), q.y(), q.z(), q.w()}, toBullet(box.center)));
      object.setUserPointer(&object);
      object.setUserIndex(static_cast<int>(objects_.size() - 1));
      world_.addCollisionObject(&object, btBroadphaseProxy::StaticFilter,
                                btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
    }
    broadphase_.optimize();  // Most of the time of the build, for up to a half of a query's.
  }

  bool canAnswer(Question question) const override { return question != Question::kWithin; }
  SpeedAnswer ask(Question question, const Ray& ray) const override {
    if (question == Question::kClearance) {
      return nearest(segmentAlong(ray, kPathLength));
    }
    const double length = lengthOf(question, extent_, ray.origin);
    const btVector3 from = toBullet(ray.origin);
    const btVector3 to = toBullet(ray.origin + length * ray.direction);
    if (question == Question::kAll30) {
      btCollisionWorld::AllHitsRayResultCallback all(from, to);
      world_.rayTest(from, to, all);
      return allOf(static_cast<std::size_t>(all.m_collisionObjects.size()));
    }
    if (question == Question::kAny30 || question == Question::kSegment) {
      AnyHit any;
      world_.rayTest(from, to, any);
      return {any.hasHit() ? 0 : kNoBox};
    }
    btCollisionWorld::ClosestRayResultCallback closest(from, to);
    world_.rayTest(from, to, closest);
    if (!closest.hasHit()) {
      return {};
    }
    return {static_cast<std::size_t>(closest.m_collisionObject->getUserIndex()),
            question == Question::kRounded30 ? closest.m_closestHitFraction * length : 0.0};
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf(*this, question, rays);
  }
  std::vector<std::string> batchWays(Question question) const override {
    return question == Question::kClearance ? std::vector<std::string>{kOneByOne}
                                            : std::vector<std::string>{};
  }

 private:
  /// Depth first, what is nearer first, without what is behind the best box.
  SpeedAnswer nearest(const Segment& segment) const {
    SpeedAnswer best{kNoBox, std::numeric_limits<double>::infinity()};
    // Of its shapes, a triangle is the lightest that can be a segment.
    btTriangleShape shape({0.0, 0.0, 0.0}, toBullet(segment.end - segment.start),
                          toBullet(segment.end - segment.start));
    shape.setMargin(0.0);
    const btVector3 lo = toBullet(segment.start.cwiseMin(segment.end));
    const btVector3 hi = toBullet(segment.start.cwiseMax(segment.end));
    const auto squaredBound = [&](const btDbvtNode* node) {
      btVector3 gap = node->volume.Mins() - hi;
      gap.setMax(lo - node->volume.Maxs());
      gap.setMax({0.0, 0.0, 0.0});
      return gap.length2();
    };
    struct Entry {
      const btDbvtNode* node;
      double squared_bound;
    };
    std::vector<Entry> stack;
    const btDbvtNode* root = broadphase_.m_sets[0].m_root;
    if (root != nullptr) {
      stack.push_back({root, 0.0});
    }
    while (!stack.empty()) {
      const Entry entry = stack.back();
      stack.pop_back();
      if (entry.squared_bound >= best.value * best.value) {
        continue;
      }
      if (entry.node->isleaf()) {
        const auto* proxy = static_cast<const btBroadphaseProxy*>(entry.node->data);
        const auto* object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
        const double d = distance(shape, segment.start, *object);
        if (d < best.value) {
          best = {static_cast<std::size_t>(object->getUserIndex()), d};
        }
        continue;
      }
      Entry near{entry.node->childs[0], squaredBound(entry.node->childs[0])};
      Entry far{entry.node->childs[1], squaredBound(entry.node->childs[1])};
      if (far.squared_bound < near.squared_bound) {
        std::swap(near, far);
      }
      stack.push_back(far);
      stack.push_back(near);
    }
    return best;
  }

  /// Without a solver for penetration there is no result where they meet.
  static double distance(const btConvexShape& shape, const Vector3& at,
                         const btCollisionObject& object) {
    btVoronoiSimplexSolver simplex;
    const auto* const box =
        static_cast<const btBoxShape*>(object.getCollisionShape());  // NOLINT: all of them are
    btGjkPairDetector detector(&shape, box, &simplex, nullptr);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA.setIdentity();
    input.m_transformA.setOrigin(toBullet(at));
    input.m_transformB = object.getWorldTransform();
    btPointCollector result;
    detector.getClosestPoints(input, result, nullptr);
    return result.m_hasResult ? result.m_distance : 0.0;
  }

  Extent extent_;
  std::deque<btBoxShape> shapes_;
  std::deque<btCollisionObject> objects_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
};

}  // namespace

Peer bulletPeer() {
  return {"Bullet " + std::to_string(BT_BULLET_VERSION / 100) + "." +
              std::to_string(BT_BULLET_VERSION % 100) + " in double",
          {{"Bullet", makeMethod<Bullet>}}};
}

}  // namespace box_query::benchmark
