// SPDX-License-Identifier: BSD-3-Clause
// A ray in float, against sixteen bounds at once. Most rays are done with it: only for those that
// may meet a box is anything prepared in double.
//
// A ray is o + t d, o relative to the center of the scene, d raised to +-kFlattest in each
// coordinate. With u = 2^-24, S = |o|_1 + A, A the largest |p|_1 of a point p in the bounds of the
// scene: where the ray is in bounds, |t d|_2 <= |o|_2 + |p|_2 <= S. Computed as
// multiplyAdd(plane, r, -o r), r = 1 / d, in metres along the axis
// - r is off by 2u, of d and of the quotient, the product with a plane by u: 3u S,
// - -o r by u of o, 2u of r, u of the product and u of what is added to o below: 5u S,
// - the sum by u S, and the ray by t kFlattest <= 2^-39 S where d is raised.
// Together 9u S and what is left of second order: planes are moved apart by kApart S. No product
// overflows: |plane| and |o| < 2^61, r <= 2^60.

constexpr float kFlattest = 0x1p-60F;
/// Of a usual ray, each coordinate of the origin is at most so far from the center,
constexpr float kUsualDistance = 0x1p40F;
/// and the largest one of the direction at most so large, its inverse too.
constexpr float kUsualLength = 0x1p20F;

enum class Outcome { kNotTaken, kMiss, kReady };

/// A ray as it is compared with bounds. (Not kept in sixteen lanes: what was just written is read
/// back sooner as single floats.)
struct FloatRay {
  std::uint32_t goes_down;  ///< a bit for each axis
  alignas(16) float inverse[4];
  alignas(16) float near_shift[4];
  alignas(16) float far_shift[4];
  float begin_s;
  float end_s;
  /// The parameter at which it ends, not too late: see certainEnd().
  float certain_end;
  /// It goes down a tree a stretch at a time, so that what lies behind the first box is not
  /// compared: at first so far, then twice as far each time. (Measured; shorter ones spare fewer
  /// nodes than beginning anew costs.)
  float stretch_s;
  double scale;  ///< s = t * scale; 1 of a usual ray

  void setRange(float from, float to) {
    begin_s = from;
    end_s = to;
  }
  /// Parameter t in s, rounded up.
  float roundedUp(double t) const {
    return static_cast<float>(t * scale * bounds::kUp + bounds::kFloatUnderflow);
  }
};

/// Stretches in metres.
static inline float firstStretch(const SceneView& view) {
  return 3.0F * static_cast<float>(view.mean_free_path);
}

/// The numbers of a usual ray.
struct UsualRay {
  Float4 origin;  ///< relative to the center of the scene
  Float4 direction;
  float inverse_length;  ///< not less than that of the direction
};

static inline Double4 directionOf(const RayQuery& query) {
  const Double4 direction = lanes4(query.direction);
  return query.is_segment ? direction - lanes4(query.origin) : direction;
}

/// @return whether the ray is a usual one
[[gnu::always_inline]] static inline bool isUsual(const SceneView& view, const RayQuery& query,
                                                  UsualRay& ray) {
  ray.origin = floatsOf(lanes4(query.origin) - load4(view.center));
  ray.direction = floatsOf(directionOf(query));
  const Float4 size = magnitude(ray.direction);
  ray.inverse_length = aboveInverseRoot(firstLane(sumOf3(ray.direction * ray.direction)));
  return (notAbove(magnitude(ray.origin), quad(kUsualDistance)) &
          notAbove(size, quad(kUsualLength)) & 7U) == 7U &&
         (notAbove(quad(1.0F / kUsualLength), size) & 7U) != 0;
}

/// The parameter at which it ends, rounded up.
[[gnu::always_inline]] static inline float endOf(const RayQuery& query, const UsualRay& ray) {
  const float end = static_cast<float>(query.max_range) * ray.inverse_length +
                    static_cast<float>(bounds::kFloatUnderflow);
  return query.is_segment && end > 1.0F ? 1.0F : end;
}

/// The same, given it, not too late. (It may be too large for a float, and a box that is in no tree
/// farther away than any float.)
static inline float certainEnd(float end) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  return (end < kLargest ? end : kLargest) * (1.0F - 0x1p-8F) -
         2.0F * static_cast<float>(bounds::kFloatUnderflow);
}

/// Clips a ray to the bounds of the scene.
/// @return whether any of it is left
static inline bool clipToScene(const SceneView& view, FloatRay& f) {
  const Float4 inverse = loadQuad(f.inverse);
  const Float4 lo = loadQuad(view.around[0]);
  const Float4 hi = loadQuad(view.around[1]);
  const float begin =
      largestOf3(multiplyAdd(choose(lo, hi, inverse), inverse, loadQuad(f.near_shift)));
  const float end =
      smallestOf3(multiplyAdd(choose(hi, lo, inverse), inverse, loadQuad(f.far_shift)));
  f.setRange(begin > f.begin_s ? begin : f.begin_s, end < f.end_s ? end : f.end_s);
  return f.begin_s <= f.end_s;
}

/// How far planes are moved outward for what lies within a radius.
static inline float outwardBy(double radius) {
  return static_cast<float>(radius * bounds::kWithin) + static_cast<float>(bounds::kFloatUnderflow);
}

/// Prepares a usual ray for bounds.
/// @param kWithin whether what lies within the radius of the query is met too
/// @param in_stretches whether it goes down the tree a stretch at a time until its end
/// @return kNotTaken if it is not a usual one
template <bool kWithin>
[[gnu::always_inline]] static inline Outcome prepareUsual(const SceneView& view,
                                                          const RayQuery& query, FloatRay& f,
                                                          bool in_stretches) {
  UsualRay ray;
  if (!isUsual(view, query, ray)) {
    return Outcome::kNotTaken;
  }
  const auto pad = static_cast<float>(bounds::kApart * bounds::kUp);
  Float4 apart = multiplyAdd(sumOf3(magnitude(ray.origin)), quad(pad), quad(view.apart));
  if constexpr (kWithin) {
    apart = apart + quad(outwardBy(query.radius));
  }
  apart = withSignOf(apart, ray.direction);
  const Float4 steep = larger(magnitude(ray.direction), quad(kFlattest));
  const Float4 inverse = quad(1.0F) / withSignOf(steep, ray.direction);
  store(f.inverse, inverse);
  store(f.near_shift, (quad(-0.0F) - (ray.origin + apart)) * inverse);
  store(f.far_shift, (apart - ray.origin) * inverse);
  f.goes_down = signsOf(ray.direction) & 7U;  // 0 - 0 is -0 where a thread rounds down
  f.scale = 1.0;
  f.setRange(0.0F, endOf(query, ray));
  f.certain_end = certainEnd(f.end_s);
  f.stretch_s = firstStretch(view) * smallestOf3(magnitude(inverse));
  return in_stretches && f.end_s > f.stretch_s && !clipToScene(view, f) ? Outcome::kMiss
                                                                        : Outcome::kReady;
}

/// Where the near and the far planes of the axes are among those of Bounds, counted in floats: for
/// each set of axes along which a ray goes down.
struct PlanesOfAxes {
  std::ptrdiff_t near[3];
  std::ptrdiff_t far[3];
};
constexpr PlanesOfAxes planesOf(int goes_down) {
  PlanesOfAxes planes = {};
  for (int i = 0; i < 3; ++i) {
    const int down = (goes_down >> i) & 1;
    planes.near[i] = (3 * down + i) * kSlots;
    planes.far[i] = (3 * (1 - down) + i) * kSlots;
  }
  return planes;
}
constexpr PlanesOfAxes kPlanes[] = {planesOf(0), planesOf(1), planesOf(2), planesOf(3),
                                    planesOf(4), planesOf(5), planesOf(6), planesOf(7)};

/// A ray in float as it is compared with many bounds: read once, since what is written meanwhile
/// could be the ray for all that the compiler knows.
struct RayLanes {
  // (Without a loop, which would keep GCC from taking the arrays apart.)
  [[gnu::always_inline]] explicit RayLanes(const FloatRay& ray)
      : near_plane{kPlanes[ray.goes_down].near[0], kPlanes[ray.goes_down].near[1],
                   kPlanes[ray.goes_down].near[2]},
        far_plane{kPlanes[ray.goes_down].far[0], kPlanes[ray.goes_down].far[1],
                  kPlanes[ray.goes_down].far[2]},
        inverse{kept16(ray.inverse[0]), kept16(ray.inverse[1]), kept16(ray.inverse[2])},
        near_shift{kept16(ray.near_shift[0]), kept16(ray.near_shift[1]), kept16(ray.near_shift[2])},
        far_shift{kept16(ray.far_shift[0]), kept16(ray.far_shift[1]), kept16(ray.far_shift[2])},
        begin(kept16(ray.begin_s)),
        end(kept16(ray.end_s)) {}

  std::ptrdiff_t near_plane[3];  ///< see PlanesOfAxes
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
  const float* planes = &bounds.plane[0][0][0];
  const auto nearPlane = [&](int i) {
    return multiplyAdd(load16(planes + ray.near_plane[i]), all16(ray.inverse[i]),
                       all16(ray.near_shift[i]));
  };
  const auto farPlane = [&](int i) {
    return multiplyAdd(load16(planes + ray.far_plane[i]), all16(ray.inverse[i]),
                       all16(ray.far_shift[i]));
  };
  near = larger(larger(nearPlane(0), nearPlane(1)), larger(nearPlane(2), all16(ray.begin)));
  const Float16 far =
      smaller(smaller(farPlane(0), farPlane(1)), smaller(farPlane(2), all16(ray.end)));
  return notAbove(near, far);
}
