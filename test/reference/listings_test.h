// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Listings 1 to 6 of D. Eberly, "Intersection of a Line and a Box" (Geometric Tools, 2018, CC BY
/// 4.0): the test-intersection queries, by the method of separating axes. See listings.h.
#pragma once

#include "reference/listing_types.h"

namespace box_query::listings {

namespace listing1 {

/// Line and oriented box, in the frame of the world.
inline bool testIntersection(const Line& line, const OrientedBox3& box) {
  const Vector3 PmC = line.origin - box.C;
  const Vector3 DxPmC = line.direction.cross(PmC);
  double ADdU[3];

  ADdU[1] = std::abs(line.direction.dot(box.U[1]));
  ADdU[2] = std::abs(line.direction.dot(box.U[2]));
  if (std::abs(DxPmC.dot(box.U[0])) > box.e[1] * ADdU[2] + box.e[2] * ADdU[1]) {
    return false;
  }
  ADdU[0] = std::abs(line.direction.dot(box.U[0]));
  if (std::abs(DxPmC.dot(box.U[1])) > box.e[0] * ADdU[2] + box.e[2] * ADdU[0]) {
    return false;
  }
  return !(std::abs(DxPmC.dot(box.U[2])) > box.e[0] * ADdU[1] + box.e[1] * ADdU[0]);
}

}  // namespace listing1

namespace listing2 {

/// Line and box, in the frame of the box.
inline bool doLineQuery(const Vector3& P, const Vector3& D, const Vector3& e) {
  const Vector3 DxP = D.cross(P);
  if (std::abs(DxP[0]) > e[1] * std::abs(D[2]) + e[2] * std::abs(D[1])) {
    return false;
  }
  if (std::abs(DxP[1]) > e[0] * std::abs(D[2]) + e[2] * std::abs(D[0])) {
    return false;
  }
  return !(std::abs(DxP[2]) > e[0] * std::abs(D[1]) + e[1] * std::abs(D[0]));
}

inline bool testIntersection(const Line& line, const AlignedBox& box) {
  const Vector3 C = (box.max + box.min) / 2.0;
  const Vector3 e = (box.max - box.min) / 2.0;
  return doLineQuery(line.origin - C, line.direction, e);
}

inline bool testIntersection(const Line& line, const OrientedBox3& box) {
  return doLineQuery(alongAxes(line.origin - box.C, box), alongAxes(line.direction, box), box.e);
}

}  // namespace listing2

namespace listing3 {

/// Ray and oriented box, in the frame of the world.
///
/// The text of section 2.2 asks for a product > 0 where equation (2) and the listing have >= 0; the
/// listing is right, and as printed.
inline bool testIntersection(const Ray& ray, const OrientedBox3& box) {
  const Vector3 PmC = ray.origin - box.C;
  double ADdU[3];
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const double DdU = ray.direction.dot(box.U[axis]);
    const double PmCdU = PmC.dot(box.U[axis]);
    ADdU[i] = std::abs(DdU);
    if (std::abs(PmCdU) > box.e[i] && PmCdU * DdU >= 0.0) {
      return false;
    }
  }
  const Vector3 DxPmC = ray.direction.cross(PmC);
  if (std::abs(DxPmC.dot(box.U[0])) > box.e[1] * ADdU[2] + box.e[2] * ADdU[1]) {
    return false;
  }
  if (std::abs(DxPmC.dot(box.U[1])) > box.e[0] * ADdU[2] + box.e[2] * ADdU[0]) {
    return false;
  }
  return !(std::abs(DxPmC.dot(box.U[2])) > box.e[0] * ADdU[1] + box.e[1] * ADdU[0]);
}

}  // namespace listing3

namespace listing4 {

/// Ray and box, in the frame of the box.
inline bool doRayQuery(const Vector3& P, const Vector3& D, const Vector3& e) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(P[i]) > e[i] && P[i] * D[i] >= 0.0) {
      return false;
    }
  }
  return listing2::doLineQuery(P, D, e);
}

inline bool testIntersection(const Ray& ray, const AlignedBox& box) {
  const Vector3 C = (box.max + box.min) / 2.0;
  const Vector3 e = (box.max - box.min) / 2.0;
  return doRayQuery(ray.origin - C, ray.direction, e);
}

inline bool testIntersection(const Ray& ray, const OrientedBox3& box) {
  return doRayQuery(alongAxes(ray.origin - box.C, box), alongAxes(ray.direction, box), box.e);
}

}  // namespace listing4

namespace listing5 {

/// Segment and oriented box, in the frame of the world. This is the one listing that takes the
/// segment in centre form; those after it take the end points.
inline bool testIntersection(const CenteredSegment3& segment, const OrientedBox3& box) {
  const Vector3 PmC = segment.P - box.C;
  double ADdU[3];
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    ADdU[i] = std::abs(segment.D.dot(box.U[axis]));
    if (std::abs(PmC.dot(box.U[axis])) > box.e[i] + segment.e * ADdU[i]) {
      return false;
    }
  }
  const Vector3 DxPmC = segment.D.cross(PmC);
  if (std::abs(DxPmC.dot(box.U[0])) > box.e[1] * ADdU[2] + box.e[2] * ADdU[1]) {
    return false;
  }
  if (std::abs(DxPmC.dot(box.U[1])) > box.e[0] * ADdU[2] + box.e[2] * ADdU[0]) {
    return false;
  }
  return !(std::abs(DxPmC.dot(box.U[2])) > box.e[0] * ADdU[1] + box.e[1] * ADdU[0]);
}

}  // namespace listing5

namespace listing6 {

/// Segment and box, in the frame of the box.
inline bool doSegmentQuery(const Vector3& P, const Vector3& D, double segE, const Vector3& boxE) {
  for (int i = 0; i < 3; ++i) {
    // Printed: segE[i] + r * abs(D[i]), with r undefined and segE a number.
    if (std::abs(P[i]) > boxE[i] + segE * std::abs(D[i])) {
      return false;
    }
  }
  return listing2::doLineQuery(P, D, boxE);
}

inline bool testIntersection(const Segment& segment, const AlignedBox& box) {
  const Vector3 C = (box.max + box.min) / 2.0;
  const Vector3 boxE = (box.max - box.min) / 2.0;
  const Vector3 P = (segment.start + segment.end) / 2.0 - C;
  Vector3 D = segment.end - segment.start;
  const double segE = normalize(D);
  return doSegmentQuery(P, D, segE, boxE);
}

inline bool testIntersection(const Segment& segment, const OrientedBox3& box) {
  // Printed: the end points are rotated first, then the centre of the box is subtracted unrotated.
  const Vector3 P = alongAxes((segment.start + segment.end) / 2.0 - box.C, box);
  Vector3 D = segment.end - segment.start;
  const double segE = normalize(D);
  // Printed: this rotates a difference of rotated points, that is, twice.
  D = alongAxes(D, box);
  return doSegmentQuery(P, D, segE, box.e);
}

}  // namespace listing6

}  // namespace box_query::listings
