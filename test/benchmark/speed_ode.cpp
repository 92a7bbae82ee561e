// SPDX-License-Identifier: BSD-3-Clause
// ODE as its manual has it for many geoms that stay where they are: a quadtree space, asked by a
// ray geom; its callback is given what the ray may meet.
#include "benchmark/speed_peers.h"

#include <cmath>
#include <limits>

#include <ode/ode.h>
#include <ode/version.h>

namespace box_query::benchmark {
namespace {

struct Library {
  Library() { dInitODE2(0); }
  ~Library() { dCloseODE(); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

class Ode final : public SpeedMethod {
 public:
  explicit Ode(const std::vector<OrientedBox>& boxes) : extent_(boxes) {
    static const Library library;
    const Vector3 middle = 0.5 * (extent_.lo + extent_.hi);
    const Vector3 sides = extent_.hi - extent_.lo;
    const dVector3 center = {middle.x(), middle.y(), middle.z(), 0.0};
    const dVector3 size = {sides.x(), sides.y(), sides.z(), 0.0};
    // A few boxes a block, of which there are four times as many with every level.
    const double levels = std::log2(static_cast<double>(boxes.size()) / 4.0) / 2.0;
    space_ = dQuadTreeSpaceCreate(nullptr, center, size,
                                  std::min(8, std::max(1, static_cast<int>(std::ceil(levels)))));
    for (const OrientedBox& box : boxes) {
      const Vector3 full = 2.0 * box.half_extents;
      const Quaternion q = box.orientation.normalized();
      const dQuaternion turned = {q.w(), q.x(), q.y(), q.z()};
      auto* const geom = dCreateBox(space_, full.x(), full.y(), full.z());
      dGeomSetPosition(geom, box.center.x(), box.center.y(), box.center.z());
      dGeomSetQuaternion(geom, turned);
      // NOLINTNEXTLINE(performance-no-int-to-ptr): a number, followed by nobody
      dGeomSetData(geom, reinterpret_cast<void*>(number_++));
    }
    ray_ = dCreateRay(nullptr, kRange);
    ask(Question::kClosest30, {middle, Vector3::UnitX()});  // its first question bounds all geoms
  }
  ~Ode() override {
    dGeomDestroy(ray_);
    dSpaceDestroy(space_);
  }
  Ode(const Ode&) = delete;
  Ode& operator=(const Ode&) = delete;

  bool canAnswer(Question question) const override {
    return question != Question::kClearance && question != Question::kWithin;
  }
  SpeedAnswer ask(Question question, const Ray& ray) const override {
    dGeomRaySetLength(ray_, lengthOf(question, extent_, ray.origin));
    dGeomRaySet(ray_, ray.origin.x(), ray.origin.y(), ray.origin.z(), ray.direction.x(),
                ray.direction.y(), ray.direction.z());
    Found found;
    found.any = question == Question::kAny30 || question == Question::kSegment;
    dSpaceCollide2(ray_, reinterpret_cast<dGeomID>(space_), &found, meet);
    if (question == Question::kAll30) {
      return allOf(found.count);
    }
    if (found.any) {
      return {found.count > 0 ? 0 : kNoBox};
    }
    return {found.box, question == Question::kRounded30 && found.count > 0 ? found.depth : 0.0};
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf(*this, question, rays);
  }

 private:
  struct Found {
    bool any = false;
    std::size_t count = 0;
    std::size_t box = kNoBox;
    double depth = std::numeric_limits<double>::infinity();
  };

  static void meet(void* context, dGeomID a, dGeomID b) {
    auto& found = *static_cast<Found*>(context);
    dContactGeom contact;
    if ((found.any && found.count > 0) || dCollide(a, b, 1, &contact, sizeof contact) == 0) {
      return;
    }
    ++found.count;
    if (contact.depth < found.depth) {
      found.depth = contact.depth;
      auto* const box = dGeomGetClass(a) == dBoxClass ? a : b;
      found.box = reinterpret_cast<std::size_t>(dGeomGetData(box));
    }
  }

  Extent extent_;
  std::size_t number_ = 0;
  dSpaceID space_;
  dGeomID ray_;
};

}  // namespace

Peer odePeer() {
  return {std::string("ODE ") + dODE_VERSION, {{"ODE", makeMethod<Ode>, true, 100000}}};
}

}  // namespace box_query::benchmark
