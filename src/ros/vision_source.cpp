// SPDX-License-Identifier: BSD-3-Clause
// vision_msgs/BoundingBox3DArray and Detection3DArray (0.0.2, ROS 1): whole sets, of boxes in their
// order. The boxes of the former have no class. A detection's own header counts where it names a
// frame; where it does not, as is common, the array's, which is the one that displays use. Its
// class is the hypothesis with the highest score, by the number that the vision database of the
// detector has for it; the poses of hypotheses are not those of the box.
#include "ros/foreign_fields.h"
#include "ros/whole_set.h"

#include <limits>
#include <string>

namespace box_query {
namespace {

/// Bytes of a detection whose arrays and strings are empty, of a hypothesis.
constexpr std::size_t kDetectionSize = 142;
constexpr std::size_t kHypothesisSize = 360;

/// The class of the likeliest hypothesis, of equally likely ones the first; empty if there is none.
/// A score that is not a number is below all others.
std::string readClass(WireReader& reader) {
  const std::uint32_t hypotheses = reader.count(kHypothesisSize);
  std::int64_t likeliest = 0;
  double best = -std::numeric_limits<double>::infinity();
  for (std::uint32_t n = 0; n < hypotheses; ++n) {
    const auto id = reader.number<std::int64_t>();
    const auto score = reader.number<double>();
    reader.skip(kHypothesisSize - sizeof(id) - sizeof(score));  // pose with covariance
    if (n == 0 || score > best) {
      likeliest = id;
    }
    best = score > best ? score : best;
  }
  return hypotheses > 0 ? std::to_string(likeliest) : "";
}

}  // namespace

void decodeVisionBoundingBox3DArray(WireReader& reader, const Limits& limits,
                                    DecodedMessage& message) {
  const WireHeader header = reader.header();
  const WireArray boxes = reader.array(WireBox::kSize);
  WholeSet set(boxes.count, limits, header.stamp, message);
  if (boxes.count == 0 || !message.problem.empty()) {
    return;
  }
  BoxChange& change = set.changeOf(header, "");  // of all boxes
  if (isBadFrame(change.frame)) {
    change.reject(Rejection::kFrame, boxes.count, "'" + std::string(header.frame) + "'", 0);
    return;
  }
  change.addAll(boxes);
}

void decodeVisionDetection3DArray(WireReader& reader, const Limits& limits,
                                  DecodedMessage& message) {
  const WireHeader array = reader.header();
  const auto read = [&](WholeSet& set, std::uint32_t n) {
    const WireHeader own = reader.header();
    const std::string class_name = readClass(reader);
    const WireBox box = reader.box();
    skipPointCloud2(reader);
    set.add(own.frame.empty() ? array : own, class_name, n, box.center, box.orientation, box.size);
  };
  WholeSet::decode(reader, kDetectionSize, limits, array.stamp, message, read);
}

}  // namespace box_query
