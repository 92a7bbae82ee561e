// SPDX-License-Identifier: BSD-3-Clause
#include "ros/answers.h"
#include "ros/named_boxes.h"
#include "ros/request_checks.h"

#include <box_query/batch.h>

#include <algorithm>
#include <array>

namespace box_query {
namespace {

/// [m] that are drawn of a ray that meets nothing.
constexpr double kDrawnRange = 10.0;
/// Of a batch, rays that the scene gets together.
constexpr std::size_t kRaysAtOnce = 128;

Ray rayIn(const Context& context, const geometry_msgs::Point& origin,
          const geometry_msgs::Vector3& direction, const Field& field) {
  Ray ray = {context.frame.pointIn(fromMessage(origin)),
             context.frame.directionIn(fromMessage(direction))};
  if (!context.frame.same() && (!isValid(ray) || ray.direction.isZero(0))) {
    refuse(field, "or its origin overflows or vanishes in frame " + context.snapshot.frame +
                      ": give numbers nearer to 1");
  }
  return ray;
}

double limitOf(double max_range) {
  return max_range == 0 ? kInf : max_range;
}

void draw(const Ray& ray, double max_range, const Hit& hit, bool miss_means_free,
          Drawing& drawing) {
  if (drawing.full()) {
    return;
  }
  DrawnQuery query;
  query.kind = DrawnQuery::Kind::kRay;
  query.outcome = hit.hit ? Outcome::kMet : miss_means_free ? Outcome::kFree : Outcome::kUnknown;
  query.start = ray.origin;
  // An any-hit says that the ray is blocked, but not where.
  query.end = hit.box != kNoBox ? hit.point
                                : Vector3(ray.origin + std::min(max_range, kDrawnRange) *
                                                           ray.direction.stableNormalized());
  query.hit = hit.point;
  query.normal = hit.normal;
  drawing.add(query);
}

}  // namespace

void check(const CastRayRequest& request, const Limits& limits) {
  checkCommon(request, limits);
  checkPoint({"origin"}, fromMessage(request.origin), limits);
  checkDirection({"direction"}, fromMessage(request.direction));
  checkMaxRange({"max_range"}, request.max_range);
}

void check(const CastRaysRequest& request, const Limits& limits) {
  checkCommon(request, limits);
  if (request.mode != CastRaysRequest::CLOSEST && request.mode != CastRaysRequest::ANY) {
    refuse({"mode"}, "is " + std::to_string(request.mode) + ": give CLOSEST (0) or ANY (1)");
  }
  const std::size_t rays = request.directions.size();
  checkCount("rays", rays, limits);
  checkLength("origins", request.origins.size(), rays, false);
  checkLength("max_ranges", request.max_ranges.size(), rays, true);
  for (std::size_t i = 0; i < rays; ++i) {
    checkDirection({"directions", i}, fromMessage(request.directions[i]));
  }
  for (std::size_t i = 0; i < request.origins.size(); ++i) {
    checkPoint({"origins", i}, fromMessage(request.origins[i]), limits);
  }
  for (std::size_t i = 0; i < request.max_ranges.size(); ++i) {
    checkMaxRange({"max_ranges", i}, request.max_ranges[i]);
  }
}

template <>
CastRayResponse nothing() {
  CastRayResponse response;
  response.range = response.exit_range = kNan;
  response.point = toPoint(Vector3::Constant(kNan));
  response.normal = toVector3(Vector3::Constant(kNan));
  return response;
}

void answer(const CastRayRequest& request, Context& context, CastRayResponse& response) {
  describeScene(request, context.snapshot, context.now, response);
  const auto mask = maskOf(BoxFilter(request), context.snapshot);
  const Ray ray = rayIn(context, request.origin, request.direction, {"direction"});
  const double max_range = limitOf(request.max_range);
  const Hit hit = context.snapshot.scene.cast(ray, max_range, mask ? &*mask : nullptr);
  response.hit = hit.hit;
  response.range = hit.range;
  response.exit_range = hit.exit_range;
  response.started_inside = hit.started_inside;
  response.point = toPoint(context.frame.pointBack(hit.point));
  response.normal = toVector3(context.frame.directionBack(hit.normal));
  if (hit.hit) {
    const BoxName& name = context.snapshot.names[hit.box];
    response.box_topic = name.topic;
    response.box_namespace = name.ns;
    response.box_id = name.id;
    response.box_label = name.label;
  }
  draw(ray, max_range, hit, response.complete || request.allow_incomplete, context.drawing);
}

void answer(const CastRaysRequest& request, Context& context, CastRaysResponse& response) {
  describeScene(request, context.snapshot, context.now, response);
  const Scene& scene = context.snapshot.scene;
  const auto mask = maskOf(BoxFilter(request), context.snapshot);
  const BoxMask* const looked_at = mask ? &*mask : nullptr;
  const bool closest = request.mode == CastRaysRequest::CLOSEST;
  const bool want_exits = closest && request.want_exits;
  const bool want_points = closest && request.want_points;
  const bool want_normals = closest && request.want_normals;
  const bool want_boxes = closest && request.want_boxes;
  const bool miss_means_free = response.complete || request.allow_incomplete;
  const std::size_t rays = request.directions.size();
  response.hits.resize(rays);
  response.ranges.resize(closest ? rays : 0);
  response.exit_ranges.resize(want_exits ? rays : 0);
  response.points.resize(want_points ? rays : 0);
  response.normals.resize(want_normals ? rays : 0);
  response.boxes.resize(want_boxes ? rays : 0);
  const auto rayOf = [&](std::size_t i) {
    return rayIn(context, elementAt(request.origins, i), request.directions[i], {"directions", i});
  };
  const auto rangeOf = [&](std::size_t i) {
    return request.max_ranges.empty() ? kInf : limitOf(elementAt(request.max_ranges, i));
  };
  const auto set = [&](std::size_t i, const Hit& hit) {
    response.hits[i] = hit.hit;
    response.ranges[i] = hit.range;
    if (want_exits) {
      response.exit_ranges[i] = hit.exit_range;
    }
    if (want_points) {
      response.points[i] = toPoint(context.frame.pointBack(hit.point));
    }
    if (want_normals) {
      response.normals[i] = toVector3(context.frame.directionBack(hit.normal));
    }
    if (want_boxes) {
      response.boxes[i] = hit.hit ? static_cast<std::int32_t>(hit.box) : -1;
    }
  };
  const auto answerSome = [&](std::size_t begin, std::size_t end) {
    checkRunning(context.stopping);
    std::array<Ray, kRaysAtOnce> some;
    std::array<double, kRaysAtOnce> max_ranges;
    for (std::size_t i = begin; i < end; ++i) {
      some[i - begin] = rayOf(i);
      max_ranges[i - begin] = rangeOf(i);
    }
    const MaxRanges limits(max_ranges.data());
    if (!closest) {
      scene.castAny(some.data(), end - begin, &response.hits[begin], limits, looked_at);
      return;
    }
    std::array<Hit, kRaysAtOnce> hits;
    scene.cast(some.data(), end - begin, hits.data(), limits, looked_at);
    for (std::size_t i = begin; i < end; ++i) {
      set(i, hits[i - begin]);
    }
  };
  forEachCountedPart(rays, context.batch_threads, context.totals,
                     [&](std::size_t begin, std::size_t end) {
                       for (; begin < end; begin += kRaysAtOnce) {
                         answerSome(begin, std::min(begin + kRaysAtOnce, end));
                       }
                     });
  // The few that are drawn, where somebody looks, are cast again.
  for (std::size_t i = 0; i < rays && !context.drawing.full(); ++i) {
    const Ray ray = rayOf(i);
    Hit hit;
    if (closest) {
      hit = scene.cast(ray, rangeOf(i), looked_at);
    } else {
      hit.hit = response.hits[i] != 0;
    }
    draw(ray, rangeOf(i), hit, miss_means_free, context.drawing);
  }
  nameBoxes(context.snapshot, {&response.boxes}, response);
}

}  // namespace box_query
