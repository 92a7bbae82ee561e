// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Checks of many boxes at once.
#pragma once

#include "ros/box_source.h"
#include "ros/magnitudes.h"
#include "ros/number_pairs.h"

#include <cstdint>

namespace box_query {

/// Whether all boxes that it has seen are good, as BoxChange::add() says of one: without a branch
/// for each, since most messages have none that is bad.
class BoxChecks {
 public:
  /// The bytes of a center, a quaternion and full sides [m], best where they have been for a while:
  /// those that were just written would be waited for.
  void see(const void* center, const void* orientation, const void* size) {
    const auto* const sides = static_cast<const std::uint8_t*>(size);
    const auto* const quaternion = static_cast<const std::uint8_t*>(orientation);
    lengths_.seeThree(center);
    lengths_.seeThree(size);
    signs_ |= bitsOf(sides) | bitsOf(sides + sizeof(double));
    const NumberPair xy = loadPair(quaternion);
    const NumberPair zw = loadPair(quaternion + 2 * sizeof(double));
    const NumberPair sums = xy * xy + zw * zw;
    const NumberPair norm = sums + NumberPair{sums[1], sums[0]};
    norm_errors_.seeTwo(norm - 1.0);
  }
  /// False also where it would take a look at each.
  bool areSurelyGood(double max_coordinate) const {
    return lengths_.largest() <= max_coordinate && lengths_.smallest() >= kSmallestCoordinate &&
           ((signs_[0] | signs_[1]) >> 63U) == 0 && norm_errors_.largest() <= kSureNormError;
  }

 private:
  /// Of a squared norm: within this, whatever the order of the sum, isNearUnit() is true.
  static constexpr double kSureNormError = 1.99 * kNormTolerance;

  static BitsPair bitsOf(const void* numbers) {
    return reinterpret_cast<BitsPair>(loadPair(numbers));
  }

  Magnitudes lengths_;
  BitsPair signs_{};  ///< of sides: that of -0 would take a look
  Magnitudes norm_errors_;
};

}  // namespace box_query
