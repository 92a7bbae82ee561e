// SPDX-License-Identifier: BSD-3-Clause
// derived_object_msgs/ObjectArray: a whole set. An object's own header counts where it names a
// frame, else the array's. The class is that of the definition's list, unknown where the object is
// not classified; ids are those of the sensor, and need not be unique. Objects of other shapes than
// boxes are ignored and counted; polygons, twists and accelerations do not matter here.
#include "ros/foreign_fields.h"
#include "ros/whole_set.h"

#include <array>
#include <string>

namespace box_query {
namespace {

/// Bytes of an object whose arrays and strings are empty, and of its twist and acceleration.
constexpr std::size_t kObjectSize = 189;
constexpr std::size_t kMotionSize = 2 * 6 * sizeof(double);
constexpr std::size_t kPolygonPointSize = 3 * sizeof(float);

std::string nameOfClass(bool classified, std::uint8_t classification) {
  static const std::array<const char*, 12> names = {
      "UNKNOWN", "UNKNOWN_SMALL", "UNKNOWN_MEDIUM", "UNKNOWN_BIG",   "PEDESTRIAN", "BIKE",
      "CAR",     "TRUCK",         "MOTORCYCLE",     "OTHER_VEHICLE", "BARRIER",    "SIGN"};
  if (!classified) {
    return names[0];
  }
  return classification < names.size() ? names.at(classification) : std::to_string(classification);
}

void readObject(WireReader& reader, const WireHeader& array, WholeSet& set,
                DecodedMessage& message) {
  const WireHeader own = reader.header();
  const WireHeader& header = own.frame.empty() ? array : own;
  const std::int64_t id = reader.number<std::uint32_t>();
  reader.skip(1);  // detection_level
  const bool classified = reader.number<std::uint8_t>() != 0;
  const Vector3 position = reader.vector();
  const Quaternion orientation = reader.quaternion();
  reader.skip(kMotionSize);
  skipArray(reader, kPolygonPointSize);
  const SolidPrimitive solid = readSolidPrimitive(reader);
  const std::string class_name = nameOfClass(classified, reader.number<std::uint8_t>());
  reader.skip(1 + sizeof(std::uint32_t));  // classification_certainty, classification_age
  if (solid.type != SolidPrimitive::kBox) {
    ++message.ignored;
  } else if (solid.dimensions != 3) {
    set.reject(header, class_name, id, Rejection::kShape,
               "it has " + std::to_string(solid.dimensions));
  } else {
    set.add(header, class_name, id, position, orientation, solid.sides);
  }
}

}  // namespace

void decodeDerivedObjectArray(WireReader& reader, const Limits& limits, DecodedMessage& message) {
  const WireHeader array = reader.header();
  const auto read = [&](WholeSet& set, std::uint32_t /*n*/) {
    readObject(reader, array, set, message);
  };
  WholeSet::decode(reader, kObjectSize, limits, array.stamp, message, read);
}

}  // namespace box_query
