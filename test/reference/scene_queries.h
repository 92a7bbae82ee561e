// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Queries of a given scene for tests: some at random, some that touch a box or run along its face.
#pragma once

#include "reference/sampler.h"

#include <box_query/geometry.h>

#include <limits>
#include <vector>

namespace box_query::reference {

struct RayQuery {
  Ray ray;
  double max_range = std::numeric_limits<double>::infinity();  ///< [m]
};

struct SegmentQuery {
  Segment segment;
  double radius = 0.0;  ///< [m]
};

/// Makes queries of one scene.
///
/// A face can be touched exactly only where doubles name its points: where its box's axis is
/// exactly one of the world's, and its plane at a coordinate that is a double. Elsewhere what
/// touches is made as nearly as doubles can.
class SceneQueries {
 public:
  SceneQueries(const std::vector<OrientedBox>& boxes, Sampler& sampler);

  /// There is a face that can be touched exactly.
  bool canTouchExactly() const { return exact_faces_ > 0; }

  /// From near the scene, half of them aimed at a box; a third with a limited range.
  RayQuery randomRay();
  /// Near the scene; some short, some points, with a radius of 0 to 0.3 m.
  SegmentQuery randomSegment();

  /// The n-th way to touch a face: along it; away from one of its points; with a
  /// range that just reaches it, or ends one double before.
  RayQuery touchingRay(int n);
  /// The n-th way: along a face; ending on one; a point of one; a radius that just reaches one, or
  /// ends one double before.
  SegmentQuery touchingSegment(int n);

 private:
  struct Face {
    std::size_t box;
    int box_axis;
    int axis;      ///< of the world, nearest to the box's
    double side;   ///< -1 or 1: outward along the world's axis
    double plane;  ///< [m] its coordinate on the world's axis
    bool aligned;  ///< the axes are equal, so that every point of the face has this coordinate
    bool exact;    ///< and it is no rounded one
  };

  void addFaces(std::size_t box, int box_axis);
  const Face& anyFace();
  Vector3 pointInBox(std::size_t box);
  Vector3 pointNearScene();
  Vector3 pointOnFace(const Face& face);
  Vector3 alongFace(const Face& face);

  const std::vector<OrientedBox>& boxes_;
  Sampler& sampler_;
  Vector3 low_;
  Vector3 high_;
  std::vector<Face> faces_;  ///< exact ones first, then aligned ones
  int exact_faces_ = 0;
  int aligned_faces_ = 0;
};

}  // namespace box_query::reference
