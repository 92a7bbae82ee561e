// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed_embree.h"

namespace box_query::benchmark {
namespace {

class EmbreeTriangles final : public Embree {
 public:
  explicit EmbreeTriangles(const std::vector<OrientedBox>& boxes) : Embree(12) {
    RTCGeometry geometry = rtcNewGeometry(embreeDevice(), RTC_GEOMETRY_TYPE_TRIANGLE);
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
    return question != Question::kClearance && question != Question::kAll30 &&
           question != Question::kWithin;
  }
  std::uint64_t pass(Question question, const std::vector<Ray>& rays) const override {
    return passOf<Embree>(*this, question, rays);
  }
};

}  // namespace

std::unique_ptr<SpeedMethod> makeEmbreeTriangles(const std::vector<OrientedBox>& boxes) {
  return std::make_unique<EmbreeTriangles>(boxes);
}

}  // namespace box_query::benchmark
