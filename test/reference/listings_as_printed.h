// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where the paper's print is wrong and can be run: its text as it stands, for the tests that show
/// the fault. Only names that the paper leaves undefined are filled in.
#pragma once

#include "reference/listings.h"

namespace box_query::listings::as_printed {

/// Equation (3): the last row has D.U1 where it needs D.U2.
inline bool equation3(const CenteredSegment3& segment, const OrientedBox3& box) {
  const Vector3 PmC = segment.P - box.C;
  const Vector3 ADdU = alongAxes(segment.D, box).cwiseAbs();
  const Vector3 APmCdU = alongAxes(PmC, box).cwiseAbs();
  const Vector3 ADxPmCdU = alongAxes(segment.D.cross(PmC), box).cwiseAbs();
  const Vector3& e = box.e;
  return !(ADxPmCdU[0] > e[1] * ADdU[2] + e[2] * ADdU[1] ||
           ADxPmCdU[1] > e[0] * ADdU[2] + e[2] * ADdU[0] ||
           ADxPmCdU[2] > e[0] * ADdU[1] + e[1] * ADdU[0] ||
           APmCdU[0] > e[0] + segment.e * ADdU[0] ||  //
           APmCdU[1] > e[1] + segment.e * ADdU[1] ||  //
           APmCdU[2] > e[2] + segment.e * ADdU[1]);
}

/// Section 2.2, text under figure 3: a ray points away from the box if the product is > 0.
inline bool section22(const Ray& ray, const OrientedBox3& box) {
  const Vector3 P = alongAxes(ray.origin - box.C, box);
  const Vector3 D = alongAxes(ray.direction, box);
  for (int i = 0; i < 3; ++i) {
    if (std::abs(P[i]) > box.e[i] && P[i] * D[i] > 0.0) {
      return false;
    }
  }
  return listing2::doLineQuery(P, D, box.e);
}

namespace listing6 {

/// segE[i] + r * abs(D[i]), with the one length that is left for r: the extent of the box.
inline bool doSegmentQuery(const Vector3& P, const Vector3& D, double segE, const Vector3& boxE) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(P[i]) > segE + boxE[i] * std::abs(D[i])) {
      return false;
    }
  }
  return listing2::doLineQuery(P, D, boxE);
}

/// The end points are rotated before the centre of the box is subtracted, and the direction twice.
inline bool testIntersection(const Segment& segment, const OrientedBox3& box) {
  const Vector3 P0 = alongAxes(segment.start, box);
  const Vector3 P1 = alongAxes(segment.end, box);
  const Vector3 P = (P0 + P1) / 2.0 - box.C;
  Vector3 D = P1 - P0;
  const double segE = normalize(D);
  D = alongAxes(D, box);
  return listings::listing6::doSegmentQuery(P, D, segE, box.e);
}

}  // namespace listing6

namespace listing9 {

/// Neither the count nor the parameters follow the clipping to t >= 0.
inline Found findIntersection(const Ray& ray, const AlignedBox& box) {
  Found found = listing8::findIntersection(Line{ray.origin, ray.direction}, box);
  if (found.num_points > 0) {
    if (found.t[1] >= 0.0) {
      if (found.t[0] < 0.0) {
        found.t[0] = 0.0;
      }
    } else {
      found.num_points = 0;
    }
  }
  return found;
}

}  // namespace listing9

namespace listing10 {

/// As listing 6: rotated before the centre is subtracted, the direction twice. A miss keeps the
/// parameters of the line.
inline Found findIntersection(const Segment& segment, const OrientedBox3& box) {
  const Vector3 P0 = alongAxes(segment.start, box);
  const Vector3 P1 = alongAxes(segment.end, box);
  const Vector3 P = (P0 + P1) / 2.0 - box.C;
  Vector3 D = P1 - P0;
  const double segE = normalize(D);
  D = alongAxes(D, box);
  Found found;
  listing8::doLineQuery(P, D, box.e, found.num_points, found.t);
  if (found.num_points > 0) {
    const double s[2] = {-segE, segE};
    double overlap[2];
    if (listings::listing10::computeIntersection(found.t, s, found.num_points, overlap)) {
      std::copy(overlap, overlap + found.num_points, found.t);
    }
  }
  return found;
}

}  // namespace listing10

}  // namespace box_query::listings::as_printed
