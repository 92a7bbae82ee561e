// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Random input for tests: a seed gives the same numbers with every standard library.
#pragma once

#include <box_query/geometry.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace box_query::reference {

class Sampler {
 public:
  explicit Sampler(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  /// Uniform in {0, ..., count - 1}.
  int index(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  /// Each power of ten in [low, high) is as likely as any other.
  double logUniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }

  Vector3 vector(double low, double high) {
    const double x = uniform(low, high);
    const double y = uniform(low, high);
    const double z = uniform(low, high);
    return {x, y, z};
  }
  /// Any direction, between 0.1 and 1 long.
  Vector3 direction() {
    while (true) {
      Vector3 v = vector(-1.0, 1.0);
      if (v.norm() >= 0.1 && v.norm() <= 1.0) {
        return v;
      }
    }
  }
  /// Any rotation; unit length as far as doubles can.
  Quaternion rotation() {
    while (true) {
      const Vector3 v = vector(-1.0, 1.0);
      const double w = uniform(-1.0, 1.0);
      const Quaternion q(w, v.x(), v.y(), v.z());
      if (q.norm() >= 0.1 && q.norm() <= 1.0) {
        return q.normalized();
      }
    }
  }
  /// `x` moved by up to `ulps` neighbours, up or down.
  double nudged(double x, int ulps) {
    const double to = sign() * std::numeric_limits<double>::infinity();
    for (int n = index(ulps + 1); n > 0; --n) {
      x = std::nextafter(x, to);
    }
    return x;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace box_query::reference
