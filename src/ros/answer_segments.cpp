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

/// Of a batch, segments that the scene gets together.
constexpr std::size_t kSegmentsAtOnce = 128;

Segment segmentIn(const Context& context, const geometry_msgs::Point& start,
                  const geometry_msgs::Point& end, const Field& field) {
  Segment segment = {context.frame.pointIn(fromMessage(start)),
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

/// Whether a clearance says that a segment is clear: rounding keeps the order, so what is rounded
/// to more than the radius is more. What is rounded to the radius itself says nothing.
bool isMoreThan(double radius, const Clearance& nearest) {
  return nearest.distance > radius;
}

std::int32_t indexOf(std::size_t box) {
  return box == kNoBox ? -1 : static_cast<std::int32_t>(box);
}

Outcome outcomeOf(std::uint8_t state) {
  return state == CheckSegmentsResponse::BLOCKED ? Outcome::kMet
         : state == CheckSegmentsResponse::CLEAR ? Outcome::kFree
                                                 : Outcome::kUnknown;
}

/// What is asked about each segment, and where its answers go.
class SegmentBatch {
 public:
  SegmentBatch(const CheckSegmentsRequest& request, Context& context, const BoxMask* mask,
               CheckSegmentsResponse& response)
      : request_(request),
        context_(context),
        scene_(context.snapshot.scene),
        mask_(mask),
        response_(response),
        trusted_(response.complete || request.allow_incomplete),
        want_nearest_(request.want_clearances || request.want_points || request.want_boxes),
        want_blockage_(request.want_blocked_at || request.want_boxes) {
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
  }

  /// Whether what is known is enough to say that a segment is clear.
  bool trusted() const { return trusted_; }

  /// Answers those from `begin` to `end`.
  void answerPart(std::size_t begin, std::size_t end) {
    std::array<Segment, kSegmentsAtOnce> segments;
    std::vector<Clearance> nearest(want_nearest_ ? std::min(kSegmentsAtOnce, end - begin) : 0);
    for (; begin < end; begin += kSegmentsAtOnce) {
      checkRunning(context_.stopping);
      const std::size_t count = std::min(kSegmentsAtOnce, end - begin);
      take(begin, count, segments.data());
      if (want_nearest_) {
        scene_.clearance(segments.data(), count, nearest.data(), mask_);
        set(begin, nearest.data(), nearest.data() + count);
      }
      decide(begin, count, segments.data(), nearest.data());
    }
  }

  /// The few that are drawn, where somebody looks, are asked again.
  void draw() {
    for (std::size_t i = 0; i < response_.states.size() && !context_.drawing.full(); ++i) {
      if (response_.states[i] == CheckSegmentsResponse::NOT_EVALUATED) {
        return;
      }
      Segment segment;
      take(i, 1, &segment);
      box_query::draw(segment, outcomeOf(response_.states[i]),
                      want_nearest_ ? nearestOf(segment) : Clearance(),
                      want_blockage_ ? blockageOf(i, segment) : Blockage(), context_.drawing);
    }
  }

 private:
  void take(std::size_t begin, std::size_t count, Segment* segments) const {
    const auto [start, end] = endsOf(request_, begin);
    const std::size_t step = request_.shape == CheckSegmentsRequest::PAIRS ? 2 : 1;
    const geometry_msgs::Point* const starts = &request_.points[start];
    const geometry_msgs::Point* const ends = &request_.points[end];
    if (context_.frame.same()) {
      for (std::size_t k = 0; k < count; ++k) {
        segments[k] = {fromMessage(starts[step * k]), fromMessage(ends[step * k])};
      }
      return;
    }
    for (std::size_t k = 0; k < count; ++k) {
      segments[k] =
          segmentIn(context_, starts[step * k], ends[step * k], {"points", start + step * k});
    }
  }
  double radiusOf(std::size_t i) const {
    return request_.radii.empty() ? 0.0 : elementAt(request_.radii, i);
  }
  Clearance nearestOf(const Segment& segment) const { return scene_.clearance(segment, mask_); }
  Blockage blockageOf(std::size_t i, const Segment& segment) const {
    return scene_.firstBlockage(segment, radiusOf(i), mask_);
  }

  /// `nearest`: of each, if they are wanted.
  void decide(std::size_t begin, std::size_t count, const Segment* segments,
              const Clearance* nearest) {
    if (!want_nearest_ && !want_blockage_ && request_.radii.size() <= 1) {
      std::uint8_t* const states = &response_.states[begin];
      scene_.isClear(segments, count, states, radiusOf(begin), mask_);
      std::transform(states, states + count, states,
                     [this](std::uint8_t clear) { return stateOf(clear == 0); });
      return;
    }
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = begin + k;
      const bool clear = want_nearest_ && isMoreThan(radiusOf(i), nearest[k]);
      response_.states[i] = stateOf(isBlocked(i, segments[k], clear));
    }
  }
  /// Fills in by what, if that is wanted. @param clear whether that is known; else it is asked
  bool isBlocked(std::size_t i, const Segment& segment, bool clear) {
    if (!want_blockage_) {
      return !clear && !scene_.isClear(segment, radiusOf(i), mask_);
    }
    const Blockage blockage = clear ? Blockage() : blockageOf(i, segment);
    if (request_.want_blocked_at) {
      response_.blocked_at[i] = blockage.blocked_at;
    }
    if (request_.want_boxes) {
      response_.blocking_boxes[i] = indexOf(blockage.box);
    }
    return blockage.blocked;
  }

  /// An array after the other, each of those that are wanted.
  void set(std::size_t begin, const Clearance* first, const Clearance* last) {
    const FrameChange& frame = context_.frame;
    const auto fill = [=](auto& values, auto&& valueOf) {
      if (!values.empty()) {
        std::transform(first, last, &values[begin], valueOf);
      }
    };
    fill(response_.clearances, [](const Clearance& c) { return c.distance; });
    fill(response_.points_on_segment,
         [&](const Clearance& c) { return toPoint(frame.pointBack(c.on_segment)); });
    fill(response_.points_on_box,
         [&](const Clearance& c) { return toPoint(frame.pointBack(c.on_box)); });
    fill(response_.nearest_boxes, [](const Clearance& c) { return indexOf(c.box); });
  }
  std::uint8_t stateOf(bool blocked) const {
    return blocked    ? CheckSegmentsResponse::BLOCKED
           : trusted_ ? CheckSegmentsResponse::CLEAR
                      : CheckSegmentsResponse::UNKNOWN;
  }

  const CheckSegmentsRequest& request_;
  Context& context_;
  const Scene& scene_;
  const BoxMask* const mask_;
  CheckSegmentsResponse& response_;
  const bool trusted_;
  const bool want_nearest_;
  const bool want_blockage_;
};

}  // namespace

void check(const CheckSegmentRequest& request, const Limits& limits) {
  checkCommon(request, limits);
  checkPoint({"start"}, fromMessage(request.start), limits);
  checkPoint({"end"}, fromMessage(request.end), limits);
  checkRadius({"radius"}, request.radius, limits);
}

void check(const CheckSegmentsRequest& request, const Limits& limits) {
  checkCommon(request, limits);
  if (request.shape != CheckSegmentsRequest::PAIRS && request.shape != CheckSegmentsRequest::PATH) {
    refuse({"shape"}, "is " + std::to_string(request.shape) + ": give PAIRS (0) or PATH (1)");
  }
  if (request.shape == CheckSegmentsRequest::PAIRS && request.points.size() % 2 != 0) {
    refuse({"points"}, "has " + std::to_string(request.points.size()) +
                           " elements: PAIRS needs a start and an end for every segment");
  }
  const std::size_t segments = segmentCount(request);
  checkCount("segments", segments, limits);
  checkLength("radii", request.radii.size(), segments, true);
  checkPoints("points", request.points, limits);
  for (std::size_t i = 0; i < request.radii.size(); ++i) {
    checkRadius({"radii", i}, request.radii[i], limits);
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
  describeScene(request, context.snapshot, context.now, response);
  const Snapshot& snapshot = context.snapshot;
  const auto mask = maskOf(BoxFilter(request), snapshot);
  const BoxMask* const looked_at = mask ? &*mask : nullptr;
  const Segment segment = segmentIn(context, request.start, request.end, {"start"});
  const Clearance nearest = snapshot.scene.clearance(segment, looked_at);
  const Blockage blockage = isMoreThan(request.radius, nearest)
                                ? Blockage()
                                : snapshot.scene.firstBlockage(segment, request.radius, looked_at);
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
  describeScene(request, context.snapshot, context.now, response);
  const auto mask = maskOf(BoxFilter(request), context.snapshot);
  SegmentBatch batch(request, context, mask ? &*mask : nullptr, response);
  const std::size_t segments = segmentCount(request);

  // Those that may be the last one after the other.
  std::size_t answered = 0;
  bool ended = false;
  for (; request.stop_at_blocked && answered < segments && !ended; ++answered) {
    batch.answerPart(answered, answered + 1);
    ended = response.states[answered] == CheckSegmentsResponse::BLOCKED;
  }
  forEachCountedPart(ended ? 0 : segments - answered, context.batch_threads, context.totals,
                     [&](std::size_t begin, std::size_t end) {
                       batch.answerPart(answered + begin, answered + end);
                     });
  batch.draw();

  const auto blocked =
      std::find(response.states.begin(), response.states.end(), CheckSegmentsResponse::BLOCKED);
  response.first_blocked = -1;
  if (blocked != response.states.end()) {
    response.first_blocked = static_cast<std::int32_t>(blocked - response.states.begin());
  }
  response.all_clear = segments > 0 && batch.trusted() && response.first_blocked < 0;
  nameBoxes(context.snapshot, {&response.nearest_boxes, &response.blocking_boxes}, response);
}

}  // namespace box_query
