// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What clients ask: every request follows from a seed and from the time at which it is made.
#pragma once

#include "load/messages.h"

#include <box_query/CastRay.h>
#include <box_query/CastRays.h>
#include <box_query/CheckSegment.h>
#include <box_query/CheckSegments.h>
#include <box_query/FindIntersections.h>
#include <box_query/GetScene.h>

#include <array>
#include <cstdint>
#include <string>
#include <variant>

namespace box_query::load {

using Request = std::variant<CastRayRequest, CastRaysRequest, CheckSegmentRequest,
                             CheckSegmentsRequest, FindIntersectionsRequest, GetSceneRequest>;
/// In the order of Request: the name and the checksum of the service.
struct ServiceName {
  const char* name;
  const char* md5;
};
constexpr std::size_t kServices = std::variant_size_v<Request>;
const std::array<ServiceName, kServices>& services();

/// Mostly single rays and segments, some batches, rarely whole scenes; in the fixed frame and in
/// moving ones, at stamps that tf knows or, now and then, only just comes to know; some with
/// filters.
Request questionOf(std::uint64_t seed, Tick now);

Bytes bytesOf(const Request& request);

}  // namespace box_query::load
