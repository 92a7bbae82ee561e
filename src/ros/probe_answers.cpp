// SPDX-License-Identifier: BSD-3-Clause
#include "ros/probe_answers.h"

#include "ros/conversions.h"
#include "ros/drawing.h"
#include "ros/marker_shapes.h"

#include <iomanip>
#include <sstream>

namespace box_query {
namespace {

using visualization_msgs::Marker;

const Vector3 kTextOffset(0, 0, 0.25);  // [m]

/// A length in metres and millimetres, and whose it is.
std::string describe(const std::string& what, double length, const std::string& ns, std::int64_t id,
                     const std::string& label) {
  std::ostringstream text;
  text << what << " " << std::fixed << std::setprecision(3) << length << " m, "
       << (label.empty() ? ns + "/" + std::to_string(id) : label);
  return text.str();
}

std::vector<Marker> drawn(const DrawnQuery& query, const std::string& frame, const char* ns,
                          const std::string& words, const Vector3& at) {
  std::vector<Marker> markers = queryMarkers({query}, frame, 0.0, 0);
  markers.push_back(textMarker(frame, {ns, 0}, words, at + kTextOffset));
  return markers;
}

}  // namespace

std::vector<Marker> probeMarkers(const CastRayRequest& request, const CastRayResponse& response,
                                 double miss_length) {
  const Vector3 direction = fromMessage(request.direction);
  DrawnQuery ray;
  ray.kind = DrawnQuery::Kind::kRay;
  ray.start = fromMessage(request.origin);
  std::string words;
  if (response.hit) {
    ray.outcome = Outcome::kMet;
    ray.end = ray.hit = fromMessage(response.point);
    ray.normal = fromMessage(response.normal);
    words = describe("range", response.range, response.box_namespace, response.box_id,
                     response.box_label);
  } else {
    ray.outcome = response.complete ? Outcome::kFree : Outcome::kUnknown;
    ray.end = ray.start + miss_length * direction.normalized();
    words = response.complete ? "hits nothing" : "hits nothing that is known";
  }
  return drawn(ray, request.header.frame_id, "ray_text", words,
               response.hit ? ray.hit : Vector3(ray.start + direction));
}

std::vector<Marker> probeMarkers(const CheckSegmentRequest& request,
                                 const CheckSegmentResponse& response) {
  DrawnQuery segment;
  segment.kind = DrawnQuery::Kind::kSegment;
  segment.start = fromMessage(request.start);
  segment.end = fromMessage(request.end);
  segment.outcome = response.blocked ? Outcome::kMet
                    : response.clear ? Outcome::kFree
                                     : Outcome::kUnknown;
  segment.on_segment = fromMessage(response.point_on_segment);
  segment.on_box = fromMessage(response.point_on_box);
  const bool is_near = segment.on_box.allFinite();
  const Vector3 middle = is_near ? Vector3(0.5 * (segment.on_segment + segment.on_box))
                                 : Vector3(0.5 * (segment.start + segment.end));
  return drawn(segment, request.header.frame_id, "segment_text",
               is_near ? describe("clearance", response.clearance, response.nearest_namespace,
                                  response.nearest_id, response.nearest_label)
                       : "no box is known",
               middle);
}

std::vector<Marker> probeMarkers(const std::string& frame, const std::string& problem) {
  return {textMarker(frame, {"problem", 0}, problem, kTextOffset)};
}

}  // namespace box_query
