// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a request of any service: the first byte chooses it. They are refused with a
// sentence, or answered, in arrays as long as the request asks for.
#include "fuzz/fuzz.h"
#include "ros/answers.h"
#include "ros/checked_request.h"
#include "unit/answer_fixture.h"

#include <stdexcept>

namespace box_query::fuzz {
namespace {

constexpr std::uint32_t kMaxQueries = 100;
/// The largest element of an array of a request or an answer, a name, and what is allocated for
/// all queries of a batch.
constexpr std::size_t kSmall = 1U << 17;
constexpr std::size_t kMemoryFactor = 64;

const Snapshot& snapshot() {
  static const Snapshot made = test::randomSnapshot(20, 5);
  return made;
}

void requireFit(const CastRaysRequest& request, const CastRaysResponse& response) {
  require(response.hits.size() == request.directions.size(), "every ray is answered");
}
void requireFit(const CheckSegmentsRequest& request, const CheckSegmentsResponse& response) {
  require(response.states.size() <= request.points.size(), "every segment is answered");
}
void requireFit(const FindIntersectionsRequest& /*request*/,
                const FindIntersectionsResponse& response) {
  require(response.box_ids.size() <= snapshot().names.size(), "boxes are those of the scene");
}
template <typename Request, typename Response>
void requireFit(const Request& /*request*/, const Response& /*response*/) {}

template <typename Request>
void ask(const Request& request) {
  typename test::ResponseTo<Request>::type response;
  Limits limits;
  limits.queries = kMaxQueries;
  check(request, limits);
  Context context = {snapshot(), ros::Time(100), FrameChange(), Drawing(0)};
  answer(request, context, response);
  requireFit(request, response);
  test::bytesOf(response);
}
void ask(const GetSceneRequest& request) {
  GetSceneResponse response;
  check(request, Limits());
  answer(request, snapshot(), ros::Time(100), response);
  test::bytesOf(response);
}

template <typename Request>
void testBytes(const std::uint8_t* data, std::size_t size) {
  const AllocationLimit limit(kMemoryFactor * size + kSmall);
  Bytes bytes(data, data + size);
  CheckedRequest<Request> checked;
  checked.max_array_length = 2 * kMaxQueries;
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, checked);
  if (!checked.problem.empty()) {
    return;
  }
  try {
    ask(checked.request);
  } catch (const std::invalid_argument& error) {
    require(error.what()[0] != '\0', "a refusal says why");
  }
}

using Test = void (*)(const std::uint8_t*, std::size_t);
constexpr Test kTests[] = {testBytes<CastRayRequest>,           testBytes<CastRaysRequest>,
                           testBytes<CheckSegmentRequest>,      testBytes<CheckSegmentsRequest>,
                           testBytes<FindIntersectionsRequest>, testBytes<GetSceneRequest>};

template <typename Request>
void addSeed(std::uint8_t service, Request request, std::vector<Bytes>& all) {
  Bytes seed = {service};
  const Bytes bytes = test::bytesOf(request);
  seed.insert(seed.end(), bytes.begin(), bytes.end());
  all.push_back(seed);
}

}  // namespace

std::vector<Bytes> seeds() {
  std::vector<Bytes> all;
  CastRayRequest ray;
  ray.header.frame_id = "map";
  ray.direction.x = 1.0;
  ray.namespaces = {"", "rack"};
  ray.allow_incomplete = 1;
  addSeed(0, ray, all);
  CastRaysRequest rays;
  rays.header.frame_id = "map";
  rays.origins.resize(1);
  rays.directions.assign(5, ray.direction);
  rays.max_ranges = {3.0};
  rays.want_exits = rays.want_points = rays.want_normals = rays.want_boxes = 1;
  addSeed(1, rays, all);
  CheckSegmentRequest segment;
  segment.header.frame_id = "map";
  segment.end.x = 9.0;
  segment.radius = 0.5;
  segment.ignore_topics = {"/a"};
  segment.ignore_namespaces = {""};
  segment.ignore_ids = {3};
  addSeed(2, segment, all);
  CheckSegmentsRequest segments;
  segments.header.frame_id = "map";
  segments.shape = CheckSegmentsRequest::PATH;
  segments.points.resize(4);
  segments.points[1].x = 3.0;
  segments.points[2].y = -3.0;
  segments.radii = {0.25};
  segments.want_clearances = segments.want_points = segments.want_blocked_at = 1;
  segments.want_boxes = 1;
  addSeed(3, segments, all);
  FindIntersectionsRequest all_boxes;
  all_boxes.header.frame_id = "map";
  all_boxes.direction.x = 1.0;
  addSeed(4, all_boxes, all);
  addSeed(5, GetSceneRequest(), all);
  return all;
}

void testOne(const std::uint8_t* data, std::size_t size) {
  if (size > 0) {
    kTests[data[0] % std::size(kTests)](data + 1, size - 1);
  }
}

}  // namespace box_query::fuzz
