// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed_peers.h"

namespace box_query::benchmark {
namespace {

[[maybe_unused]] Peer missing(const std::string& name, const std::string& package) {
  return {name + " was not found: on Debian and Ubuntu it is in the package " + package, {}};
}

}  // namespace

const std::vector<Peer>& peers() {
  static const std::vector<Peer> all = {
#ifdef BQ_EMBREE
      embreePeer(),
#else
      missing("Embree", "libembree-dev"),
#endif
#ifdef BQ_BULLET
      bulletPeer(),
#else
      missing("Bullet", "libbullet-dev"),
#endif
#ifdef BQ_FCL
      fclPeer(),
#else
      missing("FCL", "libfcl-dev"),
#endif
#ifdef BQ_ODE
      odePeer(),
#else
      missing("ODE", "libode-dev"),
#endif
  };
  return all;
}

}  // namespace box_query::benchmark
