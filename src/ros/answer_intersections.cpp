// SPDX-License-Identifier: BSD-3-Clause
#include "ros/answers.h"
#include "ros/named_boxes.h"
#include "ros/request_checks.h"

namespace box_query {
namespace {

void refuseOverflow(const Snapshot& snapshot) {
  throw std::invalid_argument("the component overflows or vanishes in frame " + snapshot.frame +
                              ": give numbers nearer to 1");
}

template <class Component>
void answerFor(const Component& component, const BoxMask* mask, Context& context,
               FindIntersectionsResponse& response) {
  const Snapshot& snapshot = context.snapshot;
  for (const auto& [box, met] : snapshot.scene.findAll(component, mask)) {
    const IntersectionRanges ranges =
        std::visit([&](const auto& solid) { return findRanges(component, solid); },
                   snapshot.scene.boxes()[box]);
    response.num_points.push_back(static_cast<std::uint8_t>(met.num_points));
    response.t_enter.push_back(met.t_enter);
    response.t_exit.push_back(met.t_exit);
    response.distance_enter.push_back(ranges.enter);
    response.distance_exit.push_back(ranges.exit);
    response.started_inside.push_back(met.started_inside);
    response.points_enter.push_back(toPoint(context.frame.pointBack(met.enter_point)));
    response.points_exit.push_back(toPoint(context.frame.pointBack(met.exit_point)));
    response.faces_entered.push_back(met.entered.bits());
    response.faces_left.push_back(met.left.bits());
    appendName(snapshot.names[box], response);
    if (!context.drawing.full()) {
      DrawnQuery query;
      query.kind = DrawnQuery::Kind::kSegment;
      query.outcome = Outcome::kMet;
      query.start = query.hit = met.enter_point;
      query.end = met.exit_point;
      context.drawing.add(query);
    }
  }
}

}  // namespace

void check(const FindIntersectionsRequest& request, const Limits& limits) {
  checkCommon(request, limits);
  checkPoint({"origin"}, fromMessage(request.origin), limits);
  switch (request.component) {
    case FindIntersectionsRequest::LINE:
    case FindIntersectionsRequest::RAY:
      return checkDirection({"direction"}, fromMessage(request.direction));
    case FindIntersectionsRequest::SEGMENT:
      return checkPoint({"end"}, fromMessage(request.end), limits);
    default:
      refuse({"component"},
             "is " + std::to_string(request.component) + ": give LINE (0), RAY (1) or SEGMENT (2)");
  }
}

void answer(const FindIntersectionsRequest& request, Context& context,
            FindIntersectionsResponse& response) {
  describeScene(request, context.snapshot, context.now, response);
  const auto mask = maskOf(BoxFilter(request), context.snapshot);
  const BoxMask* const looked_at = mask ? &*mask : nullptr;
  const Vector3 origin = context.frame.pointIn(fromMessage(request.origin));
  if (request.component == FindIntersectionsRequest::SEGMENT) {
    const Segment segment = {origin, context.frame.pointIn(fromMessage(request.end))};
    if (!isValid(segment)) {
      refuseOverflow(context.snapshot);
    }
    return answerFor(segment, looked_at, context, response);
  }
  const Ray ray = {origin, context.frame.directionIn(fromMessage(request.direction))};
  if (!isValid(ray) || ray.direction.isZero(0)) {
    refuseOverflow(context.snapshot);
  }
  if (request.component == FindIntersectionsRequest::RAY) {
    answerFor(ray, looked_at, context, response);
  } else {
    answerFor(Line{ray.origin, ray.direction}, looked_at, context, response);
  }
}

}  // namespace box_query
