// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed.h"

namespace box_query::benchmark {

std::unique_ptr<SpeedMethod> makeEmbreeBoxes(const std::vector<OrientedBox>& /*boxes*/) {
  return nullptr;
}
std::unique_ptr<SpeedMethod> makeEmbreeTriangles(const std::vector<OrientedBox>& /*boxes*/) {
  return nullptr;
}
std::vector<std::string> peerNotes() {
  return {"Embree was not found: on Debian and Ubuntu it is in the package libembree-dev"};
}

}  // namespace box_query::benchmark
