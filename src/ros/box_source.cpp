// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_source.h"

#include "ros/box_checks.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>

namespace box_query {
namespace {

std::string print(double number) {
  std::ostringstream out;
  out << number;
  return out.str();
}

}  // namespace

const std::array<const char*, kRejections>& rejectionNames() {
  static const std::array<const char*, kRejections> names = {
      "a number that is not finite",
      "a negative size",
      "an orientation that is no unit quaternion",
      "an empty or malformed frame",
      "an unknown action",
      "a shape without three sides",
      "a position or size out of bounds",
      "too many others of its topic"};
  return names;
}

std::size_t BoxChange::rejected() const {
  return rejections
             ? std::accumulate(rejections->counts.begin(), rejections->counts.end(), std::size_t{0})
             : 0;
}

void BoxChange::reject(Rejection why, std::size_t count, const std::string& detail,
                       std::int64_t box_id) {
  if (count == 0) {
    return;
  }
  const auto reason = static_cast<std::size_t>(why);
  Rejected& all = rejections.make();
  if (all.problem.empty()) {
    all.problem = "box " + std::to_string(box_id) + " of namespace '" + ns + "' has " +
                  rejectionNames().at(reason) + " (" + detail + ")";
  }
  all.counts.at(reason) += static_cast<std::uint32_t>(count);
}

void BoxChange::addHostile(std::int64_t box_id, const Vector3& center,
                           const Quaternion& orientation, const Vector3& size) {
  if (!center.allFinite()) {
    reject(Rejection::kNotFinite, 1, "its position", box_id);
  } else if (!orientation.coeffs().allFinite()) {
    reject(Rejection::kNotFinite, 1, "its orientation", box_id);
  } else if (!size.allFinite()) {
    reject(Rejection::kNotFinite, 1, "its size", box_id);
  } else if ((size.array() < 0.0).any()) {
    reject(Rejection::kNegativeSize, 1, print(size.minCoeff()) + " m", box_id);
  } else if (!isNearUnit(orientation)) {
    reject(Rejection::kOrientation, 1, "its norm is " + print(orientation.norm()), box_id);
  } else {
    const bool is_far = isWithin(max_coordinate, size);
    const Vector3& outside = is_far ? center : size;
    reject(Rejection::kOutOfBounds, 1,
           std::string(is_far ? "its position" : "its size") + " is (" + print(outside.x()) + ", " +
               print(outside.y()) + ", " + print(outside.z()) + ") m; " +
               allowedCoordinates(max_coordinate),
           box_id);
  }
}

void BoxChange::addAll(const WireArray& wire_boxes) {
  // All are taken and looked at together: most messages have none that is bad.
  BoxList::Each& each = boxes.each();
  each.resize(wire_boxes.count, boost::container::default_init);
  BoxChecks checks;
  const std::uint8_t* bytes = wire_boxes.elements.bytes();
  std::int64_t n = 0;
  for (IdentifiedBox& made : each) {
    const std::uint8_t* const sides = bytes + WireBox::kSides;
    checks.see(bytes, bytes + WireBox::kOrientation, sides);
    made.id = n++;
    copyNumbers(bytes, made.box.center);
    copyNumbers(bytes + WireBox::kOrientation, made.box.orientation.coeffs());
    double* const half = made.box.half_extents.data();
    storePair(0.5 * loadPair(sides), half);
    storePair(0.5 * loadPair(sides + sizeof(double)), half + 1);
    bytes += WireBox::kSize;
  }
  if (checks.areSurelyGood(max_coordinate)) {
    return;
  }
  each.clear();
  WireBlock block = wire_boxes.elements;
  for (n = 0; n < wire_boxes.count; ++n) {
    const WireBox box = block.box();
    add(n, box.center, box.orientation, box.size);
  }
}

void BoxChange::addPoints(const WireBox& shape, const WireArray& points) {
  BoxChecks checks;
  checks.see(shape.center.data(), shape.orientation.coeffs().data(), shape.size.data());
  Magnitudes places;  // of the bytes: the copy would be waited for
  places.see(points.elements.bytes(), std::size_t{3} * points.count);
  const bool are_good = checks.areSurelyGood(max_coordinate) &&
                        areSurelyWithin(max_coordinate, shape.center, shape.orientation, places);
  boxes.setPoints(id, {shape.center, shape.orientation, 0.5 * shape.size}, points);
  if (are_good) {
    return;
  }
  const BoxList each = std::move(boxes);
  boxes.clear();
  for (const IdentifiedBox& one : each) {
    add(one.id, one.box.center, one.box.orientation, shape.size);
  }
}

const std::vector<BoxSource>& boxSources() {
  static const std::vector<BoxSource> sources = {
      {"visualization_msgs/MarkerArray", "d155b9ce5188fbaf89745847fd5882d7", decodeMarkerArray},
      {"visualization_msgs/Marker", "4048c9de2a16f4ae8e0538085ebf1b97", decodeMarker},
      {"jsk_recognition_msgs/BoundingBoxArray", "c8f4a8bb1acd18ce778d183912bb472d",
       decodeJskBoundingBoxArray},
      {"vision_msgs/BoundingBox3DArray", "9e1a3932308592aa1b20232d818486db",
       decodeVisionBoundingBox3DArray},
      {"vision_msgs/Detection3DArray", "05c51d9aea1fb4cfdc8effb94f197b6f",
       decodeVisionDetection3DArray},
      {"derived_object_msgs/ObjectArray", "492c83cd255b9a57845d0c197d7977be",
       decodeDerivedObjectArray},
      {"autoware_msgs/DetectedObjectArray", "c16aecef51c24c6808480a0295e47806",
       decodeAutowareDetectedObjectArray},
      {"moveit_msgs/CollisionObject", "dbba710596087da521c07564160dfccb", decodeCollisionObject},
      {"moveit_msgs/PlanningScene", "acfc50bcfd6c7b978066bfa7c786002c", decodePlanningScene},
  };
  return sources;
}

const BoxSource* findSource(std::string_view type, std::string_view md5, std::string& problem) {
  const std::vector<BoxSource>& sources = boxSources();
  const auto found = std::find_if(sources.begin(), sources.end(), [&](const BoxSource& source) {
    return source.type == type && source.md5 == md5;
  });
  if (found != sources.end()) {
    return &*found;
  }
  problem = "its type " + std::string(type) + " (md5 " + std::string(md5) + ") is not understood";
  std::string separator = "; publish one of ";
  for (const BoxSource& source : sources) {
    problem += separator + source.type + " (" + source.md5 + ")";
    separator = ", ";
  }
  return nullptr;
}

DecodedMessage decodeMessage(const BoxSource& source, const std::uint8_t* data, std::size_t size,
                             const Limits& limits) {
  WireReader reader(data, size, limits.name_length);
  DecodedMessage message;
  source.decode(reader, limits, message);
  if (!reader.ok()) {
    message.problem = reader.failure();
  } else if (message.problem.empty() && reader.left() > 0) {
    message.problem = std::to_string(reader.left()) + " bytes are left over at its end";
  }
  if (!message.problem.empty()) {
    message.changes.clear();
  }
  return message;
}

std::string tooManyBoxes(std::size_t max_boxes) {
  return "it carries more than " + std::to_string(max_boxes) +
         " boxes; publish fewer or raise max_boxes_per_message";
}

}  // namespace box_query
