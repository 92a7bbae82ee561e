// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A quick look at many numbers at once.
#pragma once

#include "ros/number_pairs.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace box_query {

/// Bounds of the magnitudes of all numbers that it has seen, without a branch and in a quarter of
/// the time that comparisons take. The bits of doubles without their signs are in the order of the
/// doubles, infinity and NaN behind the others. The first 16 of them, an exponent and four digits,
/// are enough: the larger and the smaller of eight such pairs are an instruction each. The rest of
/// a double goes along in it and is not looked at.
class Magnitudes {
 public:
  /// The bytes of three numbers, wherever they are.
  void seeThree(const void* numbers) {
    const auto* const bytes = static_cast<const std::uint8_t*>(numbers);
    seeTwo(loadPair(bytes));
    seeTwo(loadPair(bytes + sizeof(double)));
  }
  void seeTwo(NumberPair numbers) { seeBits(reinterpret_cast<BitsPair>(numbers)); }

  /// The bytes of so many, wherever they are.
  void see(const void* numbers, std::size_t count) {
    const auto* const bytes = static_cast<const std::uint8_t*>(numbers);
    Magnitudes others;  // side by side: no instruction waits for the one before
    std::size_t n = 0;
    for (; n + 4 <= count; n += 4) {
      seeTwo(loadPair(bytes + n * sizeof(double)));
      others.seeTwo(loadPair(bytes + (n + 2) * sizeof(double)));
    }
    for (; n < count; ++n) {
      double number = 0.0;
      std::memcpy(&number, bytes + n * sizeof(double), sizeof(number));
      seeTwo(NumberPair{number, number});
    }
    largest_ = others.largest_ > largest_ ? others.largest_ : largest_;
    least_ = others.least_ < least_ ? others.least_ : least_;
  }

  /// Not less than any magnitude, up to 1/16 more than the largest. NaN, which no limit is above,
  /// if one is infinite or NaN.
  double largest() const {
    const Words words = largest_;  // by value: min() and max() would keep a member in memory
    const std::int16_t first = words[3] > words[7] ? words[3] : words[7];
    return fromFirst((first < kInfinity ? first : kInfinity) + 1);
  }
  /// Not more than any magnitude but 0, up to 1/16 less than the smallest. Infinite if there is
  /// none.
  double smallest() const {
    const Words words = least_;
    const std::int16_t first = words[3] < words[7] ? words[3] : words[7];
    return first == kNone ? std::numeric_limits<double>::infinity()
                          : fromFirst(first - std::numeric_limits<std::int16_t>::min());
  }

 private:
  using Words [[gnu::vector_size(16)]] = std::int16_t;

  static constexpr std::uint64_t kButSign = std::numeric_limits<std::int64_t>::max();
  static constexpr std::int16_t kInfinity = 0x7ff0;
  static constexpr std::int16_t kNone = std::numeric_limits<std::int16_t>::max();

  static double fromFirst(int first) {
    const auto bits = static_cast<std::uint64_t>(first) << 48U;
    double number = 0.0;
    std::memcpy(&number, &bits, sizeof(number));
    return number;
  }

  void seeBits(BitsPair bits) {
    bits &= kButSign;
    const auto first = reinterpret_cast<Words>(bits);
    largest_ = first > largest_ ? first : largest_;
    // As many behind the most negative as the magnitude is behind 0, less one: 0 is the last.
    const auto behind = reinterpret_cast<Words>(bits + kButSign);
    least_ = behind < least_ ? behind : least_;
  }

  Words largest_{};
  Words least_ = Words{} + kNone;
};

}  // namespace box_query
