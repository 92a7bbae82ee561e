// SPDX-License-Identifier: BSD-3-Clause
// Embree 3 as its documentation recommends it for static scenes of high quality, one ray a call.
#include "benchmark/methods_slab.h"
#include "benchmark/speed_peers.h"

#include <box_query/distance.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

#include <dlfcn.h>
#include <embree3/rtcore.h>

namespace box_query::benchmark {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

struct DeviceOwner {
  RTCDevice device = rtcNewDevice("threads=1");
  ~DeviceOwner() { rtcReleaseDevice(device); }
};

RTCDevice device() {
  static const DeviceOwner owner;
  return owner.device;
}

RTCRay rtcRay(const Ray& ray, double end) {
  RTCRay r = {};
  r.org_x = static_cast<float>(ray.origin.x());
  r.org_y = static_cast<float>(ray.origin.y());
  r.org_z = static_cast<float>(ray.origin.z());
  r.dir_x = static_cast<float>(ray.direction.x());
  r.dir_y = static_cast<float>(ray.direction.y());
  r.dir_z = static_cast<float>(ray.direction.z());
  r.tfar = static_cast<float>(end);
  r.mask = ~0U;
  return r;
}

/// The box in double, asked about the ray in double, as a user would who needs both.
struct UserBox {
  SlabBox<double> slabs;
  OrientedBox box;
  float lo[3];
  float hi[3];
};

void boundsOf(const RTCBoundsFunctionArguments* args) {
  const UserBox& box = static_cast<const UserBox*>(args->geometryUserPtr)[args->primID];
  *args->bounds_o = {box.lo[0], box.lo[1], box.lo[2], 0.0F, box.hi[0], box.hi[1], box.hi[2], 0.0F};
}

Answer clip(const UserBox& box, const RTCRay& ray) {
  const SlabComponent<double> component = {
      {ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}, ray.tnear, ray.tfar};
  return clipBySlabs<double, NoPad>(component, box.slabs);
}

/// What comes with a ray to the callbacks.
struct Context {
  RTCIntersectContext embree;  ///< First: that is what Embree knows.
  bool counts = false;         ///< Boxes, instead of looking for the closest.
  std::size_t count = 0;

  explicit Context(bool counting = false) : counts(counting) { rtcInitIntersectContext(&embree); }
};

void intersect(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) {
    return;
  }
  auto* hit = reinterpret_cast<RTCRayHit*>(args->rayhit);
  const UserBox& box = static_cast<const UserBox*>(args->geometryUserPtr)[args->primID];
  const Answer answer = clip(box, hit->ray);
  if (!answer.hit) {
    return;
  }
  auto* context = reinterpret_cast<Context*>(args->context);
  if (context->counts) {
    ++context->count;
  } else {
    hit->ray.tfar = static_cast<float>(answer.t);
    hit->hit.geomID = args->geomID;
    hit->hit.primID = args->primID;
    hit->hit.instID[0] = args->context->instID[0];
  }
}

void occluded(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) {
    return;
  }
  auto* ray = reinterpret_cast<RTCRay*>(args->ray);
  const UserBox& box = static_cast<const UserBox*>(args->geometryUserPtr)[args->primID];
  if (clip(box, *ray).hit) {
    ray->tfar = -kInf;
  }
}

class Embree : public SpeedMethod {
 public:
  explicit Embree(std::size_t primitives_a_box) : primitives_a_box_(primitives_a_box) {
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  }
  ~Embree() override { rtcReleaseScene(scene_); }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  SpeedAnswer ask(Question question, const Ray& ray) const override {
    Context context(question == Question::kAll30);
    if (question == Question::kAny30 || question == Question::kSegment) {
      RTCRay r = rtcRay(ray, question == Question::kAny30 ? kRange : kSegmentLength);
      rtcOccluded1(scene_, &context.embree, &r);
      return {r.tfar < 0.0F ? 0 : kNoBox};
    }
    RTCRayHit hit = {};
    hit.ray = rtcRay(ray, question == Question::kClosest ? kInf : kRange);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context.embree, &hit);
    if (context.counts) {
      return allOf(context.count);
    }
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
      return {};
    }
    return {hit.hit.primID / primitives_a_box_,
            question == Question::kRounded30 ? static_cast<double>(hit.ray.tfar) : 0.0};
  }

 protected:
  void commit(RTCGeometry geometry) {
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }

  RTCScene scene_ = rtcNewScene(device());

 private:
  std::size_t primitives_a_box_;
};

class EmbreeBoxes final : public Embree {
 public:
  explicit EmbreeBoxes(const std::vector<OrientedBox>& boxes) : Embree(1) {
    for (const OrientedBox& box : boxes) {
      UserBox user{slabBox<double>(box), box, {}, {}};
      for (int j = 0; j < 3; ++j) {
        double half = 0.0;
        for (int i = 0; i < 3; ++i) {
          half += std::fabs(user.slabs.axes[i][j]) * box.half_extents[i];
        }
        user.lo[j] = std::nextafter(static_cast<float>(box.center[j] - half), -kInf);
        user.hi[j] = std::nextafter(static_cast<float>(box.center[j] + half), kInf);
      }
      boxes_.push_back(user);
    }
    RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(boxes_.size()));
    rtcSetGeometryUserData(geometry, boxes_.data());
    rtcSetGeometryBoundsFunction(
        geometry, [](const RTCBoundsFunctionArguments* args) { boundsOf(args); }, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcSetGeometryOccludedFunction(geometry, occluded);
    commit(geometry);
  }

  bool canAnswer(Question /*question*/) const override { return true; }
  SpeedAnswer ask(Question question, const Ray& ray) const override {
    return question == Question::kClearance ? nearest(segmentAlong(ray, kPathLength))
                                            : Embree::ask(question, ray);
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf(*this, question, rays);
  }

 private:
  struct Search {
    const EmbreeBoxes& method;
    const Segment& segment;
    double half_length;
    SpeedAnswer best;
  };

  /// A ball around the segment, as small as the best box allows, with the library's own leaf.
  SpeedAnswer nearest(const Segment& segment) const {
    Search search{*this,
                  segment,
                  0.5 * (segment.end - segment.start).norm(),
                  {kNoBox, std::numeric_limits<double>::infinity()}};
    const Vector3 middle = 0.5 * (segment.start + segment.end);
    RTCPointQuery query = {};
    query.x = static_cast<float>(middle.x());
    query.y = static_cast<float>(middle.y());
    query.z = static_cast<float>(middle.z());
    query.radius = kInf;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(
        scene_, &query, &context,
        [](RTCPointQueryFunctionArguments* args) {
          auto& s = *static_cast<Search*>(args->userPtr);
          const double d = distance(s.segment, s.method.boxes_[args->primID].box).distance;
          if (d < s.best.value) {
            s.best = {args->primID, d};
            args->query->radius = static_cast<float>((d + s.half_length) * (1.0 + 1e-6));
            return true;
          }
          return false;
        },
        &search);
    return search.best;
  }

  std::vector<UserBox> boxes_;
};

class EmbreeTriangles final : public Embree {
 public:
  explicit EmbreeTriangles(const std::vector<OrientedBox>& boxes) : Embree(12) {
    RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), 8 * boxes.size()));
    auto* indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), 12 * boxes.size()));
    constexpr unsigned kTriangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                            {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                            {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      const Eigen::Matrix3d rotation = boxes[b].orientation.normalized().toRotationMatrix();
      for (unsigned corner = 0; corner < 8; ++corner) {
        const Vector3 signs((corner & 1U) != 0 ? 1 : -1, (corner & 2U) != 0 ? 1 : -1,
                            (corner & 4U) != 0 ? 1 : -1);
        const Vector3 at = boxes[b].center + rotation * signs.cwiseProduct(boxes[b].half_extents);
        for (int i = 0; i < 3; ++i) {
          *vertices++ = static_cast<float>(at[i]);
        }
      }
      for (const auto& triangle : kTriangles) {
        for (const unsigned corner : triangle) {
          *indices++ = static_cast<unsigned>(8 * b) + corner;
        }
      }
    }
    commit(geometry);
  }

  bool canAnswer(Question question) const override {
    return question != Question::kClearance && question != Question::kAll30;
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf<Embree>(*this, question, rays);
  }
};

/// Whether the library that was loaded reports failed assertions: then it was built with them.
bool hasAssertions() {
  Dl_info info = {};
  if (dladdr(reinterpret_cast<const void*>(&rtcNewDevice), &info) == 0) {
    return false;
  }
  std::ifstream library(info.dli_fname, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(library), {}};
  return bytes.find("__assert_fail") != std::string::npos;
}

}  // namespace

Peer embreePeer() {
  const auto version = rtcGetDeviceProperty(device(), RTC_DEVICE_PROPERTY_VERSION);
  return {"Embree " + std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) +
              "." + std::to_string(version % 100) +
              (hasAssertions() ? ", built with assertions, which cost it time"
                               : ", built without assertions"),
          {{"Embree, boxes", makeMethod<EmbreeBoxes>},
           {"Embree, triangles", makeMethod<EmbreeTriangles>}}};
}

}  // namespace box_query::benchmark
