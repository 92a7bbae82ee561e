// SPDX-License-Identifier: BSD-3-Clause
#include "ros/wire_reader.h"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/serialization.h>

namespace box_query {
namespace {

/// The bytes that roscpp writes for the values, one after the other, in a buffer of just that size.
template <typename... Values>
std::vector<std::uint8_t> wire(const Values&... values) {
  namespace ser = ros::serialization;
  std::vector<std::uint8_t> bytes((ser::serializationLength(values) + ... + 0U));
  ser::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  (ser::serialize(stream, values), ...);
  return bytes;
}

TEST(WireReader, ReadsWhatRoscppWrites) {
  const auto bytes =
      wire(std::uint8_t{200}, std::int32_t{-5}, 1.5, std::string("name"), ros::Time(7, 999999999),
           ros::Duration(-1, 5), 1.0, 2.0, 3.0, 0.1, 0.2, 0.3, 0.4, std::uint32_t{9},
           ros::Time(3, 4), std::string("map"), 1.0, 2.0, 3.0, 0.1, 0.2, 0.3, 0.4, 5.0, 6.0, 7.0);
  WireReader reader(bytes.data(), bytes.size());
  EXPECT_EQ(reader.number<std::uint8_t>(), 200);
  EXPECT_EQ(reader.number<std::int32_t>(), -5);
  EXPECT_EQ(reader.number<double>(), 1.5);
  EXPECT_EQ(reader.string(), "name");
  EXPECT_EQ(reader.time(), ros::Time(7, 999999999));
  EXPECT_EQ(reader.duration(), -999999995);
  EXPECT_EQ(reader.vector(), Vector3(1.0, 2.0, 3.0));
  EXPECT_EQ(reader.quaternion().coeffs(), Eigen::Vector4d(0.1, 0.2, 0.3, 0.4));
  const WireHeader header = reader.header();
  EXPECT_EQ(header.stamp, ros::Time(3, 4));
  EXPECT_EQ(header.frame, "map");
  WireReader ahead = reader;
  WireBlock block = ahead.block<80>();
  EXPECT_EQ(block.box().size, Vector3(5.0, 6.0, 7.0));
  EXPECT_EQ(ahead.left(), 0U);
  ahead = reader;
  block = ahead.block<81>();
  EXPECT_FALSE(ahead.ok());
  EXPECT_EQ(block.box().orientation.coeffs(), Eigen::Vector4d::Zero()) << "as all that is missing";
  const WireBox box = reader.box();
  EXPECT_EQ(box.center, Vector3(1.0, 2.0, 3.0));
  EXPECT_EQ(box.orientation.coeffs(), Eigen::Vector4d(0.1, 0.2, 0.3, 0.4));
  EXPECT_EQ(box.size, Vector3(5.0, 6.0, 7.0));
  EXPECT_TRUE(reader.ok()) << reader.failure();
  EXPECT_EQ(reader.left(), 0U);
}

TEST(WireReader, ReadsNothingBeyondTheEnd) {
  const auto bytes = wire(std::uint32_t{1}, std::uint8_t{2});
  WireReader reader(bytes.data(), bytes.size());
  EXPECT_EQ(reader.number<std::uint32_t>(), 1U);
  EXPECT_EQ(reader.number<std::uint16_t>(), 0);
  EXPECT_FALSE(reader.ok());
  EXPECT_NE(reader.failure().find("at byte 4, where 1 bytes remain"), std::string::npos)
      << reader.failure();
}

TEST(WireReader, ReadsZerosOnceSomethingDidNotFit) {
  const auto bytes = wire(std::uint32_t{100}, std::uint64_t{~0ULL});
  WireReader reader(bytes.data(), bytes.size());
  EXPECT_EQ(reader.string(), "");
  const std::string failure = reader.failure();
  EXPECT_FALSE(failure.empty());
  EXPECT_EQ(reader.number<std::uint64_t>(), 0U);
  EXPECT_EQ(reader.count(1), 0U);
  EXPECT_EQ(reader.left(), 0U);
  EXPECT_EQ(reader.failure(), failure) << "the first failure is the one that explains";
}

TEST(WireReader, CountsNoMoreElementsThanCanFollow) {
  std::vector<std::uint8_t> bytes = wire(std::uint32_t{3});
  bytes.resize(4 + 3 * 24);
  WireReader enough(bytes.data(), bytes.size());
  EXPECT_EQ(enough.count(24), 3U);
  EXPECT_TRUE(enough.ok());
  WireReader short_by_one(bytes.data(), bytes.size() - 1);
  EXPECT_EQ(short_by_one.count(24), 0U);
  EXPECT_FALSE(short_by_one.ok());
  const auto huge = wire(std::uint32_t{4000000000U});
  WireReader claims(huge.data(), huge.size());
  EXPECT_EQ(claims.count(24), 0U);
  EXPECT_NE(claims.failure().find("4000000000"), std::string::npos) << claims.failure();
}

TEST(WireReader, RefusesTimesThatAreNone) {
  const auto bytes = wire(std::uint32_t{1}, std::uint32_t{1000000000U});
  WireReader reader(bytes.data(), bytes.size());
  EXPECT_TRUE(reader.time().isZero());
  EXPECT_FALSE(reader.ok());
}

TEST(WireReader, TakesAnyDuration) {
  const auto bytes = wire(std::int32_t{INT32_MIN}, std::int32_t{INT32_MIN});
  WireReader reader(bytes.data(), bytes.size());
  EXPECT_EQ(reader.duration(), INT32_MIN * 1000000001LL);
  EXPECT_TRUE(reader.ok());
}

TEST(WireReader, SkipsNoFurtherThanTheEnd) {
  const auto bytes = wire(std::uint32_t{1});
  WireReader reader(bytes.data(), bytes.size());
  reader.skip(4);
  EXPECT_TRUE(reader.ok());
  reader.skip(~0ULL);
  EXPECT_FALSE(reader.ok());
}

}  // namespace
}  // namespace box_query
