// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What tests of the decoders share: messages serialised by roscpp, and damage that every decoder
/// has to survive.
#pragma once

#include "ros/box_source.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <ros/serialization.h>

namespace box_query::test {

constexpr std::size_t kPlenty = 1000000;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

using Bytes = std::vector<std::uint8_t>;

/// What roscpp sends.
template <typename Message>
Bytes wire(const Message& message) {
  namespace ser = ros::serialization;
  Bytes bytes(ser::serializationLength(message));
  ser::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ser::serialize(stream, message);
  return bytes;
}

/// The only source of that type.
inline const BoxSource& sourceNamed(std::string_view type) {
  for (const BoxSource& source : boxSources()) {
    if (source.type == type) {
      return source;
    }
  }
  throw std::invalid_argument("no source of type " + std::string(type));
}

inline DecodedMessage decodeBytes(std::string_view type, const Bytes& bytes,
                                  std::size_t max_boxes = kPlenty) {
  // A copy that ends where the message ends, so that a sanitizer sees what reads beyond.
  const Bytes exact(bytes.begin(), bytes.end());
  Limits limits;
  limits.boxes = max_boxes;
  return decodeMessage(sourceNamed(type), exact.data(), exact.size(), limits);
}

inline std::size_t countOf(const BoxChange& change, Rejection why) {
  return change.rejections ? change.rejections->counts.at(static_cast<std::size_t>(why)) : 0;
}

/// "ns/id:x" of every box, in the order of the changes.
inline std::string contents(const DecodedMessage& message) {
  std::string text;
  for (const BoxChange& change : message.changes) {
    for (const IdentifiedBox& each : change.boxes) {
      text += change.ns + "/" + std::to_string(each.id) + ":" +
              std::to_string(std::lround(each.box.center.x())) + " ";
    }
  }
  return text;
}

/// The message must be refused where it is cut off anywhere or is a byte too long.
inline void expectRefusedIfCutOffOrTooLong(std::string_view type, const Bytes& whole) {
  ASSERT_EQ(decodeBytes(type, whole).problem, "");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    const DecodedMessage message = decodeBytes(type, cut);
    ASSERT_NE(message.problem, "") << size;
    ASSERT_TRUE(message.changes.empty()) << size;
  }
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_NE(decodeBytes(type, longer).problem, "");
}

/// Whatever four bytes claim 4e9 elements, characters or nanoseconds: the message has `lengths` of
/// these, the claims of which must be refused.
inline void expectClaimsRefused(std::string_view type, const Bytes& whole, std::size_t lengths) {
  std::size_t refused = 0;
  for (std::size_t at = 0; at + 4 <= whole.size(); ++at) {
    Bytes bytes = whole;
    const std::uint32_t huge = 4000000000U;
    std::memcpy(&bytes[at], &huge, sizeof huge);
    refused += decodeBytes(type, bytes).problem.empty() ? 0U : 1U;
  }
  EXPECT_GE(refused, lengths);
}

/// Random bytes in the message never give an invalid box, nor anything worse.
inline void expectSurvivesAnyBytes(std::string_view type, const Bytes& whole) {
  std::mt19937 random(20180301);
  std::size_t accepted = 0;
  constexpr std::size_t kRounds = 10000;
  for (std::size_t round = 0; round < kRounds; ++round) {
    Bytes bytes = whole;
    for (unsigned flips = random() % 4 + 1; flips > 0; --flips) {
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    }
    const DecodedMessage message = decodeBytes(type, bytes);
    accepted += message.problem.empty() ? 1U : 0U;
    for (const BoxChange& change : message.changes) {
      for (const IdentifiedBox& each : change.boxes) {
        ASSERT_TRUE(isValid(each.box));
      }
    }
  }
  EXPECT_GT(accepted, kRounds / 50);
  EXPECT_LT(accepted, kRounds);
}

}  // namespace box_query::test
