// SPDX-License-Identifier: BSD-3-Clause
#include "ros/answers.h"
#include "ros/named_boxes.h"
#include "ros/request_checks.h"

#include <box_query/batch.h>

#include <algorithm>

namespace box_query {
namespace {

Segment segmentIn(const Context& context, const geometry_msgs::Point& start,
                  const geometry_msgs::Point& end, const Field& field) {
  const Segment segment = {context.frame.pointIn(fromMessage(start)),
                           context.frame.pointIn(fromMessage(end))};
  if (!context.frame.same() && !isValid(segment)) {
    refuse(field, "or the end of its segment overflows in frame " + context.snapshot.frame +
                      ": give smaller numbers");
  }
  return segment;
}

std::size_t segmentCount(const CheckSegmentsRequest& request) {
  const std::size_t points = request.points.size();
  if (request.shape == CheckSegmentsRequest::PAIRS) {
    return points / 2;
  }
  return points > 1 ? points - 1 : points;
}

/// Indices of the points where segment `i` starts and ends.
std::pair<std::size_t, std::size_t> endsOf(const CheckSegmentsRequest& request, std::size_t i) {
  if (request.shape == CheckSegmentsRequest::PAIRS) {
    return {2 * i, 2 * i + 1};
  }
  return {i, request.points.size() == 1 ? i : i + 1};
}

void draw(const Segment& segment, Outcome outcome, const Clearance& nearest,
          const Blockage& blockage, Drawing& drawing) {
  if (drawing.full()) {
    return;
  }
  DrawnQuery query;
  query.kind = DrawnQuery::Kind::kSegment;
  query.outcome = outcome;
  query.start = segment.start;
  query.end = segment.end;
  if (blockage.blocked) {
    query.hit = pointAt(segment, blockage.blocked_at);
  }
  query.on_segment = nearest.on_segment;
  query.on_box = nearest.on_box;
  drawing.add(query);
}

std::int32_t indexOf(std::size_t box) {
  return box == kNoBox ? -1 : static_cast<std::int32_t>(box);
}

}  // namespace

void check(const CheckSegmentRequest& request, std::size_t /*max_queries*/) {
  checkCommon(request);
  checkFinite({"start"}, fromMessage(request.start));
  checkFinite({"end"}, fromMessage(request.end));
  checkRadius({"radius"}, request.radius);
}

void check(const CheckSegmentsRequest& request, std::size_t max_queries) {
  checkCommon(request);
  if (request.shape != CheckSegmentsRequest::PAIRS && request.shape != CheckSegmentsRequest::PATH) {
    refuse({"shape"}, "is " + std::to_string(request.shape) + ": give PAIRS (0) or PATH (1)");
  }
  if (request.shape == CheckSegmentsRequest::PAIRS && request.points.size() % 2 != 0) {
    refuse({"points"}, "has " + std::to_string(request.points.size()) +
                           " elements: PAIRS needs a start and an end for every segment");
  }
  const std::size_t segments = segmentCount(request);
  checkCount("segments", segments, max_queries);
  checkLength("radii", request.radii.size(), segments, true);
  for (std::size_t i = 0; i < request.points.size(); ++i) {
    checkFinite({"points", i}, fromMessage(request.points[i]));
  }
  for (std::size_t i = 0; i < request.radii.size(); ++i) {
    checkRadius({"radii", i}, request.radii[i]);
  }
}

template <>
CheckSegmentResponse nothing() {
  CheckSegmentResponse response;
  const geometry_msgs::Point undefined = toPoint(Vector3::Constant(kNan));
  response.clearance = response.nearest_at = response.blocked_at = kNan;
  response.point_on_segment = response.point_on_box = response.blocked_point = undefined;
  return response;
}

template <>
CheckSegmentsResponse nothing() {
  CheckSegmentsResponse response;
  response.first_blocked = -1;
  return response;
}

void answer(const CheckSegmentRequest& request, Context& context, CheckSegmentResponse& response) {
  describeScene(context.snapshot, context.now, response);
  const Snapshot& snapshot = context.snapshot;
  const auto mask = maskOf(BoxFilter(request), snapshot);
  const BoxMask* const looked_at = mask ? &*mask : nullptr;
  const Segment segment = segmentIn(context, request.start, request.end, {"start"});
  const Clearance nearest = snapshot.scene.clearance(segment, looked_at);
  const Blockage blockage = snapshot.scene.firstBlockage(segment, request.radius, looked_at);
  response.blocked = blockage.blocked;
  response.clear = !blockage.blocked && (response.complete || request.allow_incomplete);
  response.clearance = nearest.distance;
  response.nearest_at = nearest.t;
  response.point_on_segment = toPoint(context.frame.pointBack(nearest.on_segment));
  response.point_on_box = toPoint(context.frame.pointBack(nearest.on_box));
  if (nearest.box != kNoBox) {
    const BoxName& name = snapshot.names[nearest.box];
    response.nearest_topic = name.topic;
    response.nearest_namespace = name.ns;
    response.nearest_id = name.id;
    response.nearest_label = name.label;
  }
  response.blocked_at = blockage.blocked_at;
  response.blocked_point = toPoint(Vector3::Constant(kNan));
  if (blockage.blocked) {
    const Segment given = {fromMessage(request.start), fromMessage(request.end)};
    const BoxName& name = snapshot.names[blockage.box];
    response.blocked_point = toPoint(pointAt(given, blockage.blocked_at));
    response.blocking_topic = name.topic;
    response.blocking_namespace = name.ns;
    response.blocking_id = name.id;
    response.blocking_label = name.label;
  }
  const Outcome outcome = response.blocked ? Outcome::kMet
                          : response.clear ? Outcome::kFree
                                           : Outcome::kUnknown;
  draw(segment, outcome, nearest, blockage, context.drawing);
}

void answer(const CheckSegmentsRequest& request, Context& context,
            CheckSegmentsResponse& response) {
  describeScene(context.snapshot, context.now, response);
  const Scene& scene = context.snapshot.scene;
  const auto mask = maskOf(BoxFilter(request), context.snapshot);
  const BoxMask* const looked_at = mask ? &*mask : nullptr;
  const bool trusted = response.complete || request.allow_incomplete;
  const bool want_nearest = request.want_clearances || request.want_points || request.want_boxes;
  const bool want_blockage = request.want_blocked_at || request.want_boxes;

  const std::size_t segments = segmentCount(request);
  const auto wanted = [segments](bool want) { return want ? segments : 0; };
  const geometry_msgs::Point undefined = toPoint(Vector3::Constant(kNan));
  response.states.resize(segments, CheckSegmentsResponse::NOT_EVALUATED);
  response.clearances.resize(wanted(request.want_clearances), kNan);
  response.points_on_segment.resize(wanted(request.want_points), undefined);
  response.points_on_box.resize(wanted(request.want_points), undefined);
  response.blocked_at.resize(wanted(request.want_blocked_at), kNan);
  response.nearest_boxes.resize(wanted(request.want_boxes), -1);
  response.blocking_boxes.resize(wanted(request.want_boxes), -1);
  response.first_blocked = -1;

  const auto segmentOf = [&](std::size_t i) {
    const auto [start, end] = endsOf(request, i);
    return segmentIn(context, request.points[start], request.points[end], {"points", start});
  };
  const auto answerOne = [&](std::size_t i, bool is_drawn) {
    checkRunning(context.stopping);
    const Segment segment = segmentOf(i);
    const double radius = request.radii.empty() ? 0.0 : elementAt(request.radii, i);
    Clearance nearest;
    if (want_nearest) {
      nearest = scene.clearance(segment, looked_at);
    }
    Blockage blockage;
    if (want_blockage) {
      blockage = scene.firstBlockage(segment, radius, looked_at);
    }
    const bool blocked =
        want_blockage ? blockage.blocked : !scene.isClear(segment, radius, looked_at);

    response.states[i] = blocked   ? CheckSegmentsResponse::BLOCKED
                         : trusted ? CheckSegmentsResponse::CLEAR
                                   : CheckSegmentsResponse::UNKNOWN;
    if (request.want_clearances) {
      response.clearances[i] = nearest.distance;
    }
    if (request.want_points) {
      response.points_on_segment[i] = toPoint(context.frame.pointBack(nearest.on_segment));
      response.points_on_box[i] = toPoint(context.frame.pointBack(nearest.on_box));
    }
    if (request.want_blocked_at) {
      response.blocked_at[i] = blockage.blocked_at;
    }
    if (request.want_boxes) {
      response.nearest_boxes[i] = indexOf(nearest.box);
      response.blocking_boxes[i] = indexOf(blockage.box);
    }
    if (is_drawn) {
      draw(segment,
           blocked   ? Outcome::kMet
           : trusted ? Outcome::kFree
                     : Outcome::kUnknown,
           nearest, blockage, context.drawing);
    }
    return blocked;
  };
  // Those that are drawn, and those that may be the last, one after the other.
  std::size_t answered = 0;
  bool ended = false;
  while (answered < segments && !ended && (request.stop_at_blocked || !context.drawing.full())) {
    ended = answerOne(answered++, true) && request.stop_at_blocked;
  }
  if (!ended) {
    const std::size_t first = answered;
    forEachCountedPart(segments - first, context.batch_threads, context.totals,
                       [&](std::size_t begin, std::size_t end) {
                         for (std::size_t i = begin; i < end; ++i) {
                           answerOne(first + i, false);
                         }
                       });
  }
  const auto blocked =
      std::find(response.states.begin(), response.states.end(), CheckSegmentsResponse::BLOCKED);
  if (blocked != response.states.end()) {
    response.first_blocked = static_cast<std::int32_t>(blocked - response.states.begin());
  }
  response.all_clear = segments > 0 && trusted && response.first_blocked < 0;
  nameBoxes(context.snapshot, {&response.nearest_boxes, &response.blocking_boxes}, response);
}

}  // namespace box_query
