// SPDX-License-Identifier: BSD-3-Clause
#include "reference/oracle/second_method.h"

#include <algorithm>
#include <vector>

namespace box_query::second_method {
namespace {

using RationalVector = std::array<mpq_class, 3>;

RationalVector exact(const Vector3& v) {
  return {mpq_class(v[0]), mpq_class(v[1]), mpq_class(v[2])};
}

RationalVector minus(const RationalVector& a, const RationalVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

mpq_class dot(const RationalVector& a, const RationalVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

RationalVector at(const RationalComponent& component, const mpq_class& t) {
  RationalVector result;
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = component.origin[i] + t * component.direction[i];
  }
  return result;
}

RationalVector local(const RationalVector& point, const RationalBox& box) {
  const RationalVector offset = minus(point, box.center);
  return {dot(box.axes[0], offset), dot(box.axes[1], offset), dot(box.axes[2], offset)};
}

RationalVector localDirection(const RationalComponent& component, const RationalBox& box) {
  const RationalVector& d = component.direction;
  return {dot(box.axes[0], d), dot(box.axes[1], d), dot(box.axes[2], d)};
}

/// Squared distance of a point, in the frame of the box, from the box.
mpq_class squaredDistance(const RationalVector& point, const RationalBox& box) {
  mpq_class sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const mpq_class excess = abs(point[i]) - box.half_extents[i];
    if (excess > 0) {
      sum += excess * excess;
    }
  }
  return sum;
}

bool contains(const RationalComponent& component, const RationalBox& box, const mpq_class& t) {
  return (!component.first || t >= *component.first) && (!component.last || t <= *component.last) &&
         squaredDistance(local(at(component, t), box), box) == 0;
}

/// Faces whose planes hold the point at t, crossed inwards or outwards.
FaceSet facesCrossed(const RationalComponent& component, const RationalBox& box, const mpq_class& t,
                     bool inwards) {
  const RationalVector point = local(at(component, t), box);
  const RationalVector direction = localDirection(component, box);
  FaceSet faces;
  for (std::size_t i = 0; i < 3; ++i) {
    for (const int side : {-1, 1}) {
      const int outwards = sgn(direction[i]) * side;
      if (point[i] == side * box.half_extents[i] && outwards != 0 && (outwards < 0) == inwards) {
        faces.insert(static_cast<int>(i), side > 0);
      }
    }
  }
  return faces;
}

/// Keeps the least distance, and the least parameter that has it.
class Best {
 public:
  void offer(const mpq_class& squared, const mpq_class& t) {
    if (!best_ || squared < best_->squared || (squared == best_->squared && t < best_->t)) {
      best_ = Nearest{squared, t};
    }
  }
  const Nearest& get() const { return *best_; }

 private:
  std::optional<Nearest> best_;
};

mpq_class clampToUnit(const mpq_class& t) {
  return t < 0 ? mpq_class(0) : (t > 1 ? mpq_class(1) : t);
}

}  // namespace

RationalBox::RationalBox(const AlignedBox& box) {
  for (std::size_t i = 0; i < 3; ++i) {
    const mpq_class low(box.min[static_cast<Eigen::Index>(i)]);
    const mpq_class high(box.max[static_cast<Eigen::Index>(i)]);
    center[i] = (low + high) / 2;
    half_extents[i] = (high - low) / 2;
    axes[i][i] = 1;
  }
}

RationalBox::RationalBox(const OrientedBox& box)
    : center(exact(box.center)), half_extents(exact(box.half_extents)) {
  // Rotation of v by q / |q|: v + 2 (w (u x v) + u x (u x v)) / |q|^2, u the vector part of q.
  const mpq_class w(box.orientation.w());
  const RationalVector u = exact(box.orientation.vec());
  const mpq_class norm = w * w + dot(u, u);
  const auto cross = [](const RationalVector& a, const RationalVector& b) {
    return RationalVector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                          a[0] * b[1] - a[1] * b[0]};
  };
  for (std::size_t i = 0; i < 3; ++i) {
    axes[i][i] = 1;
    const RationalVector once = cross(u, axes[i]);
    const RationalVector twice = cross(u, once);
    for (std::size_t j = 0; j < 3; ++j) {
      axes[i][j] += 2 * (w * once[j] + twice[j]) / norm;
    }
  }
}

RationalComponent::RationalComponent(const Line& line)
    : origin(exact(line.origin)), direction(exact(line.direction)) {}

RationalComponent::RationalComponent(const Ray& ray)
    : origin(exact(ray.origin)), direction(exact(ray.direction)), first(0) {}

RationalComponent::RationalComponent(const Segment& segment)
    : origin(exact(segment.start)),
      direction(minus(exact(segment.end), origin)),
      first(0),
      last(1) {}

bool intersects(const RationalComponent& component, const RationalBox& box) {
  const RationalVector y = local(component.origin, box);
  const RationalVector d = localDirection(component, box);
  const RationalVector& e = box.half_extents;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    if (abs(y[j] * d[k] - y[k] * d[j]) > e[j] * abs(d[k]) + e[k] * abs(d[j])) {
      return false;
    }
    if (component.first && component.last) {
      if (abs(2 * y[i] + d[i]) > 2 * e[i] + abs(d[i])) {
        return false;
      }
    } else if (abs(y[i]) > e[i] && (d[i] == 0 || (component.first && sgn(y[i]) == sgn(d[i])))) {
      return false;
    }
  }
  return true;
}

Interval interval(const RationalComponent& component, const RationalBox& box) {
  const RationalVector y = local(component.origin, box);
  const RationalVector d = localDirection(component, box);
  std::vector<mpq_class> candidates;
  for (std::size_t i = 0; i < 3; ++i) {
    if (d[i] != 0) {
      candidates.emplace_back((box.half_extents[i] - y[i]) / d[i]);
      candidates.emplace_back((-box.half_extents[i] - y[i]) / d[i]);
    }
  }
  for (const auto& end : {component.first, component.last}) {
    if (end) {
      candidates.push_back(*end);
    }
  }
  Interval result;
  for (const mpq_class& t : candidates) {
    if (contains(component, box, t)) {
      result.enter = result.hit ? std::min(result.enter, t) : t;
      result.exit = result.hit ? std::max(result.exit, t) : t;
      result.hit = true;
    }
  }
  if (result.hit) {
    result.entered = facesCrossed(component, box, result.enter, true);
    result.left = facesCrossed(component, box, result.exit, false);
  }
  return result;
}

Nearest nearest(const RationalComponent& segment, const RationalBox& box) {
  const RationalVector y = local(segment.origin, box);
  const RationalVector d = localDirection(segment, box);
  const mpq_class length_squared = dot(d, d);
  Best best;
  const auto offerPointOf = [&](const mpq_class& t) {
    const RationalVector point = {y[0] + t * d[0], y[1] + t * d[1], y[2] + t * d[2]};
    best.offer(squaredDistance(point, box), t);
  };
  offerPointOf(0);
  offerPointOf(1);
  for (unsigned corner = 0; corner < 8 && length_squared != 0; ++corner) {
    RationalVector to_corner;
    for (std::size_t i = 0; i < 3; ++i) {
      to_corner[i] = ((corner >> i) & 1U ? box.half_extents[i] : -box.half_extents[i]) - y[i];
    }
    const mpq_class t = clampToUnit(dot(to_corner, d) / length_squared);
    const RationalVector gap = {to_corner[0] - t * d[0], to_corner[1] - t * d[1],
                                to_corner[2] - t * d[2]};
    best.offer(dot(gap, gap), t);
  }
  // An edge is parallel to axis i: seen along it, it is a point, and the segment passes it where
  // the planar distance is least. Only counts where that place is beside the edge.
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    const mpq_class planar = d[j] * d[j] + d[k] * d[k];
    for (unsigned edge = 0; edge < 4 && planar != 0; ++edge) {
      const mpq_class gap_j = ((edge & 1U) ? box.half_extents[j] : -box.half_extents[j]) - y[j];
      const mpq_class gap_k = ((edge & 2U) ? box.half_extents[k] : -box.half_extents[k]) - y[k];
      const mpq_class t = clampToUnit((gap_j * d[j] + gap_k * d[k]) / planar);
      if (abs(y[i] + t * d[i]) <= box.half_extents[i]) {
        const mpq_class miss_j = gap_j - t * d[j];
        const mpq_class miss_k = gap_k - t * d[k];
        best.offer(miss_j * miss_j + miss_k * miss_k, t);
      }
    }
  }
  return best.get();
}

}  // namespace box_query::second_method
