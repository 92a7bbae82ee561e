// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/node_questions.h"

#include "benchmark/answer.h"
#include "benchmark/node_server.h"
#include "benchmark/speed.h"
#include "ros/conversions.h"

#include <box_query/batch.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace box_query::benchmark {
namespace {

constexpr double kRadius = 0.25;

/// Keeps what the library is asked for from being optimised away.
template <class Answer>
void keep(const std::vector<Answer>& answers) {
  asm volatile("" : : "r"(answers.data()) : "memory");
}

BatchOptions optionsFor(int threads) {
  BatchOptions options;
  options.max_threads = threads;
  return options;
}

bool same(double a, double b) {
  return bitsOf(a) == bitsOf(b) || (std::isnan(a) && std::isnan(b));
}
template <class Message>
bool same(const Message& a, const Vector3& b) {
  return same(a.x, b.x()) && same(a.y, b.y()) && same(a.z, b.z());
}

/// The id of a box that an answer names by its place in a list; kNoBox for none. Ids are indices.
template <class Response>
std::size_t boxOf(const Response& response, std::int32_t place) {
  return place < 0 ? kNoBox
                   : static_cast<std::size_t>(response.box_ids.at(static_cast<std::size_t>(place)));
}

/// How many of `count` answers are not right; all of them unless each of the arrays has as many.
template <class IsRight>
std::size_t countWrong(std::size_t count, std::initializer_list<std::size_t> lengths,
                       IsRight&& is_right) {
  if (std::any_of(lengths.begin(), lengths.end(),
                  [&](std::size_t length) { return length != count; })) {
    return count;
  }
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    wrong += is_right(i) ? 0 : 1;
  }
  return wrong;
}

CastRaysRequest requestFor(const std::vector<Ray>& rays) {
  CastRaysRequest request;
  request.header.frame_id = kFrame;
  for (const Ray& ray : rays) {
    request.origins.push_back(toPoint(ray.origin));
    request.directions.push_back(toVector3(ray.direction));
  }
  return request;
}

CheckSegmentsRequest requestFor(const std::vector<Segment>& segments) {
  CheckSegmentsRequest request;
  request.header.frame_id = kFrame;
  request.shape = CheckSegmentsRequest::PAIRS;
  for (const Segment& segment : segments) {
    request.points.push_back(toPoint(segment.start));
    request.points.push_back(toPoint(segment.end));
  }
  request.radii = {kRadius};
  return request;
}

std::size_t wrongRays(const CastRaysRequest& request, const CastRaysResponse& response,
                      const std::vector<Hit>& right) {
  const std::size_t count = right.size();
  if (request.mode == CastRaysRequest::ANY) {
    return countWrong(count, {response.hits.size()},
                      [&](std::size_t i) { return (response.hits[i] != 0) == right[i].hit; });
  }
  const std::size_t wanted = request.want_boxes ? count : 0;  // and so the others
  const std::size_t optional = response.exit_ranges.size() + response.points.size() +
                               response.normals.size() + response.boxes.size();
  if (optional != 4 * wanted) {
    return count;
  }
  return countWrong(count, {response.hits.size(), response.ranges.size()}, [&](std::size_t i) {
    const Hit& hit = right[i];
    return (response.hits[i] != 0) == hit.hit && same(response.ranges[i], hit.range) &&
           (wanted == 0 ||
            (same(response.exit_ranges.at(i), hit.exit_range) &&
             same(response.points.at(i), hit.point) && same(response.normals.at(i), hit.normal) &&
             boxOf(response, response.boxes.at(i)) == hit.box));
  });
}

/// What is right of a segment.
struct Checked {
  std::vector<std::uint8_t> clear;
  std::vector<Clearance> nearest;
  std::vector<Blockage> blockages;
};

std::size_t wrongSegments(const CheckSegmentsRequest& request,
                          const CheckSegmentsResponse& response, const Checked& right) {
  const std::size_t count = right.clear.size();
  if (response.clearances.size() != (request.want_clearances ? count : 0)) {
    return count;
  }
  return countWrong(count, {response.states.size()}, [&](std::size_t i) {
    const Clearance& nearest = right.nearest[i];
    const Blockage& blockage = right.blockages[i];
    return response.states[i] == (right.clear[i] != 0 ? CheckSegmentsResponse::CLEAR
                                                      : CheckSegmentsResponse::BLOCKED) &&
           (!request.want_clearances || same(response.clearances[i], nearest.distance)) &&
           (!request.want_boxes ||
            (same(response.points_on_segment.at(i), nearest.on_segment) &&
             same(response.points_on_box.at(i), nearest.on_box) &&
             same(response.blocked_at.at(i), blockage.blocked_at) &&
             boxOf(response, response.nearest_boxes.at(i)) == nearest.box &&
             boxOf(response, response.blocking_boxes.at(i)) == blockage.box));
  });
}

}  // namespace

std::vector<BatchQuestion<CastRays>> rayQuestions(const Scene& scene, const std::vector<Ray>& rays,
                                                  int threads) {
  const BatchOptions options = optionsFor(threads);
  const auto hits = std::make_shared<const std::vector<Hit>>(castEach(scene, rays));
  const auto question = [&](const char* asks, const CastRaysRequest& request,
                            const std::function<void()>& ask) {
    return BatchQuestion<CastRays>{"cast_rays",
                                   asks,
                                   rays.size(),
                                   request,
                                   ask,
                                   [request, hits](const CastRaysResponse& response) {
                                     return wrongRays(request, response, *hits);
                                   }};
  };
  const CastRaysRequest closest = requestFor(rays);
  CastRaysRequest any = closest;
  any.mode = CastRaysRequest::ANY;
  CastRaysRequest everything = closest;
  everything.want_exits = everything.want_points = true;
  everything.want_normals = everything.want_boxes = true;
  const auto cast = [&scene, rays, options] { keep(castEach(scene, rays, options)); };
  return {
      question("closest", closest, cast),
      question("any", any, [&scene, rays, options] { keep(castAnyEach(scene, rays, options)); }),
      question("everything", everything, cast)};
}

std::vector<BatchQuestion<CheckSegments>> segmentQuestions(const Scene& scene,
                                                           const std::vector<Ray>& rays,
                                                           int threads) {
  const BatchOptions options = optionsFor(threads);
  std::vector<Segment> segments;
  for (const Ray& ray : rays) {
    segments.push_back(segmentAlong(ray, kPathLength));
  }
  const auto right = std::make_shared<const Checked>(
      Checked{isClearEach(scene, segments, kRadius), clearanceEach(scene, segments),
              firstBlockageEach(scene, segments, kRadius)});
  const auto question = [&](const char* asks, const CheckSegmentsRequest& request,
                            const std::function<void()>& ask) {
    return BatchQuestion<CheckSegments>{"check_segments",
                                        asks,
                                        rays.size(),
                                        request,
                                        ask,
                                        [request, right](const CheckSegmentsResponse& response) {
                                          return wrongSegments(request, response, *right);
                                        }};
  };
  const CheckSegmentsRequest states = requestFor(segments);
  CheckSegmentsRequest clearances = states;
  clearances.want_clearances = true;
  CheckSegmentsRequest everything = clearances;
  everything.want_points = everything.want_blocked_at = everything.want_boxes = true;
  // A clearance above the radius says that nothing blocks: the library is not asked again.
  std::vector<Segment> near;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (!(right->nearest[i].distance > kRadius)) {
      near.push_back(segments[i]);
    }
  }
  return {question("states", states,
                   [&scene, segments, options] {
                     keep(isClearEach(scene, segments, kRadius, options));
                   }),
          question("clearances", clearances,
                   [&scene, segments, near, options] {
                     keep(clearanceEach(scene, segments, options));
                     keep(isClearEach(scene, near, kRadius, options));
                   }),
          question("everything", everything, [&scene, segments, near, options] {
            keep(clearanceEach(scene, segments, options));
            keep(firstBlockageEach(scene, near, kRadius, options));
          })};
}

}  // namespace box_query::benchmark
