// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the services answer, without ROS communication: a request is checked, and then answered
/// from a snapshot. The meaning of every field is in srv/.
#pragma once

#include "ros/box_filter.h"
#include "ros/conversions.h"
#include "ros/drawing.h"
#include "ros/limits.h"
#include "ros/query_totals.h"

#include <box_query/CastRay.h>
#include <box_query/CastRays.h>
#include <box_query/CheckSegment.h>
#include <box_query/CheckSegments.h>
#include <box_query/FindIntersections.h>
#include <box_query/GetScene.h>
#include <box_query/ros/scene_monitor.h>

#include <atomic>
#include <cstddef>

#include <ros/time.h>

namespace box_query {

/// Whether a request can be answered at all: everything but its frame.
/// @throws std::invalid_argument with a sentence that says what to do, and which index is at fault.
void check(const CastRayRequest& request, const Limits& limits);
void check(const CastRaysRequest& request, const Limits& limits);
void check(const CheckSegmentRequest& request, const Limits& limits);
void check(const CheckSegmentsRequest& request, const Limits& limits);
void check(const FindIntersectionsRequest& request, const Limits& limits);
void check(const GetSceneRequest& request, const Limits& limits);

/// What a request is answered from.
struct Context {
  const Snapshot& snapshot;
  ros::Time now;      ///< ROS time that is asked about
  FrameChange frame;  ///< from the frame of the request
  Drawing drawing;    ///< filled by the answer
  /// Threads that work on a batch: see forEachPart().
  int batch_threads = 1;
  /// What other threads than the caller's do is added to it, unless it is null.
  QueryTotals* totals = nullptr;
  /// Set by a server that ends; null: none does.
  const std::atomic<bool>* stopping = nullptr;
};

/// Fills the whole response but for `success` and `message`.
/// @pre check(request)
/// @throws std::invalid_argument if a number overflows in the fixed frame; std::runtime_error in
/// the middle of a batch when the node shuts down, so that it need not wait for the rest.
void answer(const CastRayRequest& request, Context& context, CastRayResponse& response);
void answer(const CastRaysRequest& request, Context& context, CastRaysResponse& response);
void answer(const CheckSegmentRequest& request, Context& context, CheckSegmentResponse& response);
void answer(const CheckSegmentsRequest& request, Context& context, CheckSegmentsResponse& response);
void answer(const FindIntersectionsRequest& request, Context& context,
            FindIntersectionsResponse& response);
void answer(const GetSceneRequest& request, const Snapshot& snapshot, const ros::Time& now,
            GetSceneResponse& response);

/// A response that answers nothing: every number undefined, every array empty.
template <class Response>
Response nothing() {
  return Response();
}
template <>
CastRayResponse nothing();
template <>
CheckSegmentResponse nothing();
template <>
CheckSegmentsResponse nothing();

/// The part that all responses share: the scene, its age, and whether it is complete as far as it
/// matters to the request.
template <class Request, class Response>
void describeScene(const Request& request, const Snapshot& snapshot, const ros::Time& now,
                   Response& response) {
  const Completeness completeness = completenessOf(BoxFilter(request), snapshot, now);
  response.scene_id = snapshot.id;
  response.scene_age = snapshot.age(now);
  response.complete = completeness.complete;
  response.reason = completeness.reason;
  if constexpr (std::is_same_v<Response, GetSceneResponse>) {
    response.header.stamp = snapshot.stamp;
    response.header.frame_id = snapshot.frame;
  } else {
    response.scene_stamp = snapshot.stamp;
  }
}

}  // namespace box_query
