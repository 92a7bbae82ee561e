// SPDX-License-Identifier: BSD-3-Clause
#include "reference/scene_queries.h"

#include "reference/oracle.h"

#include <algorithm>
#include <cmath>

namespace box_query::reference {
namespace {

/// a + b is a double.
bool sumIsExact(double a, double b) {
  const double sum = a + b;
  return sum - a == b && sum - b == a;
}

}  // namespace

SceneQueries::SceneQueries(const std::vector<OrientedBox>& boxes, Sampler& sampler)
    : boxes_(boxes), sampler_(sampler), low_(boxes[0].center), high_(boxes[0].center) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double radius = boxes[i].half_extents.norm();
    low_ = low_.cwiseMin(boxes[i].center - Vector3::Constant(radius));
    high_ = high_.cwiseMax(boxes[i].center + Vector3::Constant(radius));
    for (int axis = 0; axis < 3; ++axis) {
      addFaces(i, axis);
    }
  }
  std::stable_sort(faces_.begin(), faces_.end(), [](const Face& a, const Face& b) {
    return a.exact + a.aligned > b.exact + b.aligned;
  });
  for (const Face& face : faces_) {
    exact_faces_ += face.exact;
    aligned_faces_ += face.aligned;
  }
}

void SceneQueries::addFaces(std::size_t box, int box_axis) {
  const oracle::ExactBox exact(boxes_[box]);
  const Vector3 direction = boxes_[box].orientation * Vector3::Unit(box_axis);
  Face face;
  face.box = box;
  face.box_axis = box_axis;
  direction.cwiseAbs().maxCoeff(&face.axis);
  face.aligned = true;
  for (int axis = 0; axis < 3; ++axis) {
    const oracle::Dyadic& component =
        exact.columns[static_cast<std::size_t>(box_axis)][static_cast<std::size_t>(axis)];
    face.aligned = face.aligned && (axis == face.axis || component.sign() == 0);
  }
  const double center = boxes_[box].center[face.axis];
  for (const double side : {-1.0, 1.0}) {
    const double extent = side * boxes_[box].half_extents[box_axis];
    face.side = side;
    face.plane = center + extent;
    face.exact = face.aligned && sumIsExact(center, extent);
    faces_.push_back(face);
  }
}

const SceneQueries::Face& SceneQueries::anyFace() {
  const int all = static_cast<int>(faces_.size());
  const int count = exact_faces_ > 0 ? exact_faces_ : (aligned_faces_ > 0 ? aligned_faces_ : all);
  return faces_[static_cast<std::size_t>(sampler_.index(count))];
}

Vector3 SceneQueries::pointInBox(std::size_t box) {
  const Vector3 y = boxes_[box].half_extents.cwiseProduct(sampler_.vector(-1.0, 1.0));
  return boxes_[box].center + boxes_[box].orientation * y;
}

Vector3 SceneQueries::pointNearScene() {
  return (low_ + (high_ - low_).cwiseProduct(sampler_.vector(-0.3, 1.3))).eval();
}

Vector3 SceneQueries::pointOnFace(const Face& face) {
  const OrientedBox& box = boxes_[face.box];
  const Vector3 outward = box.orientation * Vector3::Unit(face.box_axis);
  Vector3 y = 0.9 * box.half_extents.cwiseProduct(sampler_.vector(-1.0, 1.0));
  y[face.box_axis] =
      box.half_extents[face.box_axis] * (outward[face.axis] * face.side > 0.0 ? 1.0 : -1.0);
  Vector3 point = box.center + box.orientation * y;
  if (face.aligned) {
    point[face.axis] = face.plane;
  }
  return point;
}

Vector3 SceneQueries::alongFace(const Face& face) {
  Vector3 y = sampler_.direction();
  y[face.box_axis] = 0.0;
  Vector3 along = boxes_[face.box].orientation * y;
  if (face.aligned) {
    along[face.axis] = 0.0;
  }
  return along;
}

RayQuery SceneQueries::randomRay() {
  RayQuery query;
  query.ray.origin = pointNearScene();
  const auto box = static_cast<std::size_t>(sampler_.index(static_cast<int>(boxes_.size())));
  query.ray.direction =
      sampler_.chance(0.5) ? Vector3(pointInBox(box) - query.ray.origin) : sampler_.direction();
  if (sampler_.chance(1.0 / 3.0)) {
    query.max_range = sampler_.uniform(0.0, (high_ - low_).norm());
  }
  return query;
}

SegmentQuery SceneQueries::randomSegment() {
  SegmentQuery query;
  query.segment.start = pointNearScene();
  const double length = sampler_.chance(0.5) ? 1.0 : sampler_.uniform(0.0, 0.3);
  query.segment.end = query.segment.start + length * (pointNearScene() - query.segment.start);
  if (sampler_.chance(0.1)) {
    query.segment.end = query.segment.start;
  }
  query.radius = sampler_.chance(0.5) ? 0.0 : sampler_.uniform(0.0, 0.3);
  return query;
}

RayQuery SceneQueries::touchingRay(int n) {
  const Face& face = anyFace();
  RayQuery query;
  const Vector3 point = pointOnFace(face);
  Vector3 outward = Vector3::Zero();
  outward[face.axis] = face.side;
  switch (n % 4) {
    case 0:
      query.ray.direction = alongFace(face);
      query.ray.origin = point - 4.0 * query.ray.direction;
      break;
    case 1:
      query.ray = {point, sampler_.direction()};
      query.ray.direction[face.axis] = face.side * std::abs(query.ray.direction[face.axis]);
      break;
    default: {
      // Near enough for the range to be an exact difference.
      const double height = face.plane == 0.0 ? 0.25 : std::min(0.25, std::abs(face.plane) / 2.0);
      query.ray = {point + height * outward, -outward};
      query.max_range = std::abs(query.ray.origin[face.axis] - face.plane);
      if (n % 4 == 3) {
        query.max_range = std::nextafter(query.max_range, 0.0);
      }
    }
  }
  return query;
}

SegmentQuery SceneQueries::touchingSegment(int n) {
  const Face& face = anyFace();
  SegmentQuery query;
  const Vector3 point = pointOnFace(face);
  const Vector3 along = alongFace(face);
  Vector3 outward = Vector3::Zero();
  outward[face.axis] = face.side;
  switch (n % 4) {
    case 0:
      query.segment = {point - 4.0 * along, point + 4.0 * along};
      break;
    case 1:
      query.segment = {point + outward + along, point};
      break;
    case 2:
      query.segment = {point, point};
      break;
    default: {
      const Vector3 above = point + sampler_.uniform(0.0, 0.03) * outward;
      query.segment = {above, above + 0.01 * along};
      const OrientedBox& box = boxes_[face.box];
      query.radius =
          std::abs(above[face.axis] - box.center[face.axis]) - box.half_extents[face.box_axis];
      query.radius = std::max(query.radius, 0.0);
      if (n % 8 == 7) {
        query.radius = std::nextafter(query.radius, 0.0);
      }
    }
  }
  return query;
}

}  // namespace box_query::reference
