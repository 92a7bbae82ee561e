// SPDX-License-Identifier: BSD-3-Clause
// A ray in double, for what may be met.

struct RayInDouble {
  const double* origin;
  alignas(32) double direction[4];
  Double4 inverse;  ///< of the direction, infinite where that is 0; for aligned boxes
  double own_end;   ///< of the component: 1 of a segment, +inf of a ray
};

/// The range of a query as parameters.
struct Reach {
  double inside;   ///< a box that is certainly entered up to it is in range
  double outside;  ///< one that is certainly entered beyond it is none
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
  if (signs3(is_fit) != 7U || signs3(is_long) == 0) {
    return false;
  }
  ray.origin = query.origin;
  store4(ray.direction, direction);
  ray.inverse = has_aligned ? all4(1.0) / direction : direction;
  return true;
}

/// (Apart: most rays end far from where the first box is entered, so that floats will do. Of a
/// query alone, so that its ray in double can stay in registers.)
[[gnu::noinline]] static Reach reachOf(const RayQuery& query) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!(query.max_range < kInfinity)) {
    const double own_end = query.is_segment ? 1.0 : kInfinity;
    return {own_end, own_end};
  }
  alignas(32) double d[4];
  store4(d, directionOf(query));
  const double t = query.max_range / std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  // 1 - x is below 1 / (1 + x), and sooner there.
  return {t * (2.0 - exact::bounds::kInflate) - exact::bounds::kUnderflow,
          t * exact::bounds::kInflate + exact::bounds::kUnderflow};
}
