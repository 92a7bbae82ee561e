// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Embree 3 as its documentation recommends it for static scenes of high quality.
#pragma once

#include "benchmark/speed_peers.h"

#include <embree3/rtcore.h>

namespace box_query::benchmark {

RTCDevice embreeDevice();

/// What comes with a ray to callbacks.
struct EmbreeContext {
  RTCIntersectContext embree;  ///< First: that is what Embree knows.
  bool counts = false;         ///< Boxes, instead of looking for the closest.
  std::size_t count = 0;

  explicit EmbreeContext(bool counting = false) : counts(counting) {
    rtcInitIntersectContext(&embree);
  }
};

/// Rays in a scene of one geometry: one a call, a stream a call, or packets of sixteen.
class Embree : public SpeedMethod {
 public:
  explicit Embree(std::size_t primitives_a_box);
  ~Embree() override;
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  SpeedAnswer ask(Question question, const Ray& ray) const override;
  std::vector<std::string> batchWays(Question question) const override;
  void askEach(Question question, const std::vector<Ray>& rays, std::size_t way,
               std::vector<SpeedAnswer>& answers) const override;

 protected:
  /// Takes the geometry, and builds.
  void commit(RTCGeometry geometry);

  RTCScene scene_;

 private:
  template <typename Rays>
  void askParts(Question question, const std::vector<Ray>& rays,
                std::vector<SpeedAnswer>& answers) const;

  std::size_t primitives_a_box_;
};

std::unique_ptr<SpeedMethod> makeEmbreeBoxes(const std::vector<OrientedBox>& boxes);
std::unique_ptr<SpeedMethod> makeEmbreeTriangles(const std::vector<OrientedBox>& boxes);

}  // namespace box_query::benchmark
