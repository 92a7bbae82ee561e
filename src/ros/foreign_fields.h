// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Fields that boxes come with in several packages, and that say nothing of the boxes.
#pragma once

#include "ros/wire_reader.h"

#include <cstdint>

namespace box_query {

/// Skips an array whose elements have `element_size` bytes each.
inline void skipArray(WireReader& reader, std::size_t element_size) {
  reader.skip(std::uint64_t{reader.count(element_size)} * element_size);
}

/// shape_msgs/SolidPrimitive. All of its dimensions are read or skipped; those of a box are three.
struct SolidPrimitive {
  static constexpr std::uint8_t kBox = 1;
  static constexpr std::size_t kSmallest = 5;  ///< bytes, without dimensions

  std::uint8_t type;
  std::uint32_t dimensions;
  Vector3 sides;  ///< full ones [m], of a box that has three
};

inline SolidPrimitive readSolidPrimitive(WireReader& reader) {
  // Not of the struct: two members that were just written would be read as one, and waited for.
  const auto type = reader.number<std::uint8_t>();
  const std::uint32_t dimensions = reader.count(sizeof(double));
  if (type == SolidPrimitive::kBox && dimensions == 3) {
    return {type, dimensions, reader.vector()};
  }
  reader.skip(std::uint64_t{dimensions} * sizeof(double));
  return {type, dimensions, Vector3::Zero()};
}

/// sensor_msgs/PointCloud2
inline void skipPointCloud2(WireReader& reader) {
  constexpr std::size_t kSmallestField = 13;
  reader.header();
  reader.skip(2 * sizeof(std::uint32_t));  // height, width
  const std::uint32_t fields = reader.count(kSmallestField);
  for (std::uint32_t n = 0; n < fields && reader.ok(); ++n) {
    reader.string();
    reader.skip(kSmallestField - sizeof(std::uint32_t));  // offset, datatype, count
  }
  reader.skip(1 + 2 * sizeof(std::uint32_t));  // is_bigendian, point_step, row_step
  skipArray(reader, 1);                        // data
  reader.skip(1);                              // is_dense
}

}  // namespace box_query
