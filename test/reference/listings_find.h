// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Listings 7 to 10 of D. Eberly, "Intersection of a Line and a Box" (Geometric Tools, 2018, CC BY
/// 4.0): the find-intersection queries, by Liang-Barsky clipping. See listings.h.
#pragma once

#include "reference/listing_types.h"

#include <algorithm>

namespace box_query::listings {

namespace listing7 {

/// Clips [t0, t1] against one face. Printed: the parameter is called numer, its uses number.
inline bool clip(double denom, double numer, double& t0, double& t1) {
  if (denom > 0.0) {
    if (numer > denom * t1) {
      return false;
    }
    if (numer > denom * t0) {
      t0 = numer / denom;
    }
    return true;
  }
  if (denom < 0.0) {
    if (numer > denom * t0) {
      return false;
    }
    if (numer > denom * t1) {
      t1 = numer / denom;
    }
    return true;
  }
  return numer <= 0.0;
}

}  // namespace listing7

namespace listing8 {

/// Line and box, in the frame of the box. Printed: box.e, which is not in scope, for e.
inline void doLineQuery(const Vector3& P, const Vector3& D, const Vector3& e, int& num_points,
                        double t[2]) {
  double t0 = -kInfinity;
  double t1 = kInfinity;
  const bool not_culled =
      listing7::clip(+D[0], -P[0] - e[0], t0, t1) && listing7::clip(-D[0], +P[0] - e[0], t0, t1) &&
      listing7::clip(+D[1], -P[1] - e[1], t0, t1) && listing7::clip(-D[1], +P[1] - e[1], t0, t1) &&
      listing7::clip(+D[2], -P[2] - e[2], t0, t1) && listing7::clip(-D[2], +P[2] - e[2], t0, t1);
  if (not_culled) {
    num_points = t1 > t0 ? 2 : 1;
    t[0] = t0;
    t[1] = t1 > t0 ? t1 : t0;
  } else {
    num_points = 0;
    t[0] = kInfinity;
    t[1] = -kInfinity;
  }
}

inline Found findIntersection(const Line& line, const AlignedBox& box) {
  const Vector3 C = (box.max + box.min) / 2.0;
  const Vector3 e = (box.max - box.min) / 2.0;
  Found found;
  doLineQuery(line.origin - C, line.direction, e, found.num_points, found.t);
  for (int i = 0; i < found.num_points; ++i) {
    found.point[i] = line.origin + found.t[i] * line.direction;
  }
  return found;
}

inline Found findIntersection(const Line& line, const OrientedBox3& box) {
  Found found;
  doLineQuery(alongAxes(line.origin - box.C, box), alongAxes(line.direction, box), box.e,
              found.num_points, found.t);
  for (int i = 0; i < found.num_points; ++i) {
    found.point[i] = line.origin + found.t[i] * line.direction;
  }
  return found;
}

}  // namespace listing8

namespace listing9 {

/// Ray and box, in the frame of the box.
inline void doRayQuery(const Vector3& P, const Vector3& D, const Vector3& e, int& num_points,
                       double t[2]) {
  listing8::doLineQuery(P, D, e, num_points, t);
  if (num_points > 0) {
    if (t[1] >= 0.0) {
      if (t[0] < 0.0) {
        t[0] = 0.0;
      }
      // Printed: nothing here, so that a ray that starts where it leaves the box has two points.
      num_points = t[1] > t[0] ? 2 : 1;
    } else {
      num_points = 0;
      // Printed: nothing more, so that a miss keeps the parameters of the line.
      t[0] = kInfinity;
      t[1] = -kInfinity;
    }
  }
}

inline Found findIntersection(const Ray& ray, const AlignedBox& box) {
  const Vector3 C = (box.max + box.min) / 2.0;
  const Vector3 e = (box.max - box.min) / 2.0;
  Found found;
  doRayQuery(ray.origin - C, ray.direction, e, found.num_points, found.t);
  for (int i = 0; i < found.num_points; ++i) {
    found.point[i] = ray.origin + found.t[i] * ray.direction;
  }
  return found;
}

/// Printed: line.D, which is not in scope, for ray.D.
inline Found findIntersection(const Ray& ray, const OrientedBox3& box) {
  Found found;
  doRayQuery(alongAxes(ray.origin - box.C, box), alongAxes(ray.direction, box), box.e,
             found.num_points, found.t);
  for (int i = 0; i < found.num_points; ++i) {
    found.point[i] = ray.origin + found.t[i] * ray.direction;
  }
  return found;
}

}  // namespace listing9

namespace listing10 {

/// The overlap of two closed intervals.
inline bool computeIntersection(const double interval0[2], const double interval1[2],
                                int& num_intersections, double overlap[2]) {
  if (interval0[1] < interval1[0] || interval0[0] > interval1[1]) {
    overlap[0] = kInfinity;
    overlap[1] = -kInfinity;
    num_intersections = 0;
  } else if (interval0[1] > interval1[0]) {
    if (interval0[0] < interval1[1]) {
      overlap[0] = interval0[0] < interval1[0] ? interval1[0] : interval0[0];
      overlap[1] = interval0[1] > interval1[1] ? interval1[1] : interval0[1];
      num_intersections = overlap[0] != overlap[1] ? 2 : 1;
    } else {  // interval0[0] == interval1[1]
      overlap[0] = interval0[0];
      overlap[1] = overlap[0];
      num_intersections = 1;
    }
  } else {  // interval0[1] == interval1[0]
    overlap[0] = interval0[1];
    overlap[1] = overlap[0];
    num_intersections = 1;
  }
  return num_intersections > 0;
}

/// Segment and box, in the frame of the box. t is a distance from the centre of the segment.
inline void doSegmentQuery(const Vector3& P, const Vector3& D, double segE, const Vector3& boxE,
                           int& num_points, double t[2]) {
  listing8::doLineQuery(P, D, boxE, num_points, t);
  if (num_points > 0) {
    const double s[2] = {-segE, segE};
    double overlap[2];
    computeIntersection(t, s, num_points, overlap);
    // Printed: only where there is an overlap, so that a miss keeps the parameters of the line.
    std::copy(overlap, overlap + 2, t);
  }
}

inline Found findIntersection(const Segment& segment, const AlignedBox& box) {
  const Vector3 C = (box.max + box.min) / 2.0;
  const Vector3 boxE = (box.max - box.min) / 2.0;
  const Vector3 P = (segment.start + segment.end) / 2.0 - C;
  Vector3 D = segment.end - segment.start;
  const double segE = normalize(D);
  Found found;
  doSegmentQuery(P, D, segE, boxE, found.num_points, found.t);
  for (int i = 0; i < found.num_points; ++i) {
    found.point[i] = P + C + found.t[i] * D;
  }
  return found;
}

inline Found findIntersection(const Segment& segment, const OrientedBox3& box) {
  // Printed: rotates before it subtracts the centre, and the direction twice, as in listing 6.
  const Vector3 P = alongAxes((segment.start + segment.end) / 2.0 - box.C, box);
  Vector3 D = segment.end - segment.start;
  const double segE = normalize(D);
  D = alongAxes(D, box);
  Found found;
  doSegmentQuery(P, D, segE, box.e, found.num_points, found.t);
  for (int i = 0; i < found.num_points; ++i) {
    const Vector3 Y = P + found.t[i] * D;
    found.point[i] = box.C + Y[0] * box.U[0] + Y[1] * box.U[1] + Y[2] * box.U[2];
  }
  return found;
}

}  // namespace listing10

}  // namespace box_query::listings
