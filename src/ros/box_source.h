// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a message type of boxes is to the monitor: a name, a checksum and a decoder.
#pragma once

#include "ros/box_list.h"
#include "ros/frame_name.h"
#include "ros/limits.h"
#include "ros/rare.h"
#include "ros/wire_reader.h"

#include <box_query/geometry.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <boost/container/small_vector.hpp>
#include <ros/time.h>

namespace box_query {

/// Why a box is rejected.
enum class Rejection {
  kNotFinite,
  kNegativeSize,
  kOrientation,
  kFrame,
  kAction,
  kShape,
  kOutOfBounds,
  kTooMany
};
constexpr std::size_t kRejections = 8;
/// A few words each, in the order of the enumeration.
const std::array<const char*, kRejections>& rejectionNames();

/// How far the norm of a quaternion may be from 1. Less is taken as it stands.
constexpr double kNormTolerance = 1e-2;

inline bool isNearUnit(double squared_norm) {
  return squared_norm >= (1.0 - kNormTolerance) * (1.0 - kNormTolerance) &&
         squared_norm <= (1.0 + kNormTolerance) * (1.0 + kNormTolerance);
}
inline bool isNearUnit(const Quaternion& q) {
  return isNearUnit(q.squaredNorm());
}

/// Boxes that were not accepted.
struct Rejected {
  std::array<std::uint32_t, kRejections> counts{};
  std::string problem;  ///< what was wrong with the first of them
};

struct RigidObject;

/// A change of what a topic says under one (ns, id): one marker, say.
struct BoxChange {
  enum class Kind {
    kSet,     ///< from now on these boxes, and no others
    kAppend,  ///< these boxes beside those under its ns: `id` is set, and is added to theirs times
              ///< 2^32, when it is heard
    kMove,  ///< what is under its ns, elsewhere: `boxes` are its pose and, if there are more, those
            ///< of its shapes within it
    kRemove,  ///< nothing
    kClear,   ///< nothing under any (ns, id) of the topic
  };

  // Not an aggregate: value-initialisation would fill the whole of it with zeros first.
  explicit BoxChange(double largest = std::numeric_limits<double>::max(),
                     std::string_view its_ns = {}, std::string_view its_frame = {})
      : max_coordinate(largest), ns(its_ns), frame(its_frame) {}

  double max_coordinate;  ///< [m] of its boxes: Limits::coordinate
  Kind kind = Kind::kSet;
  bool whole_namespace = false;  ///< kSet, kRemove: and nothing under another id of its ns
  bool frame_locked = false;     ///< the boxes move with their frame after `stamp`
  std::string ns;
  std::int64_t id = 0;
  std::string label;
  FrameName frame;            ///< of the boxes, without a leading slash
  ros::Time stamp;            ///< 0: none
  std::int64_t lifetime = 0;  ///< [ns] of ROS time from receipt; 0: forever
  BoxList boxes;
  std::shared_ptr<const RigidObject> object;  ///< kSet, kAppend: not null if it can be moved
  Rare<Rejected> rejections;

  std::size_t rejected() const;
  std::string problem() const { return rejections ? rejections->problem : std::string(); }
  /// Counts `boxes` bad ones, the first of which is `box_id`.
  void reject(Rejection why, std::size_t count, const std::string& detail, std::int64_t box_id);
  /// The only door for boxes: checks one, halves its `size` (full sides [m]) and appends it, or
  /// rejects it. A half is exact.
  void add(std::int64_t box_id, const Vector3& center, const Quaternion& orientation,
           const Vector3& size);
  /// The same for an array of WireBox, in less time; their ids are their places. Call it first.
  void addAll(const WireArray& wire_boxes);
  /// The same for a box at each of an array of points, which are in the frame of `shape`: see
  /// BoxList::setPoints(). Call it first.
  void addPoints(const WireBox& shape, const WireArray& points);

 private:
  bool isGood(const Vector3& center, const Quaternion& orientation, const Vector3& size) const;
  /// The same for a box that is bad.
  void addHostile(std::int64_t box_id, const Vector3& center, const Quaternion& orientation,
                  const Vector3& size);
};

/// Many messages are one change.
using BoxChanges = boost::container::small_vector<BoxChange, 1>;

/// What a message says.
struct DecodedMessage {
  BoxChanges changes;
  /// These boxes are all that the topic has: what it said before is gone.
  bool whole = false;
  ros::Time stamp;          ///< of a message without changes; 0: none
  std::size_t ignored = 0;  ///< markers and objects that are no boxes
  std::string problem;      ///< not empty: the message is refused, and its changes mean nothing
};

inline bool BoxChange::isGood(const Vector3& center, const Quaternion& orientation,
                              const Vector3& size) const {
  return isWithin(max_coordinate, center) && isWithin(max_coordinate, size) && size.x() >= 0.0 &&
         size.y() >= 0.0 && size.z() >= 0.0 && isNearUnit(orientation);
}

inline void BoxChange::add(std::int64_t box_id, const Vector3& center,
                           const Quaternion& orientation, const Vector3& size) {
  if (isGood(center, orientation, size)) {
    boxes.each().emplace_back(box_id, center, orientation, 0.5 * size);
  } else {
    addHostile(box_id, center, orientation, size);
  }
}

struct BoxSource {
  const char* type;
  const char* md5;
  /// Appends to `message` what the bytes say; more than `limits.boxes` boxes are a problem. A
  /// failure of the reader is handled by the caller, as are bytes that are left over.
  void (*decode)(WireReader& reader, const Limits& limits, DecodedMessage& message);
};

/// Every message type that is understood. A new one is a file of its own and its line here.
const std::vector<BoxSource>& boxSources();

/// The source of that type and checksum, or null and a sentence that names the known ones.
const BoxSource* findSource(std::string_view type, std::string_view md5, std::string& problem);

/// Decodes a whole message; never throws at bad bytes.
DecodedMessage decodeMessage(const BoxSource& source, const std::uint8_t* data, std::size_t size,
                             const Limits& limits);

/// The problem of a message with too many boxes.
std::string tooManyBoxes(std::size_t max_boxes);

// The decoders, each in its own file.
void decodeMarker(WireReader& reader, const Limits& limits, DecodedMessage& message);
void decodeMarkerArray(WireReader& reader, const Limits& limits, DecodedMessage& message);
void decodeAutowareDetectedObjectArray(WireReader& reader, const Limits& limits,
                                       DecodedMessage& message);
void decodeCollisionObject(WireReader& reader, const Limits& limits, DecodedMessage& message);
void decodeDerivedObjectArray(WireReader& reader, const Limits& limits, DecodedMessage& message);
void decodePlanningScene(WireReader& reader, const Limits& limits, DecodedMessage& message);
void decodeJskBoundingBoxArray(WireReader& reader, const Limits& limits, DecodedMessage& message);
void decodeVisionBoundingBox3DArray(WireReader& reader, const Limits& limits,
                                    DecodedMessage& message);
void decodeVisionDetection3DArray(WireReader& reader, const Limits& limits,
                                  DecodedMessage& message);

}  // namespace box_query
