// SPDX-License-Identifier: BSD-3-Clause
#include "load/check_exact.h"

#include "reference/oracle.h"
#include "ros/conversions.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace box_query::load {
namespace {

/// Of a batch.
constexpr std::size_t kFirst = 3;
/// [m] More than double arithmetic errs in a scene of this size.
constexpr double kSlack = 1e-6;

template <class Values, class Value>
bool contains(const Values& values, const Value& value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

/// Whether a request looks at a box, by the words of the .srv files.
template <class Request>
bool looksAt(const Request& request, const BoxName& name) {
  const auto open = [](const auto& values, const std::string& value) {
    return values.empty() || contains(values, value);
  };
  for (std::size_t i = 0; i < request.ignore_ids.size(); ++i) {
    if (request.ignore_topics[i] == name.topic && request.ignore_namespaces[i] == name.ns &&
        request.ignore_ids[i] == name.id) {
      return false;
    }
  }
  return open(request.topics, name.topic) && open(request.namespaces, name.ns) &&
         open(request.labels, name.label);
}

double distanceToSegment(const Vector3& point, const Segment& segment) {
  const Vector3 way = segment.end - segment.start;
  const double squared = way.squaredNorm();
  const double t = squared > 0.0 ? (point - segment.start).dot(way) / squared : 0.0;
  return (segment.start + std::min(std::max(t, 0.0), 1.0) * way - point).norm();
}

double distanceToLine(const Vector3& point, const Vector3& origin, const Vector3& direction) {
  const Vector3 unit = direction.normalized();
  const Vector3 offset = point - origin;
  return (offset - offset.dot(unit) * unit).norm();
}

/// One request and the scene. Boxes that are far away by their spheres are not given to the oracle.
template <class Request>
class Exact {
 public:
  Exact(const Request& request, const Snapshot& snapshot) : request_(request), snapshot_(snapshot) {
    if (request.header.frame_id != kFixedFrame) {
      const Pose pose = poseAt(request.header.frame_id, tickAt(request.header.stamp));
      rotation_ = pose.rotation;
      translation_ = pose.translation;
    }
  }

  Vector3 point(const geometry_msgs::Point& given) const {
    return rotation_ * fromMessage(given) + translation_;
  }
  Vector3 way(const geometry_msgs::Vector3& given) const { return rotation_ * fromMessage(given); }

  const OrientedBox& box(std::size_t i) const {
    return std::get<OrientedBox>(snapshot_.scene.boxes()[i]);
  }
  double radius(std::size_t i) const { return box(i).half_extents.norm() * 1.02; }
  const BoxName& name(std::size_t i) const { return snapshot_.names[i]; }

  template <class IsNear>
  std::vector<std::size_t> boxesThatAre(const IsNear& is_near) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < snapshot_.names.size(); ++i) {
      if (is_near(i) && looksAt(request_, snapshot_.names[i])) {
        found.push_back(i);
      }
    }
    return found;
  }
  std::vector<std::size_t> boxesNear(const Vector3& origin, const Vector3& direction) const {
    return boxesThatAre([&](std::size_t i) {
      return distanceToLine(box(i).center, origin, direction) <= radius(i) + kSlack;
    });
  }

 private:
  const Request& request_;
  const Snapshot& snapshot_;
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();
  Vector3 translation_ = Vector3::Zero();
};

struct FirstHit {
  std::size_t box = kNoBox;
  oracle::Interval interval;
};

template <class Request>
FirstHit firstHit(const Exact<Request>& exact, const Ray& ray, double max_range) {
  const oracle::ExactComponent component(ray);
  FirstHit first;
  for (const std::size_t i : exact.boxesNear(ray.origin, ray.direction)) {
    const oracle::Interval interval = oracle::interval(component, exact.box(i));
    if (interval.hit() &&
        (first.box == kNoBox || compare(interval.enter, first.interval.enter) < 0)) {
      first = {i, interval};
    }
  }
  if (first.box != kNoBox && max_range != 0 &&
      compare(oracle::squaredRange(first.interval.enter.value, component),
              oracle::Fraction{oracle::square(max_range), 1.0}) > 0) {
    return {};
  }
  return first;
}

bool isRange(double got, const FirstHit& first, const Ray& ray) {
  return first.box == kNoBox ? got == kInf
                             : oracle::isCorrectlyRoundedSqrt(
                                   got, oracle::squaredRange(first.interval.enter.value, ray));
}

template <class Response>
bool isNamed(const Response& response, std::int32_t index, std::size_t box,
             const Snapshot& snapshot) {
  if (index < 0 || box == kNoBox) {
    return index < 0 && box == kNoBox;
  }
  const auto place = static_cast<std::size_t>(index);
  const BoxName& name = snapshot.names[box];
  return response.box_topics[place] == name.topic && response.box_namespaces[place] == name.ns &&
         response.box_ids[place] == name.id;
}

/// The nearest box of a segment and the one that blocks it first.
struct SegmentTruth {
  std::size_t nearest = kNoBox;
  oracle::Nearest distance;
  std::size_t blocking = kNoBox;
  std::optional<oracle::Root> blocked_at;
};

template <class Request>
SegmentTruth truthOf(const Exact<Request>& exact, const Segment& segment, double radius) {
  double reach = kInf;  // of the nearest box: its center is in it
  for (const std::size_t i : exact.boxesThatAre([](std::size_t /*i*/) { return true; })) {
    reach = std::min(reach, distanceToSegment(exact.box(i).center, segment));
  }
  reach = std::max(reach, radius) + kSlack;
  const oracle::ExactComponent component(segment);
  SegmentTruth truth;
  for (const std::size_t i : exact.boxesThatAre([&](std::size_t each) {
         return distanceToSegment(exact.box(each).center, segment) - exact.radius(each) <= reach;
       })) {
    const oracle::ExactBox box(exact.box(i));
    const oracle::Nearest distance = oracle::nearest(component, box);
    if (truth.nearest == kNoBox || distance.squared < truth.distance.squared) {
      truth.nearest = i;
      truth.distance = distance;
    }
    const auto root = oracle::firstWithin(component, box, radius, distance);
    if (root && (!truth.blocked_at || compare(*root, *truth.blocked_at) < 0)) {
      truth.blocked_at = root;
      truth.blocking = i;
    }
  }
  return truth;
}

bool isClearance(double got, const SegmentTruth& truth) {
  return truth.nearest == kNoBox ? got == kInf
                                 : oracle::isCorrectlyRoundedSqrt(got, truth.distance.squared);
}

/// The largest double that is not behind the exact place; without a radius the nearest one.
bool isBlockedAt(double got, const SegmentTruth& truth, double radius) {
  if (!truth.blocked_at) {
    return got == kInf;
  }
  const auto is_just_before = [&truth](double t) {
    const int steps = oracle::stepsBefore(t, *truth.blocked_at, 4);
    return steps == 0 || steps == 1;
  };
  return is_just_before(got) || (radius == 0 && is_just_before(std::nextafter(got, -1.0)));
}

}  // namespace

std::string differenceFromExact(const CastRayRequest& request, const CastRayResponse& response,
                                const Snapshot& snapshot) {
  const Exact<CastRayRequest> exact(request, snapshot);
  const Ray ray = {exact.point(request.origin), exact.way(request.direction)};
  const FirstHit first = firstHit(exact, ray, request.max_range);
  if (response.hit != (first.box != kNoBox)) {
    return "hit";
  }
  if (!isRange(response.range, first, ray)) {
    return "range";
  }
  if (first.box == kNoBox) {
    return "";
  }
  const BoxName& name = snapshot.names[first.box];
  if (response.box_topic != name.topic || response.box_namespace != name.ns ||
      response.box_id != name.id) {
    return "box";
  }
  if (!oracle::isCorrectlyRoundedSqrt(response.exit_range,
                                      oracle::squaredRange(first.interval.exit.value, ray))) {
    return "exit_range";
  }
  return response.started_inside == first.interval.started_inside ? "" : "started_inside";
}

std::string differenceFromExact(const CastRaysRequest& request, const CastRaysResponse& response,
                                const Snapshot& snapshot) {
  const Exact<CastRaysRequest> exact(request, snapshot);
  if (response.hits.size() != request.directions.size()) {
    return "hits are too many or too few";
  }
  for (std::size_t i = 0; i < std::min(kFirst, response.hits.size()); ++i) {
    const Ray ray = {exact.point(request.origins[0]), exact.way(request.directions[i])};
    const FirstHit first = firstHit(exact, ray, request.max_ranges[0]);
    if ((response.hits[i] != 0) != (first.box != kNoBox)) {
      return "hits";
    }
    if (request.mode == CastRaysRequest::CLOSEST && !isRange(response.ranges[i], first, ray)) {
      return "ranges";
    }
    if (!response.boxes.empty() && !isNamed(response, response.boxes[i], first.box, snapshot)) {
      return "boxes";
    }
  }
  return "";
}

std::string differenceFromExact(const CheckSegmentRequest& request,
                                const CheckSegmentResponse& response, const Snapshot& snapshot) {
  const Exact<CheckSegmentRequest> exact(request, snapshot);
  const Segment segment = {exact.point(request.start), exact.point(request.end)};
  const SegmentTruth truth = truthOf(exact, segment, request.radius);
  if (response.blocked != truth.blocked_at.has_value()) {
    return "blocked";
  }
  if (response.clear != (!response.blocked && (response.complete || request.allow_incomplete))) {
    return "clear";
  }
  if (!isClearance(response.clearance, truth)) {
    return "clearance";
  }
  if (!isBlockedAt(response.blocked_at, truth, request.radius)) {
    return "blocked_at";
  }
  if (truth.nearest != kNoBox && (response.nearest_topic != snapshot.names[truth.nearest].topic ||
                                  response.nearest_id != snapshot.names[truth.nearest].id)) {
    return "nearest box";
  }
  if (truth.blocking != kNoBox &&
      (response.blocking_topic != snapshot.names[truth.blocking].topic ||
       response.blocking_id != snapshot.names[truth.blocking].id)) {
    return "blocking box";
  }
  return "";
}

std::string differenceFromExact(const CheckSegmentsRequest& request,
                                const CheckSegmentsResponse& response, const Snapshot& snapshot) {
  const Exact<CheckSegmentsRequest> exact(request, snapshot);
  const std::size_t step = request.shape == CheckSegmentsRequest::PATH ? 1 : 2;
  for (std::size_t i = 0; i < std::min(kFirst, response.states.size()); ++i) {
    const bool evaluated = response.states[i] != CheckSegmentsResponse::NOT_EVALUATED;
    if (!evaluated) {
      return i > 0 && response.first_blocked >= 0 ? "" : "states";
    }
    const Segment segment = {exact.point(request.points[step * i]),
                             exact.point(request.points[step * i + 1])};
    const SegmentTruth truth = truthOf(exact, segment, request.radii[0]);
    const std::uint8_t state = truth.blocked_at ? CheckSegmentsResponse::BLOCKED
                               : response.complete || request.allow_incomplete
                                   ? CheckSegmentsResponse::CLEAR
                                   : CheckSegmentsResponse::UNKNOWN;
    if (response.states[i] != state) {
      return "states";
    }
    if (request.want_clearances && !isClearance(response.clearances[i], truth)) {
      return "clearances";
    }
    if (request.want_blocked_at && !isBlockedAt(response.blocked_at[i], truth, request.radii[0])) {
      return "blocked_at";
    }
    if (request.want_boxes &&
        (!isNamed(response, response.nearest_boxes[i], truth.nearest, snapshot) ||
         !isNamed(response, response.blocking_boxes[i], truth.blocking, snapshot))) {
      return "boxes";
    }
  }
  return "";
}

std::string differenceFromExact(const FindIntersectionsRequest& request,
                                const FindIntersectionsResponse& response,
                                const Snapshot& snapshot) {
  const Exact<FindIntersectionsRequest> exact(request, snapshot);
  const Vector3 origin = exact.point(request.origin);
  const bool is_segment = request.component == FindIntersectionsRequest::SEGMENT;
  const Vector3 end = exact.point(request.end);
  const Vector3 direction = is_segment ? Vector3(end - origin) : exact.way(request.direction);
  const oracle::ExactComponent component = is_segment ? oracle::ExactComponent(Segment{origin, end})
                                           : request.component == FindIntersectionsRequest::RAY
                                               ? oracle::ExactComponent(Ray{origin, direction})
                                               : oracle::ExactComponent(Line{origin, direction});
  std::vector<std::pair<std::size_t, oracle::Interval>> met;
  const auto near = direction.isZero() ? exact.boxesThatAre([](std::size_t /*i*/) { return true; })
                                       : exact.boxesNear(origin, direction);
  for (const std::size_t i : near) {
    const oracle::Interval interval = oracle::interval(component, exact.box(i));
    if (interval.hit()) {
      met.emplace_back(i, interval);
    }
  }
  std::stable_sort(met.begin(), met.end(), [](const auto& a, const auto& b) {
    return compare(a.second.enter, b.second.enter) < 0;
  });
  if (met.size() != response.t_enter.size()) {
    return "number of boxes";
  }
  for (std::size_t k = 0; k < met.size(); ++k) {
    const oracle::Interval& interval = met[k].second;
    if (!isNamed(response, static_cast<std::int32_t>(k), met[k].first, snapshot)) {
      return "boxes";
    }
    if (response.num_points[k] != interval.num_points ||
        !oracle::isCorrectlyRounded(response.t_enter[k], interval.enter) ||
        !oracle::isCorrectlyRounded(response.t_exit[k], interval.exit) ||
        FaceSet(response.faces_entered[k]) != interval.entered ||
        FaceSet(response.faces_left[k]) != interval.left ||
        (response.started_inside[k] != 0) != interval.started_inside) {
      return "intersection " + std::to_string(k);
    }
  }
  return "";
}

std::string differenceFromExact(const GetSceneRequest& request, const GetSceneResponse& response,
                                const Snapshot& snapshot) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < snapshot.names.size(); ++i) {
    if (!looksAt(request, snapshot.names[i])) {
      continue;
    }
    if (next == response.poses.size() || response.box_topics[next] != snapshot.names[i].topic ||
        response.box_namespaces[next] != snapshot.names[i].ns ||
        response.box_ids[next] != snapshot.names[i].id ||
        response.stamps[next] != snapshot.stamps[i]) {
      return "boxes";
    }
    ++next;
  }
  return next == response.poses.size() ? "" : "boxes";
}

}  // namespace box_query::load
