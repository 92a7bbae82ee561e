// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Answers of the services against the oracle, box by box.
#pragma once

#include "load/questions.h"

#include <box_query/ros/scene_monitor.h>

#include <string>

namespace box_query::load {

/// What is wrong in an answer from the snapshot; empty if nothing is. Of a batch the first few are
/// looked at. Not checked: points and normals, which are no exact numbers, and names of boxes other
/// than those that were met first or are nearest.
std::string differenceFromExact(const CastRayRequest& request, const CastRayResponse& response,
                                const Snapshot& snapshot);
std::string differenceFromExact(const CastRaysRequest& request, const CastRaysResponse& response,
                                const Snapshot& snapshot);
std::string differenceFromExact(const CheckSegmentRequest& request,
                                const CheckSegmentResponse& response, const Snapshot& snapshot);
std::string differenceFromExact(const CheckSegmentsRequest& request,
                                const CheckSegmentsResponse& response, const Snapshot& snapshot);
std::string differenceFromExact(const FindIntersectionsRequest& request,
                                const FindIntersectionsResponse& response,
                                const Snapshot& snapshot);
std::string differenceFromExact(const GetSceneRequest& request, const GetSceneResponse& response,
                                const Snapshot& snapshot);

}  // namespace box_query::load
