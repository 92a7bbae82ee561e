// SPDX-License-Identifier: BSD-3-Clause
#include "ros/checked_request.h"

#include <stdexcept>

namespace box_query {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw std::runtime_error("malformed request: " + what +
                           "; send it as the service's definition lays it out");
}

}  // namespace

void CheckedStream::expectEnd() const {
  if (left() != 0) {
    refuse(std::to_string(left()) + " bytes are left over at its end");
  }
}

void CheckedStream::throwCutShort(std::uint32_t size) const {
  refuse("it ends " + std::to_string(left()) + " bytes into a field of " + std::to_string(size));
}

void CheckedStream::throwTooLong(std::uint32_t length) const {
  const std::string array = "an array of " + std::to_string(length) + " elements";
  if (length > max_array_length_) {
    throw std::runtime_error("too large a request: " + array + ", at most " +
                             std::to_string(max_array_length_) +
                             " are taken; split it, or raise ~max_queries_per_call");
  }
  refuse(array + " is claimed where " + std::to_string(left()) + " bytes are left");
}

}  // namespace box_query
