// SPDX-License-Identifier: BSD-3-Clause
#include "load/questions.h"

#include "ros/conversions.h"

#include <random>

namespace box_query::load {
namespace {

constexpr int kRays = 32;
constexpr int kSegments = 16;

/// Draws what goes into requests: coordinates are multiples of 1/64 m.
class Draw {
 public:
  Draw(std::uint64_t seed, Tick now)
      : random_(static_cast<unsigned>(seed ^ (seed >> 32))), now_(now) {}

  int upTo(int most) { return std::uniform_int_distribution<int>(0, most)(random_); }
  bool oneIn(int n) { return upTo(n - 1) == 0; }
  double coordinate(int most) {
    return std::uniform_int_distribution<int>(-64 * most, 64 * most)(random_) / 64.0;
  }

  geometry_msgs::Point point() { return toPoint({coordinate(44), coordinate(44), coordinate(4)}); }
  geometry_msgs::Point near(const geometry_msgs::Point& from) {
    return toPoint(fromMessage(from) + Vector3(coordinate(3), coordinate(3), coordinate(1)));
  }
  geometry_msgs::Vector3 direction() {
    Vector3 way(coordinate(2), coordinate(2), coordinate(1));
    if (way.isZero()) {
      way.x() = 1.0;
    }
    return toVector3(way);
  }
  double range() { return oneIn(3) ? 0.0 : 5.0 + upTo(40); }
  double radius() { return oneIn(3) ? 0.0 : upTo(32) / 32.0; }

  /// Half of them in the fixed frame. Of the others one in fifty has a stamp whose transform is
  /// only on its way.
  std_msgs::Header header() {
    std_msgs::Header header;
    const int kind = upTo(5);
    header.frame_id = kind < 3 ? kFixedFrame : kind == 3 ? kRobot : kind == 4 ? kCart : kLidar;
    header.stamp = timeOf(oneIn(50) ? now_ : now_ - kTicksPerSecond / 2 - upTo(kTicksPerSecond));
    return header;
  }

  template <class Request>
  Request start() {
    Request request;
    request.header = header();
    request.allow_incomplete = oneIn(2);
    filter(request);
    return request;
  }

  /// One in eight looks at some boxes only.
  template <class Request>
  void filter(Request& request) {
    if (!oneIn(8)) {
      return;
    }
    if (oneIn(2)) {
      request.topics = {topics()[static_cast<std::size_t>(upTo(9))].name, topics()[0].name};
      request.namespaces = {"pallet", "1", "CAR", "list"};
    } else {
      request.ignore_topics = {topics()[static_cast<std::size_t>(upTo(9))].name, topics()[0].name};
      request.ignore_namespaces = {"rack", "pallet"};
      request.ignore_ids = {upTo(999), upTo(999)};
    }
  }

 private:
  std::mt19937 random_;
  Tick now_;
};

CastRayRequest castRay(Draw& draw) {
  auto request = draw.start<CastRayRequest>();
  request.origin = draw.point();
  request.direction = draw.direction();
  request.max_range = draw.range();
  return request;
}

CastRaysRequest castRays(Draw& draw) {
  auto request = draw.start<CastRaysRequest>();
  request.mode = draw.oneIn(3) ? CastRaysRequest::ANY : CastRaysRequest::CLOSEST;
  request.origins.push_back(draw.point());
  request.max_ranges.push_back(draw.range());
  for (int i = 0; i < kRays; ++i) {
    request.directions.push_back(draw.direction());
  }
  request.want_exits = draw.oneIn(2);
  request.want_points = draw.oneIn(2);
  request.want_normals = draw.oneIn(2);
  request.want_boxes = draw.oneIn(2);
  return request;
}

CheckSegmentRequest checkSegment(Draw& draw) {
  auto request = draw.start<CheckSegmentRequest>();
  request.start = draw.point();
  request.end = draw.near(request.start);
  request.radius = draw.radius();
  return request;
}

CheckSegmentsRequest checkSegments(Draw& draw) {
  auto request = draw.start<CheckSegmentsRequest>();
  request.shape = draw.oneIn(2) ? CheckSegmentsRequest::PATH : CheckSegmentsRequest::PAIRS;
  request.points.push_back(draw.point());
  const int points = request.shape == CheckSegmentsRequest::PATH ? kSegments + 1 : 2 * kSegments;
  while (static_cast<int>(request.points.size()) < points) {
    request.points.push_back(draw.near(request.points.back()));
  }
  request.radii.push_back(draw.radius());
  request.stop_at_blocked = draw.oneIn(4);
  request.want_clearances = draw.oneIn(2);
  request.want_points = draw.oneIn(2);
  request.want_blocked_at = draw.oneIn(2);
  request.want_boxes = draw.oneIn(2);
  return request;
}

FindIntersectionsRequest findIntersections(Draw& draw) {
  auto request = draw.start<FindIntersectionsRequest>();
  request.component = static_cast<std::uint8_t>(draw.upTo(2));
  request.origin = draw.point();
  request.direction = draw.direction();
  request.end = draw.near(request.origin);
  return request;
}

GetSceneRequest getScene(Draw& draw) {
  GetSceneRequest request;
  if (!draw.oneIn(10)) {
    request.topics = {topics()[static_cast<std::size_t>(draw.upTo(9))].name};
  }
  return request;
}

template <class Service>
ServiceName nameOf(const char* name) {
  return {name, ros::service_traits::md5sum<Service>()};
}

}  // namespace

const std::array<ServiceName, kServices>& services() {
  static const std::array<ServiceName, kServices> all = {
      nameOf<CastRay>("cast_ray"),
      nameOf<CastRays>("cast_rays"),
      nameOf<CheckSegment>("check_segment"),
      nameOf<CheckSegments>("check_segments"),
      nameOf<FindIntersections>("find_intersections"),
      nameOf<GetScene>("get_scene")};
  return all;
}

Request questionOf(std::uint64_t seed, Tick now) {
  Draw draw(seed, now);
  const int kind = draw.upTo(999);
  if (kind < 300) {
    return castRay(draw);
  }
  if (kind < 450) {
    return castRays(draw);
  }
  if (kind < 700) {
    return checkSegment(draw);
  }
  if (kind < 800) {
    return checkSegments(draw);
  }
  if (kind < 998) {
    return findIntersections(draw);
  }
  return getScene(draw);
}

Bytes bytesOf(const Request& request) {
  return std::visit([](const auto& each) { return load::bytesOf(each); }, request);
}

}  // namespace box_query::load
