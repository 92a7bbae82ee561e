// SPDX-License-Identifier: BSD-3-Clause
#include "ros/answers.h"
#include "ros/named_boxes.h"
#include "ros/request_checks.h"

#include <box_query/batch.h>

#include <algorithm>
#include <array>
#include <vector>

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

/// What is asked about each ray, and where its answers go.
class RayBatch {
 public:
  RayBatch(const CastRaysRequest& request, Context& context, const BoxMask* mask,
           CastRaysResponse& response)
      : request_(request),
        context_(context),
        scene_(context.snapshot.scene),
        mask_(mask),
        response_(response),
        closest_(request.mode == CastRaysRequest::CLOSEST) {
    const std::size_t rays = request.directions.size();
    const auto wanted = [&](bool want) { return closest_ && want ? rays : 0; };
    response.hits.resize(rays);
    response.ranges.resize(wanted(true));
    response.exit_ranges.resize(wanted(request.want_exits));
    response.points.resize(wanted(request.want_points));
    response.normals.resize(wanted(request.want_normals));
    response.boxes.resize(wanted(request.want_boxes));
  }

  /// Answers those from `begin` to `end`.
  void answerPart(std::size_t begin, std::size_t end) {
    std::array<Ray, kRaysAtOnce> rays;
    std::array<double, kRaysAtOnce> each;
    std::vector<Hit> hits(closest_ ? std::min(kRaysAtOnce, end - begin) : 0);
    for (; begin < end; begin += kRaysAtOnce) {
      checkRunning(context_.stopping);
      const std::size_t count = std::min(kRaysAtOnce, end - begin);
      take(begin, count, rays.data());
      const MaxRanges max_ranges = rangesOf(begin, count, each.data());
      if (closest_) {
        scene_.cast(rays.data(), count, hits.data(), max_ranges, mask_);
        set(begin, hits.data(), hits.data() + count);
      } else {
        scene_.castAny(rays.data(), count, &response_.hits[begin], max_ranges, mask_);
      }
    }
  }

  /// The few that are drawn, where somebody looks, are cast again.
  void draw() {
    const bool miss_means_free = response_.complete || request_.allow_incomplete;
    for (std::size_t i = 0; i < response_.hits.size() && !context_.drawing.full(); ++i) {
      Ray ray;
      take(i, 1, &ray);
      const double max_range = rangeOf(i);
      Hit hit;
      if (closest_) {
        hit = scene_.cast(ray, max_range, mask_);
      } else {
        hit.hit = response_.hits[i] != 0;
      }
      box_query::draw(ray, max_range, hit, miss_means_free, context_.drawing);
    }
  }

 private:
  void take(std::size_t begin, std::size_t count, Ray* rays) const {
    const std::size_t step = request_.origins.size() == 1 ? 0 : 1;
    const geometry_msgs::Point* const origins = &request_.origins[step * begin];
    const geometry_msgs::Vector3* const directions = &request_.directions[begin];
    if (context_.frame.same()) {
      for (std::size_t k = 0; k < count; ++k) {
        rays[k] = {fromMessage(origins[step * k]), fromMessage(directions[k])};
      }
      return;
    }
    for (std::size_t k = 0; k < count; ++k) {
      rays[k] = rayIn(context_, origins[step * k], directions[k], {"directions", begin + k});
    }
  }

  double rangeOf(std::size_t i) const {
    return request_.max_ranges.empty() ? kInf : limitOf(elementAt(request_.max_ranges, i));
  }
  /// Where they differ, those of the rays are written to `each`.
  MaxRanges rangesOf(std::size_t begin, std::size_t count, double* each) const {
    if (request_.max_ranges.size() <= 1) {
      return rangeOf(0);
    }
    const double* const given = &request_.max_ranges[begin];
    std::transform(given, given + count, each, limitOf);
    return MaxRanges(each);
  }

  /// An array after the other, each of those that are wanted.
  void set(std::size_t begin, const Hit* first, const Hit* last) {
    const FrameChange& frame = context_.frame;
    const auto fill = [=](auto& values, auto&& valueOf) {
      if (!values.empty()) {
        std::transform(first, last, &values[begin], valueOf);
      }
    };
    fill(response_.hits, [](const Hit& hit) { return hit.hit; });
    fill(response_.ranges, [](const Hit& hit) { return hit.range; });
    fill(response_.exit_ranges, [](const Hit& hit) { return hit.exit_range; });
    fill(response_.points, [&](const Hit& hit) { return toPoint(frame.pointBack(hit.point)); });
    fill(response_.normals,
         [&](const Hit& hit) { return toVector3(frame.directionBack(hit.normal)); });
    fill(response_.boxes,
         [](const Hit& hit) { return hit.hit ? static_cast<std::int32_t>(hit.box) : -1; });
  }

  const CastRaysRequest& request_;
  Context& context_;
  const Scene& scene_;
  const BoxMask* const mask_;
  CastRaysResponse& response_;
  const bool closest_;
};

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
  checkDirections("directions", request.directions);
  checkPoints("origins", request.origins, limits);
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
  const auto mask = maskOf(BoxFilter(request), context.snapshot);
  RayBatch batch(request, context, mask ? &*mask : nullptr, response);
  forEachCountedPart(request.directions.size(), context.batch_threads, context.totals,
                     [&](std::size_t begin, std::size_t end) { batch.answerPart(begin, end); });
  batch.draw();
  nameBoxes(context.snapshot, {&response.boxes}, response);
}

}  // namespace box_query
