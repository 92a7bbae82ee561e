// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Random numbers that are the same bits with every compiler, library and CPU: integers, IEEE
/// sums, products, quotients and square roots in a fixed order, nothing else. (The order includes
/// that of calls: no two in one list of arguments or operands, which C++ does not order.)
#pragma once

#include <box_query/geometry.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace box_query::stress {

/// The numbers of a vector or of a quaternion's coefficients, for loops: Eigen 3.3, which
/// Ubuntu 20.04 has, gives them no begin and end.
template <typename Number>
struct Numbers {
  Number* first;
  Number* last;
  Number* begin() const { return first; }
  Number* end() const { return last; }
};
template <typename Matrix>
auto numbersOf(Matrix& matrix) -> Numbers<std::remove_pointer_t<decltype(matrix.data())>> {
  return {matrix.data(), matrix.data() + matrix.size()};
}

/// A stream that its key determines: any sample of any family can be made on its own.
/// SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t family, std::uint64_t index)
      : state_(mix(mix(mix(seed) ^ family) ^ index)) {}

  std::uint64_t bits() { return mix(state_ += 0x9e3779b97f4a7c15U); }
  /// Uniform in {0, ..., n - 1}.
  int below(int n) { return static_cast<int>((bits() >> 33U) % static_cast<std::uint64_t>(n)); }
  int between(int first, int last) { return first + below(last - first + 1); }
  bool chance(double probability) { return uniform() < probability; }
  double sign() { return below(2) == 0 ? 1.0 : -1.0; }

  /// Uniform in [0, 1) and in [low, high).
  double uniform() { return std::ldexp(static_cast<double>(bits() >> 11U), -53); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Positive, with an exponent of two uniform in {first, ..., last}.
  double magnitude(int first, int last) {
    const double mantissa = 1.0 + uniform();
    return std::ldexp(mantissa, between(first, last));
  }
  double signedMagnitude(int first, int last) {
    const double side = sign();
    return side * magnitude(first, last);
  }
  /// A multiple of 1/2 in [-limit, limit].
  double half(int limit) { return 0.5 * static_cast<double>(between(-2 * limit, 2 * limit)); }

  /// x or one of its neighbours, up to `ulps` away.
  double nudged(double x, int ulps) {
    const int steps = between(-ulps, ulps);
    for (int i = 0; i != steps; i += steps > 0 ? 1 : -1) {
      const double next = std::nextafter(x, steps > 0 ? std::numeric_limits<double>::infinity()
                                                      : -std::numeric_limits<double>::infinity());
      x = std::isfinite(next) ? next : x;
    }
    return x;
  }
  Vector3 nudged(const Vector3& v, int ulps) {
    const double x = nudged(v[0], ulps);
    const double y = nudged(v[1], ulps);
    return {x, y, nudged(v[2], ulps)};
  }

  Vector3 uniformVector(double low, double high) {
    const double x = uniform(low, high);
    const double y = uniform(low, high);
    return {x, y, uniform(low, high)};
  }
  Vector3 halves(int limit) {
    const double x = half(limit);
    const double y = half(limit);
    return {x, y, half(limit)};
  }
  /// Three different axes in random order.
  std::array<int, 3> axes() {
    const int first = below(3);
    const int step = between(1, 2);
    return {first, (first + step) % 3, (first + 2 * step) % 3};
  }
  /// Unit length as far as doubles can.
  Quaternion rotation() {
    for (;;) {
      const double w = uniform(-1.0, 1.0);
      const Vector3 u = uniformVector(-1.0, 1.0);
      const double squared = ((w * w + u[0] * u[0]) + u[1] * u[1]) + u[2] * u[2];
      if (squared > 0.01 && squared < 1.0) {
        const double length = std::sqrt(squared);
        return {w / length, u[0] / length, u[1] / length, u[2] / length};
      }
    }
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }

  std::uint64_t state_;
};

}  // namespace box_query::stress
