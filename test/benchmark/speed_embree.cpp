// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed_embree.h"

#include <fstream>
#include <iterator>
#include <limits>

#include <dlfcn.h>
#include <tbb/global_control.h>

namespace box_query::benchmark {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
/// Rays of a stream: what stays in the first cache.
constexpr std::size_t kStream = 256;

struct DeviceOwner {
  RTCDevice device = rtcNewDevice(nullptr);
  DeviceOwner() = default;
  DeviceOwner(const DeviceOwner&) = delete;
  DeviceOwner& operator=(const DeviceOwner&) = delete;
  ~DeviceOwner() { rtcReleaseDevice(device); }
};

bool isYesOrNo(Question question) {
  return question == Question::kAny30 || question == Question::kSegment;
}

float endOf(Question question) {
  return question == Question::kClosest   ? kInf
         : question == Question::kSegment ? static_cast<float>(kSegmentLength)
                                          : static_cast<float>(kRange);
}

RTCRay rtcRay(const Ray& ray, float end) {
  RTCRay r = {};
  r.org_x = static_cast<float>(ray.origin.x());
  r.org_y = static_cast<float>(ray.origin.y());
  r.org_z = static_cast<float>(ray.origin.z());
  r.dir_x = static_cast<float>(ray.direction.x());
  r.dir_y = static_cast<float>(ray.direction.y());
  r.dir_z = static_cast<float>(ray.direction.z());
  r.tfar = end;
  r.mask = ~0U;
  return r;
}

/// Rays and where they hit, in a row.
struct StreamOfRays {
  static constexpr std::size_t kSize = kStream;
  RTCRayHit hits[kSize];
  RTCRay rays[kSize];

  void set(std::size_t i, const Ray& ray, float end, bool yes_or_no) {
    if (yes_or_no) {
      rays[i] = rtcRay(ray, end);
    } else {
      hits[i].ray = rtcRay(ray, end);
      hits[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
    }
  }
  void intersect(RTCScene scene, RTCIntersectContext* context, std::size_t count) {
    rtcIntersect1M(scene, context, hits, static_cast<unsigned>(count), sizeof hits[0]);
  }
  void occluded(RTCScene scene, RTCIntersectContext* context, std::size_t count) {
    rtcOccluded1M(scene, context, rays, static_cast<unsigned>(count), sizeof rays[0]);
  }
  bool isOccluded(std::size_t i) const { return rays[i].tfar < 0.0F; }
  unsigned geometry(std::size_t i) const { return hits[i].hit.geomID; }
  unsigned primitive(std::size_t i) const { return hits[i].hit.primID; }
  float range(std::size_t i) const { return hits[i].ray.tfar; }
};

/// Sixteen of them, a structure of arrays.
struct PacketOfRays {
  static constexpr std::size_t kSize = 16;
  RTCRayHit16 packet;

  void set(std::size_t i, const Ray& ray, float end, bool /*yes_or_no*/) {
    packet.ray.org_x[i] = static_cast<float>(ray.origin.x());
    packet.ray.org_y[i] = static_cast<float>(ray.origin.y());
    packet.ray.org_z[i] = static_cast<float>(ray.origin.z());
    packet.ray.dir_x[i] = static_cast<float>(ray.direction.x());
    packet.ray.dir_y[i] = static_cast<float>(ray.direction.y());
    packet.ray.dir_z[i] = static_cast<float>(ray.direction.z());
    packet.ray.tnear[i] = 0.0F;
    packet.ray.tfar[i] = end;
    packet.ray.time[i] = 0.0F;
    packet.ray.mask[i] = ~0U;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  void intersect(RTCScene scene, RTCIntersectContext* context, std::size_t count) {
    rtcIntersect16(Valid(count).lanes, scene, context, &packet);
  }
  void occluded(RTCScene scene, RTCIntersectContext* context, std::size_t count) {
    rtcOccluded16(Valid(count).lanes, scene, context, &packet.ray);
  }
  bool isOccluded(std::size_t i) const { return packet.ray.tfar[i] < 0.0F; }
  unsigned geometry(std::size_t i) const { return packet.hit.geomID[i]; }
  unsigned primitive(std::size_t i) const { return packet.hit.primID[i]; }
  float range(std::size_t i) const { return packet.ray.tfar[i]; }

 private:
  struct Valid {
    alignas(64) int lanes[kSize];
    explicit Valid(std::size_t count) {
      for (std::size_t i = 0; i < kSize; ++i) {
        lanes[i] = i < count ? -1 : 0;
      }
    }
  };
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

RTCDevice embreeDevice() {
  static const DeviceOwner owner;
  return owner.device;
}

Embree::Embree(std::size_t primitives_a_box)
    : scene_(rtcNewScene(embreeDevice())), primitives_a_box_(primitives_a_box) {
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
}

Embree::~Embree() {
  rtcReleaseScene(scene_);
}

void Embree::commit(RTCGeometry geometry) {
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  // Its own option for this would hold for all that the process does with TBB.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  rtcCommitScene(scene_);
}

SpeedAnswer Embree::ask(Question question, const Ray& ray) const {
  EmbreeContext context(question == Question::kAll30);
  if (isYesOrNo(question)) {
    RTCRay r = rtcRay(ray, endOf(question));
    rtcOccluded1(scene_, &context.embree, &r);
    return {r.tfar < 0.0F ? 0 : kNoBox};
  }
  RTCRayHit hit = {};
  hit.ray = rtcRay(ray, endOf(question));
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

std::vector<std::string> Embree::batchWays(Question question) const {
  if (question == Question::kAll30 || question == Question::kWithin ||
      question == Question::kClearance) {
    return {};
  }
  return {"stream", "packets"};
}

void Embree::askEach(Question question, const std::vector<Ray>& rays, std::size_t way,
                     std::vector<SpeedAnswer>& answers) const {
  if (way == 0) {
    askParts<StreamOfRays>(question, rays, answers);
  } else {
    askParts<PacketOfRays>(question, rays, answers);
  }
}

template <typename Rays>
void Embree::askParts(Question question, const std::vector<Ray>& rays,
                      std::vector<SpeedAnswer>& answers) const {
  EmbreeContext context;
  Rays part;
  const bool yes_or_no = isYesOrNo(question);
  for (std::size_t begin = 0; begin < rays.size(); begin += Rays::kSize) {
    const std::size_t count = std::min(Rays::kSize, rays.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      part.set(i, rays[begin + i], endOf(question), yes_or_no);
    }
    if (yes_or_no) {
      part.occluded(scene_, &context.embree, count);
    } else {
      part.intersect(scene_, &context.embree, count);
    }
    for (std::size_t i = 0; i < count; ++i) {
      SpeedAnswer answer;
      if (yes_or_no) {
        answer.box = part.isOccluded(i) ? 0 : kNoBox;
      } else if (part.geometry(i) != RTC_INVALID_GEOMETRY_ID) {
        answer = {part.primitive(i) / primitives_a_box_,
                  question == Question::kRounded30 ? static_cast<double>(part.range(i)) : 0.0};
      }
      answers[begin + i] = answer;
    }
  }
}

Peer embreePeer() {
  const auto version = rtcGetDeviceProperty(embreeDevice(), RTC_DEVICE_PROPERTY_VERSION);
  return {"Embree " + std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) +
              "." + std::to_string(version % 100) +
              (hasAssertions() ? ", built with assertions, which cost it time"
                               : ", built without assertions"),
          {{"Embree, boxes", makeEmbreeBoxes}, {"Embree, triangles", makeEmbreeTriangles}}};
}

}  // namespace box_query::benchmark
