// SPDX-License-Identifier: BSD-3-Clause
#include "ros/checked_request.h"

#include <box_query/CastRay.h>
#include <box_query/CastRays.h>
#include <box_query/CheckSegment.h>
#include <box_query/CheckSegments.h>
#include <box_query/FindIntersections.h>
#include <box_query/GetScene.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>
#include <type_traits>

#include <gtest/gtest.h>

namespace {

// Largest block that operator new was asked for since it was reset.
std::size_t largest_block = 0;

}  // namespace

// Not inlined: g++ 12 would take the pair for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  largest_block = std::max(largest_block, size);
  void* const block = std::malloc(size);
  if (block == nullptr) {
    throw std::bad_alloc();
  }
  return block;
}
[[gnu::noinline]] void operator delete(void* block) noexcept {
  std::free(block);
}
[[gnu::noinline]] void operator delete(void* block, std::size_t) noexcept {
  std::free(block);
}

namespace box_query {
namespace {

namespace ser = ros::serialization;
using Bytes = std::vector<std::uint8_t>;

template <class Message>
Bytes encode(const Message& message) {
  Bytes bytes(ser::serializationLength(message));
  ser::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ser::serialize(stream, message);
  return bytes;
}

template <class Request>
CheckedRequest<Request> decode(const Bytes& given, std::uint32_t max_array_length = 1000) {
  // A block of exactly this size, so that AddressSanitizer sees a read beyond it.
  const Bytes bytes(given.begin(), given.end());
  CheckedRequest<Request> checked;
  checked.max_array_length = max_array_length;
  ser::IStream stream(const_cast<std::uint8_t*>(bytes.data()),
                      static_cast<std::uint32_t>(bytes.size()));
  ser::deserialize(stream, checked);
  return checked;
}

/// Fills what all requests have in common.
template <class Request>
Request withFilters() {
  Request request;
  request.topics = {"boxes"};
  request.namespaces = {"rack", "", "pallet"};
  request.labels = {"tote"};
  request.ignore_topics = {"/boxes"};
  request.ignore_namespaces = {"robot"};
  request.ignore_ids = {-3};
  request.scene_time = ros::Time(5, 6);
  if constexpr (!std::is_same_v<Request, GetSceneRequest>) {
    request.header.frame_id = "base_link";
    request.header.stamp = ros::Time(7, 8);
    request.allow_incomplete = true;
  }
  return request;
}

template <class Request>
Request example();

template <>
CastRayRequest example() {
  auto request = withFilters<CastRayRequest>();
  request.origin.x = 0.1;
  request.direction.z = -1;
  request.max_range = 5;
  return request;
}

template <>
CastRaysRequest example() {
  auto request = withFilters<CastRaysRequest>();
  request.mode = CastRaysRequest::ANY;
  request.origins.resize(1);
  request.directions.resize(3);
  request.directions[2].y = 1e-300;
  request.max_ranges = {1, 2, 3};
  request.want_boxes = true;
  return request;
}

template <>
CheckSegmentRequest example() {
  auto request = withFilters<CheckSegmentRequest>();
  request.end.y = 4;
  request.radius = 0.25;
  return request;
}

template <>
CheckSegmentsRequest example() {
  auto request = withFilters<CheckSegmentsRequest>();
  request.points.resize(4);
  request.points[3].x = -0.0;
  request.radii = {0.5};
  request.want_points = true;
  return request;
}

template <>
FindIntersectionsRequest example() {
  auto request = withFilters<FindIntersectionsRequest>();
  request.component = FindIntersectionsRequest::SEGMENT;
  request.end.x = 1;
  return request;
}

template <>
GetSceneRequest example() {
  auto request = withFilters<GetSceneRequest>();
  request.scene_id = 1234567890123;
  return request;
}

template <class Request>
class CheckedRequests : public testing::Test {};

using Requests = testing::Types<CastRayRequest, CastRaysRequest, CheckSegmentRequest,
                                CheckSegmentsRequest, FindIntersectionsRequest, GetSceneRequest>;
TYPED_TEST_SUITE(CheckedRequests, Requests);

TYPED_TEST(CheckedRequests, DecodeAsRoscppDoes) {
  const Bytes bytes = encode(example<TypeParam>());
  const auto checked = decode<TypeParam>(bytes);
  EXPECT_EQ(checked.problem, "");
  EXPECT_EQ(encode(checked.request), bytes);
}

TYPED_TEST(CheckedRequests, AreRefusedWhereverTheyAreCutShort) {
  const Bytes bytes = encode(example<TypeParam>());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto checked = decode<TypeParam>(Bytes(bytes.begin(), bytes.begin() + long(size)));
    EXPECT_NE(checked.problem.find("malformed request: "), std::string::npos) << size;
    EXPECT_EQ(encode(checked.request), encode(TypeParam())) << "left half decoded at " << size;
  }
}

TYPED_TEST(CheckedRequests, AreRefusedWithTrailingBytes) {
  Bytes bytes = encode(example<TypeParam>());
  bytes.push_back(0);
  EXPECT_NE(decode<TypeParam>(bytes).problem.find("1 bytes are left over"), std::string::npos);
}

TYPED_TEST(CheckedRequests, NeverAllocateMoreThanTheyCarry) {
  // A huge count, or length of a string, written over every place where one may stand.
  const Bytes bytes = encode(example<TypeParam>());
  for (const std::uint32_t count : {4000000000U, 0x80000000U, 0xffffffffU, 100000000U, 70000U}) {
    for (std::size_t at = 0; at + 4 <= bytes.size(); ++at) {
      Bytes forged = bytes;
      std::memcpy(&forged[at], &count, sizeof count);
      largest_block = 0;
      decode<TypeParam>(forged, 1000000);
      EXPECT_GE(largest_block, bytes.size()) << "the copy of the bytes was not seen";
      // Elements in memory are at most 8 times as large as on the wire (an empty string).
      EXPECT_LE(largest_block, 8 * bytes.size()) << count << " at " << at;
    }
  }
}

TEST(CheckedRequest, RefusesCountsOfFourBillion) {
  CastRaysRequest request;
  Bytes bytes = encode(request);
  // header (seq, stamp, frame length), mode: then the count of the origins.
  const std::uint32_t count = 4000000000U;
  std::memcpy(&bytes[4 + 8 + 4 + 1], &count, sizeof count);
  EXPECT_NE(decode<CastRaysRequest>(bytes, 0xffffffffU).problem.find("array of 4000000000"),
            std::string::npos);
}

TEST(CheckedRequest, RefusesArraysBeyondTheLimitAndSaysSo) {
  CastRaysRequest request;
  request.directions.resize(10);
  EXPECT_EQ(decode<CastRaysRequest>(encode(request), 10).problem, "");
  const std::string problem = decode<CastRaysRequest>(encode(request), 9).problem;
  EXPECT_NE(problem.find("array of 10 elements, at most 9"), std::string::npos) << problem;
  EXPECT_NE(problem.find("~max_queries_per_call"), std::string::npos) << problem;
}

}  // namespace
}  // namespace box_query
