// SPDX-License-Identifier: BSD-3-Clause
// A ray in float, against sixteen bounds at once.
//
// Its parameter is s = t |d|_max, so that along the dominant axis it is metres, and r_i = |d|_max /
// d_i is at least 1. With o relative to the center of the scene, and u = 2^-24, the planes of axis
// i are at s = plane r_i - o r_i. Computed as multiplyAdd(plane, r_i, shift), r_i off by 1.1u, the
// shift by 1.1u |o r_i|, two roundings: since |plane r_i| <= |s| + |o r_i|, off by at most
// 4.2u |s| + 5.3u |o r_i|. The second part is in the shifts (kShiftError); the first one, on both
// sides, in kFarther.
//
// An axis along which the ray hardly goes, |d_i| < 2^-40 |d|_max, has r_i = +-2^40 and moves by
// less than s_end / |r_i|: its planes are moved apart by twice s_end (where the ray is between
// them, or reaches one, they clip nothing before s_end).

enum class Outcome { kNotTaken, kMiss, kReady };

constexpr double kSteepest = 0x1p40;
/// Up to it, and from its inverse on, a float holds the square of a direction.
constexpr double kLongestInFloat = 0x1p60;

/// Long rays go down a tree a stretch at a time, so that what lies behind the first box is not
/// compared: at first so far [m], then twice as far each time. (Measured; shorter ones spare fewer
/// nodes than beginning anew costs.)
static inline float firstStretch(const SceneView& view) {
  return 3.0F * static_cast<float>(view.mean_free_path);
}

/// (Not kept in sixteen lanes: what was just written is read back sooner as single floats.)
struct FloatRay {
  int near_side[3];
  alignas(16) float inverse[4];
  alignas(16) float near_shift[4];
  alignas(16) float far_shift[4];
  /// Instead of these, where the boxes are in blocks: see blocks.h.
  bool for_blocks;
  alignas(16) float origin[4];
  alignas(16) float direction[4];
  float pad;
  float begin_s;
  float end_s;
  double scale;  ///< |d|_max: s = t * scale; 1 for blocks

  void setRange(float from, float to) {
    begin_s = from;
    end_s = to;
  }
  /// Parameter t in s, rounded up.
  float roundedUp(double t) const {
    return static_cast<float>(t * scale * bounds::kUp + bounds::kFloatUnderflow);
  }
};

/// A ray as the boxes of a scene are compared with it.
struct Ray {
  FloatRay in_float;
  const double* origin;
  const double* direction;
  Double4 inverse;  ///< of the direction, infinite where that is 0
  Double4 signs;    ///< of the direction
  double own_end;   ///< of the component: 1 of a segment, +inf of a ray
  double t_end;     ///< a box that is certainly entered beyond it is none
  double t_inside;  ///< a box that is certainly entered before it is certainly in range
};

/// Lanes whose sign is set where the number is 0 or of a size from `least` to `most`.
static inline Double4 isBetween(Double4 size, double least, double most) {
  return isNotBelow(all4(most), size) &
         (isNotBelow(size, all4(least)) | isNotBelow(all4(0.0), size));
}

/// What a ray that is compared with blocks needs.
static inline void setForBlocks(Double4 relative, const RayQuery& query, double t_end,
                                FloatRay& f) {
  const Double4 reach = magnitude(relative);
  const double size = (firstLane(reach) + firstLane(turned(reach))) + firstLane(turnedTwice(reach));
  f.scale = 1.0;
  f.pad = static_cast<float>(size * (bounds::kBlock * bounds::kUp) + bounds::kFloatUnderflow);
  storeAsFloats(f.origin, relative);
  storeAsFloats(f.direction, lanes4(query.direction));
  f.setRange(0.0F, f.roundedUp(t_end));
}

/// What a ray is prepared from.
struct RayParts {
  Double4 origin;
  Double4 direction;
  Double4 size;      ///< of the direction
  Double4 relative;  ///< the origin, to the center of the scene
  Double4 scale;     ///< the largest size, in the first three lanes
};

static inline RayParts partsOf(const SceneView& view, const RayQuery& query) {
  RayParts p;
  p.origin = lanes4(query.origin);
  p.direction = lanes4(query.direction);
  p.size = magnitude(p.direction);
  p.relative = p.origin - load4(view.center);
  p.scale = larger(larger(p.size, turned(p.size)), turnedTwice(p.size));
  return p;
}

static inline double squareOf(const double* d) {
  return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

/// Not less than the parameter of the end of a ray, but sooner there than that: a root and a
/// quotient.
static inline double roughEnd(const RayQuery& query, double scale, const Ray& ray) {
  const bool is_limited = query.max_range < std::numeric_limits<double>::infinity();
  return is_limited && scale <= kLongestInFloat && scale >= 1.0 / kLongestInFloat
             ? query.max_range * aboveInverseRoot(static_cast<float>(squareOf(query.direction)))
             : ray.t_end;
}

/// Prepares what is compared in double. (Inlined, where it is known whether rays have ends.)
/// @return whether the ray is taken
[[gnu::always_inline]] static inline bool prepareInDouble(const SceneView& view,
                                                          const RayQuery& query, const RayParts& p,
                                                          Ray& ray) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  ray.t_inside = 0.0;
  const Double4 is_fit =
      isBetween(magnitude(p.origin), exact::bounds::kTiniest, exact::bounds::kLargest) &
      isBetween(p.size, exact::bounds::kSmallestComponent, exact::bounds::kLargest) &
      isNotBelow(all4(kFarthestOrigin), magnitude(p.relative)) &
      isNotBelow(p.scale, all4(exact::bounds::kSmallestDirection));
  if (signs3(is_fit) != 7U) {
    return false;
  }
  ray.origin = query.origin;
  ray.direction = query.direction;
  ray.signs = p.direction;
  if (view.has_aligned) {
    ray.inverse = all4(1.0) / p.direction;
  }
  ray.own_end = query.has_end ? 1.0 : kInfinity;
  ray.t_end = ray.own_end;
  ray.t_inside = ray.own_end;
  if (query.max_range < kInfinity) {
    const double t = query.max_range / std::sqrt(squareOf(query.direction));
    ray.t_end = t * exact::bounds::kInflate + exact::bounds::kUnderflow;
    // 1 - x is below 1 / (1 + x), and sooner there.
    ray.t_inside = t * (2.0 - exact::bounds::kInflate) - exact::bounds::kUnderflow;
  }
  return true;
}

/// Prepares a ray for the boxes of a scene.
/// @param in_stretches whether it goes down the tree a stretch at a time until its end
[[gnu::always_inline]] static inline Outcome prepare(const SceneView& view, const RayQuery& query,
                                                     Ray& ray, bool in_stretches) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const RayParts parts = partsOf(view, query);
  const auto& [origin, direction, size, relative, scale] = parts;
  FloatRay& f = ray.in_float;
  f.scale = firstLane(scale);
  if (!prepareInDouble(view, query, parts, ray)) {
    return Outcome::kNotTaken;
  }
  const double rough_end = roughEnd(query, f.scale, ray);
  f.for_blocks = view.boxes_in_blocks > 0 && f.scale <= kLongestInBlocks &&
                 f.scale >= 1.0 / kLongestInBlocks &&
                 notBelow3(all4(kFarthestInBlocks), magnitude(relative)) == 7U;
  if (f.for_blocks) {
    setForBlocks(relative, query, rough_end, f);
    return Outcome::kReady;
  }

  const Double4 is_flat = isNotBelow(scale, all4(kSteepest) * size);
  const Double4 inverse =
      choose(scale / direction, withSignOf(all4(kSteepest), direction), is_flat);
  const Double4 shift = relative * inverse;
  Double4 apart = fused(magnitude(shift), all4(bounds::kShiftError),
                        all4(bounds::kFloatUnderflow) * magnitude(inverse));
  double begin = 0.0;
  double end = rough_end * f.scale * bounds::kUp;
  const bool has_stretches = in_stretches && end > firstStretch(view);
  if (has_stretches || signs3(is_flat) != 0) {
    // Clipped to the bounds of the scene, for as few stretches as can be, and so that the end is
    // finite where planes are moved by it.
    const Double4 lo = load4(view.around[0]);
    const Double4 hi = load4(view.around[1]);
    const Double4 near = (choose(lo, hi, direction) - relative) * inverse;
    const Double4 far = (choose(hi, lo, direction) - relative) * inverse;
    const Double4 nearest = (near - apart) - all4(bounds::kShiftError) * magnitude(near);
    const Double4 farthest = (far + apart) + all4(bounds::kShiftError) * magnitude(far);
    const double first = largest3(choose(nearest, all4(-kInfinity), is_flat), nearest).first;
    const double last = smallest3(choose(farthest, all4(kInfinity), is_flat), farthest).first;
    begin = first > 0.0 ? first : 0.0;
    end = last < end ? last : end;
    if (begin > end) {
      return Outcome::kMiss;
    }
    apart = apart + choose(all4(0.0), all4(bounds::kFlat * end), is_flat);
  }
  storeAsFloats(f.inverse, inverse);
  storeAsFloats(f.near_shift, negated(shift) - apart);
  storeAsFloats(f.far_shift, apart - shift);
  const unsigned goes_down = signs3(direction);
  for (int i = 0; i < 3; ++i) {
    f.near_side[i] = static_cast<int>((goes_down >> i) & 1U);
  }
  f.setRange(static_cast<float>(begin * (1.0 - bounds::kShiftError)),
             static_cast<float>(end * bounds::kUp + bounds::kFloatUnderflow));
  return Outcome::kReady;
}

/// A ray in float as it is compared with many bounds: read once, since what is written meanwhile
/// could be the ray for all that the compiler knows.
struct RayLanes {
  // (Without a loop, which would keep GCC from taking the arrays apart.)
  [[gnu::always_inline]] explicit RayLanes(const FloatRay& ray)
      : near_plane{ray.near_side[0] * 3, ray.near_side[1] * 3 + 1, ray.near_side[2] * 3 + 2},
        far_plane{3 - near_plane[0], 5 - near_plane[1], 7 - near_plane[2]},
        inverse{kept16(ray.inverse[0]), kept16(ray.inverse[1]), kept16(ray.inverse[2])},
        near_shift{kept16(ray.near_shift[0]), kept16(ray.near_shift[1]), kept16(ray.near_shift[2])},
        far_shift{kept16(ray.far_shift[0]), kept16(ray.far_shift[1]), kept16(ray.far_shift[2])},
        begin(kept16(ray.begin_s)),
        end(kept16(ray.end_s)) {}

  std::ptrdiff_t near_plane[3];  ///< Of Bounds, counted through minimum and maximum.
  std::ptrdiff_t far_plane[3];
  Kept16 inverse[3];
  Kept16 near_shift[3];
  Kept16 far_shift[3];
  Kept16 begin;
  Kept16 end;
};

/// The slots whose bounds the ray may meet between its begin and its end, a bit each. (Inlined, so
/// that the ray stays in registers.)
/// @param near where it enters them, too early by at most what the floats cannot tell
[[gnu::always_inline]] static inline std::uint32_t meets(const Bounds& bounds, const RayLanes& ray,
                                                         Float16& near) {
  const auto* planes = &bounds.plane[0][0];
  const auto nearPlane = [&](int i) {
    return multiplyAdd(load16(planes[ray.near_plane[i]]), all16(ray.inverse[i]),
                       all16(ray.near_shift[i]));
  };
  const auto farPlane = [&](int i) {
    return multiplyAdd(load16(planes[ray.far_plane[i]]), all16(ray.inverse[i]),
                       all16(ray.far_shift[i]));
  };
  near = larger(larger(nearPlane(0), nearPlane(1)), larger(nearPlane(2), all16(ray.begin)));
  const Float16 far =
      smaller(smaller(farPlane(0), farPlane(1)), smaller(farPlane(2), all16(ray.end)));
  return notAbove(near, far * all16(static_cast<float>(bounds::kFarther)));
}
