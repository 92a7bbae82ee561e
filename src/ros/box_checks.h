// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Checks of many boxes at once.
#pragma once

#include "ros/box_source.h"
#include "ros/magnitudes.h"

#include <algorithm>
#include <cmath>

namespace box_query {

/// Whether all boxes that it has seen are good, as BoxChange::add() says of one: without a branch
/// for each, since most messages have none that is bad.
class BoxChecks {
 public:
  /// The bytes of three numbers each, best where they have been for a while: those that were just
  /// written would be waited for. `size`: full sides [m], the same as those bytes.
  void see(const void* center_bytes, const Quaternion& orientation, const void* size_bytes,
           const Vector3& size) {
    lengths_.seeThree(center_bytes);
    lengths_.seeThree(size_bytes);
    least_ = std::min({least_, size.x(), size.y(), size.z()});
    const double norm = orientation.squaredNorm();
    shortest_ = std::min(shortest_, norm);
    longest_ = std::max(longest_, norm);
    sum_ += norm;
  }
  /// False also where it would take a look at each.
  bool areSurelyGood(double max_coordinate) const {
    return lengths_.largest() <= max_coordinate && lengths_.smallest() >= kSmallestCoordinate &&
           least_ >= 0.0 && isNearUnit(shortest_) && isNearUnit(longest_) && std::isfinite(sum_);
  }

 private:
  Magnitudes lengths_;
  double least_ = 0.0;
  double shortest_ = 1.0;
  double longest_ = 1.0;
  double sum_ = 0.0;  // of the norms: min and max pass over NaN
};

}  // namespace box_query
