// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/methods_slab.h"
#include "benchmark/speed_embree.h"

#include <box_query/distance.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace box_query::benchmark {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

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

Answer clip(const UserBox& box, RTCRayN* rays, unsigned n, unsigned i) {
  const SlabComponent<double> component = {
      {RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
      {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)},
      RTCRayN_tnear(rays, n, i),
      RTCRayN_tfar(rays, n, i)};
  return clipBySlabs<double, NoPad>(component, box.slabs);
}

/// Ray i of n.
inline void intersectOne(const RTCIntersectFunctionNArguments* args, unsigned n, unsigned i) {
  if (args->valid[i] == 0) {
    return;
  }
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
  const Answer answer =
      clip(static_cast<const UserBox*>(args->geometryUserPtr)[args->primID], rays, n, i);
  if (!answer.hit) {
    return;
  }
  auto* context = reinterpret_cast<EmbreeContext*>(args->context);
  if (context->counts) {
    ++context->count;
    return;
  }
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
  RTCRayN_tfar(rays, n, i) = static_cast<float>(answer.t);
  RTCHitN_geomID(hits, n, i) = args->geomID;
  RTCHitN_primID(hits, n, i) = args->primID;
  RTCHitN_instID(hits, n, i, 0) = args->context->instID[0];
}

inline void occludeOne(const RTCOccludedFunctionNArguments* args, unsigned n, unsigned i) {
  if (args->valid[i] != 0 &&
      clip(static_cast<const UserBox*>(args->geometryUserPtr)[args->primID], args->ray, n, i).hit) {
    RTCRayN_tfar(args->ray, n, i) = -kInf;
  }
}

/// (Of one ray, which is most often, places are known to the compiler.)
void intersect(const RTCIntersectFunctionNArguments* args) {
  if (args->N == 1) {
    intersectOne(args, 1, 0);
    return;
  }
  for (unsigned i = 0; i < args->N; ++i) {
    intersectOne(args, args->N, i);
  }
}
void occluded(const RTCOccludedFunctionNArguments* args) {
  if (args->N == 1) {
    occludeOne(args, 1, 0);
    return;
  }
  for (unsigned i = 0; i < args->N; ++i) {
    occludeOne(args, args->N, i);
  }
}

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
    RTCGeometry geometry = rtcNewGeometry(embreeDevice(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(boxes_.size()));
    rtcSetGeometryUserData(geometry, boxes_.data());
    rtcSetGeometryBoundsFunction(
        geometry, [](const RTCBoundsFunctionArguments* args) { boundsOf(args); }, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcSetGeometryOccludedFunction(geometry, occluded);
    commit(geometry);
  }

  bool canAnswer(Question question) const override { return question != Question::kWithin; }
  SpeedAnswer ask(Question question, const Ray& ray) const override {
    return question == Question::kClearance ? nearest(segmentAlong(ray, kPathLength))
                                            : Embree::ask(question, ray);
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf(*this, question, rays);
  }
  std::vector<std::string> batchWays(Question question) const override {
    return question == Question::kClearance ? std::vector<std::string>{kOneByOne}
                                            : Embree::batchWays(question);
  }
  void askEach(Question question, const std::vector<Ray>& rays, std::size_t way,
               std::vector<SpeedAnswer>& answers) const override {
    if (question == Question::kClearance) {
      std::transform(rays.begin(), rays.end(), answers.begin(),
                     [&](const Ray& ray) { return ask(question, ray); });
    } else {
      Embree::askEach(question, rays, way, answers);
    }
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

}  // namespace

std::unique_ptr<SpeedMethod> makeEmbreeBoxes(const std::vector<OrientedBox>& boxes) {
  return std::make_unique<EmbreeBoxes>(boxes);
}

}  // namespace box_query::benchmark
