// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a message or a request may carry. Beyond it, it is refused with a sentence, so that nobody
/// can make the node work or allocate without end.
#pragma once

#include <box_query/geometry.h>
#include <box_query/ros/parameters.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace box_query {

struct Limits {
  std::size_t boxes;        ///< a message
  std::size_t queries;      ///< rays or segments a request
  std::size_t names;        ///< in each of the filters of a request
  std::size_t name_length;  ///< [bytes] of a namespace, a label, an id, a frame or a topic
  double coordinate;        ///< [m] the largest magnitude of a coordinate, a size or a radius

  explicit Limits(const Parameters& parameters = Parameters());
};

/// [m] The smallest magnitude but 0 that is taken: smaller ones are nobody's measurements, and
/// every question about them would be decided in exact integers, ten thousand times as slowly.
constexpr double kSmallestCoordinate = 1e-200;
/// The same of a component of a direction, beside the longest one.
constexpr double kSmallestSlope = 1e-60;

/// Whether a number is 0 or within these limits; NaN is not.
inline bool isWithin(double max_coordinate, double number) {
  const double magnitude = std::abs(number);
  return magnitude <= max_coordinate && (magnitude >= kSmallestCoordinate || magnitude == 0.0);
}
inline bool isWithin(double max_coordinate, const Vector3& vector) {
  return isWithin(max_coordinate, vector.x()) && isWithin(max_coordinate, vector.y()) &&
         isWithin(max_coordinate, vector.z());
}

/// Whether a direction is finite, not zero, and has no component that is almost 0 beside another.
inline bool isDirection(const Vector3& vector) {
  // Most have no component of 0, and their sum, which is not less than the longest, is enough. One
  // by one: a CPU waits where two that were just written one by one are read at once.
  const double x = std::abs(vector.x());
  const double y = std::abs(vector.y());
  const double z = std::abs(vector.z());
  const double sum = x + y + z;
  const double least = kSmallestSlope * sum;
  if (sum > 0.0 && sum <= std::numeric_limits<double>::max() && x >= least && y >= least &&
      z >= least) {
    return true;
  }
  const auto magnitude = vector.array().abs();
  const double longest = vector.lpNorm<Eigen::Infinity>();
  return vector.allFinite() && longest > 0.0 &&
         (magnitude >= kSmallestSlope * longest || magnitude == 0.0).all();
}

/// Whether a place is where queries can be asked at their usual cost; not if it has a NaN.
inline bool isNear(double max_coordinate, const Vector3& place) {
  return (place.array().abs() <= max_coordinate).all();
}

/// "give 0, or magnitudes from 1e-200 to 1e+07 m, or raise ~max_coordinate"
std::string allowedCoordinates(double max_coordinate);

}  // namespace box_query
