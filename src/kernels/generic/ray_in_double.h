// SPDX-License-Identifier: BSD-3-Clause
// A ray in double, for what may be met.

struct RayInDouble {
  const double* origin;
  alignas(32) double direction[4];
  Double4 inverse;  ///< of the direction, infinite where that is 0; for aligned boxes
  double own_end;   ///< of the component: 1 of a segment, +inf of a ray
  double t_end;     ///< a box that is certainly entered beyond it is none
  double t_inside;  ///< a box that is certainly entered before it is certainly in range
};

/// Lanes whose sign is set where the number is 0 or of a size from `least` to `most`.
static inline Double4 isBetween(Double4 size, double least, double most) {
  return isNotBelow(all4(most), size) &
         (isNotBelow(size, all4(least)) | isNotBelow(all4(0.0), size));
}

/// (Inlined, where it is known whether rays have ends.)
/// @return whether the ray is taken
[[gnu::always_inline]] static inline bool prepare(const RayQuery& query, bool has_aligned,
                                                  RayInDouble& ray) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Double4 direction = directionOf(query);
  const Double4 size = magnitude(direction);
  const auto isModerate = [](const double* point) {
    return isBetween(magnitude(lanes4(point)), exact::bounds::kTiniest, exact::bounds::kLargest);
  };
  Double4 is_fit = isModerate(query.origin) &
                   isBetween(size, exact::bounds::kSmallestComponent, exact::bounds::kLargest);
  if (query.is_segment) {
    is_fit = is_fit & isModerate(query.direction);
  }
  const Double4 is_long = isNotBelow(size, all4(exact::bounds::kSmallestDirection));
  ray.own_end = query.is_segment ? 1.0 : kInfinity;
  ray.t_end = ray.own_end;
  ray.t_inside = ray.own_end;
  if (signs3(is_fit) != 7U || signs3(is_long) == 0) {
    ray.t_inside = 0.0;
    return false;
  }
  ray.origin = query.origin;
  store4(ray.direction, direction);
  ray.inverse = has_aligned ? all4(1.0) / direction : direction;
  if (query.max_range < kInfinity) {
    const double* d = ray.direction;
    const double t = query.max_range / std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    ray.t_end = t * exact::bounds::kInflate + exact::bounds::kUnderflow;
    // 1 - x is below 1 / (1 + x), and sooner there.
    ray.t_inside = t * (2.0 - exact::bounds::kInflate) - exact::bounds::kUnderflow;
  }
  return true;
}
