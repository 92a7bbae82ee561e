// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A cheap and certain lower bound of the distance from a segment to a box: what most boxes of a
/// scene need no more than.
#pragma once

#include <box_query/geometry.h>

#include <cstddef>
#include <vector>

namespace box_query {

/// A sphere around every box, as arrays of coordinates.
struct BoundingSpheres {
  BoundingSpheres() = default;
  explicit BoundingSpheres(const std::vector<Box>& boxes);

  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> z;
  std::vector<double> radius;
  /// max |center|_1
  double farthest = 0.0;
};

/// Asks the spheres about one segment.
///
/// The point of the segment nearest to a center is a clamped projection. With M the largest |.|_1
/// of the ends and the centers, and u = 2^-53, rounding moves it by at most 44u M along the
/// segment, and costs 24u M more in its distance.
class SphereFilter {
 public:
  SphereFilter(const Segment& segment, const BoundingSpheres& spheres);

  /// Whether the box is certainly farther than `distance` from the segment up to parameter `end`;
  /// never true where a number is too large to tell.
  bool isBeyond(std::size_t box, double distance, double end = 1.0) const {
    const double px = start_[0] - spheres_.x[box];
    const double py = start_[1] - spheres_.y[box];
    const double pz = start_[2] - spheres_.z[box];
    double t = -(px * direction_[0] + py * direction_[1] + pz * direction_[2]) * inverse_;
    t = t < end ? t : end;
    t = t > 0.0 ? t : 0.0;
    const double qx = px + t * direction_[0];
    const double qy = py + t * direction_[1];
    const double qz = pz + t * direction_[2];
    const double reach = distance + (spheres_.radius[box] + slack_);
    return qx * qx + qy * qy + qz * qz > reach * reach;
  }

 private:
  const BoundingSpheres& spheres_;
  double start_[3];
  double direction_[3];
  double inverse_;  ///< of |direction|^2
  double slack_;
};

}  // namespace box_query
