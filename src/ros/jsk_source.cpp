// SPDX-License-Identifier: BSD-3-Clause
// jsk_recognition_msgs/BoundingBoxArray, with the meaning that jsk's own display gives it: a whole
// set. Every box has a header of its own, and only that one counts; the array's is often empty or
// another. `label` is the number of a class and no identity: boxes are numbered in their order.
// `value`, a likelihood, is not kept.
#include "ros/whole_set.h"

#include <charconv>

namespace box_query {
namespace {

/// Bytes of a box whose frame is empty.
constexpr std::size_t kBoxSize = 104;

/// A number as text, which is mostly the same as before.
class NumberText {
 public:
  std::string_view of(std::uint32_t number) {
    if (size_ == 0 || number != number_) {
      number_ = number;
      size_ =
          static_cast<std::size_t>(std::to_chars(text_, text_ + sizeof(text_), number).ptr - text_);
    }
    return {text_, size_};
  }

 private:
  char text_[10];  // the digits of 2^32 - 1
  std::uint32_t number_ = 0;
  std::size_t size_ = 0;
};

}  // namespace

void decodeJskBoundingBoxArray(WireReader& reader, const Limits& limits, DecodedMessage& message) {
  const WireHeader array = reader.header();
  NumberText label;
  const auto read = [&](WholeSet& set, std::uint32_t n) {
    const WireHeader header = reader.header();
    const WireBox box = reader.box();
    reader.number<float>();  // value
    const auto number = reader.number<std::uint32_t>();
    set.add(header, label.of(number), n, box.center, box.orientation, box.size);
  };
  WholeSet::decode(reader, kBoxSize, limits, array.stamp, message, read);
}

}  // namespace box_query
