// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the node answers about a dragged ray or segment, as markers.
#pragma once

#include <box_query/CastRay.h>
#include <box_query/CheckSegment.h>

#include <string>
#include <vector>

#include <visualization_msgs/Marker.h>

namespace box_query {

/// The ray to its hit, or `miss_length` [m] of it; hit, normal, and range in words. In the frame of
/// the request, until they are replaced.
std::vector<visualization_msgs::Marker> probeMarkers(const CastRayRequest& request,
                                                     const CastRayResponse& response,
                                                     double miss_length);

/// The segment, the closest points, and the clearance in words.
std::vector<visualization_msgs::Marker> probeMarkers(const CheckSegmentRequest& request,
                                                     const CheckSegmentResponse& response);

/// Instead of an answer, what to do to get one.
std::vector<visualization_msgs::Marker> probeMarkers(const std::string& frame,
                                                     const std::string& problem);

}  // namespace box_query
