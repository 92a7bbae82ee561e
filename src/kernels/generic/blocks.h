// SPDX-License-Identifier: BSD-3-Clause
// A ray in float, against whole boxes, eight or sixteen at once: for lists so short that bounds
// along the axes of the world would not pay.
//
// With o, c relative to the center of the scene, w = c - o, e the half extents, R the axes, |.|_1
// sums of absolute values, S = |o|_1 + |c|_1 + |e|_1 and u = 2^-24: where the ray is in the box,
// |t d|_2 <= |w|_2 + |e|_2 <= S. There, along a box axis, in metres,
// - y = R^T w is off by 2u (|o|_1 + |c|_1) of w, by u |w|_2 of R and 3u |w|_2 of the sum: 6u S,
// - t R^T d by u of d, u of R and 3u of the sum: 5u S, and by t 2^-59 < 2^-39 S where it is raised,
// - the difference, the reciprocal and the product of (y -+ e) / |R^T d| by 3u (|y| + e) and
//   e by u e as a float: 7u S.
// Together 18u S and what is left of second order: planes are moved outward by kBlock of each part
// of S, so that what is computed begins before the exact entry and ends behind the exact exit. No
// product overflows: |y| + e < 2^43, 1 / |R^T d| <= 2^60.
//
// Moved inward by kInBlock S, what is computed is certainly in the box, at any t: as long as
// |t d|_2 <= 4 S, y is off by 6u S, t R^T d by 20u S, and the rest by 7u S and more that is of
// second order, together 41u S with the rounding of e as a float. Farther away, the point at t is
// at least 3 S from the center, along some axis at least 1.7 S, of which the computed one, off by a
// few u of it and by t 2^-59, has more than e too: it is not taken for one in the box.

/// Below it, |R^T d| is raised.
constexpr float kFlattestInBlock = 0x1p-60F;

template <typename Lanes>
static Lanes loadLanes(const float* p);
template <typename Lanes>
static Lanes allLanes(float x);
template <>
inline Float8 loadLanes<Float8>(const float* p) {
  return load8(p);
}
template <>
inline Float8 allLanes<Float8>(float x) {
  return all8(x);
}
template <>
inline Float16 loadLanes<Float16>(const float* p) {
  return load16(p);
}
template <>
inline Float16 allLanes<Float16>(float x) {
  return all16(x);
}
static inline void storeLanes(float* p, const Float8& a) {
  store8(p, a);
}
static inline void storeLanes(float* p, const Float16& a) {
  store16(p, a);
}

/// A usual ray (see ray.h) as it is compared with blocks: its parameter is t.
struct BlockRay {
  alignas(16) float origin[4];
  alignas(16) float direction[4];
  float pad;
  float outward;  ///< the pad, and the radius of the query
  float end;
};

/// @return whether the ray is a usual one
template <bool kWithin>
[[gnu::always_inline]] static inline bool prepare(const SceneView& view, const RayQuery& query,
                                                  BlockRay& ray) {
  UsualRay usual;
  if (!isUsual(view, query, usual)) {
    return false;
  }
  store(ray.origin, usual.origin);
  store(ray.direction, usual.direction);
  ray.pad = firstLane(sumOf3(magnitude(usual.origin))) *
                static_cast<float>(bounds::kBlock * bounds::kUp) +
            static_cast<float>(bounds::kFloatUnderflow);
  ray.outward = kWithin ? ray.pad + outwardBy(query.radius) : ray.pad;
  ray.end = endOf(query, usual);
  return true;
}

/// Where a ray passes the planes of boxes, as far as what follows needs it.
template <typename Lanes>
struct BlockTimes {
  Lanes near;  ///< where it enters them, not too late
  Lanes far;   ///< and leaves them, or ends, not too soon
  Lanes middle[3];
  Lanes inverse[3];
};

/// The slots from `first` on whose boxes the ray may meet before its end, a bit each, as many as
/// there are lanes.
template <typename Lanes>
[[gnu::always_inline]] static inline std::uint32_t meets(const BoxBlock& block, std::uint32_t first,
                                                         const BlockRay& ray,
                                                         BlockTimes<Lanes>& times) {
  const auto slots = [first](const float* all) { return loadLanes<Lanes>(all + first); };
  const Lanes pad = allLanes<Lanes>(ray.outward);
  Lanes w[3];
  Lanes d[3];
  for (int j = 0; j < 3; ++j) {
    w[j] = slots(block.center[j]) - allLanes<Lanes>(ray.origin[j]);
    d[j] = allLanes<Lanes>(ray.direction[j]);
  }
  Lanes nears[3];
  Lanes fars[3];
  for (int i = 0; i < 3; ++i) {
    const auto along = [&](const Lanes* v) {
      return multiplyAdd(
          slots(block.axis[i][2]), v[2],
          multiplyAdd(slots(block.axis[i][1]), v[1], slots(block.axis[i][0]) * v[0]));
    };
    const Lanes slope = along(d);
    times.inverse[i] =
        allLanes<Lanes>(1.0F) / larger(magnitude(slope), allLanes<Lanes>(kFlattestInBlock));
    times.middle[i] = withSignOf(along(w), slope);
    const Lanes extent = slots(block.extent[i]) + pad;
    nears[i] = (times.middle[i] - extent) * times.inverse[i];
    fars[i] = (times.middle[i] + extent) * times.inverse[i];
  }
  // The end of the ray is the last that is known: a root and a quotient.
  times.near = larger(larger(nears[0], nears[1]), larger(nears[2], allLanes<Lanes>(0.0F)));
  times.far = smaller(smaller(smaller(fars[0], fars[1]), fars[2]), allLanes<Lanes>(ray.end));
  return notAbove(times.near, times.far);
}

/// Where a ray certainly is in boxes: from `enter`, not too soon, to `exit`, if that is not before.
template <typename Lanes>
struct CertainTimes {
  Lanes enter;
  Lanes exit;

  [[gnu::always_inline]] CertainTimes(const BoxBlock& block, std::uint32_t first,
                                      const BlockRay& ray, const BlockTimes<Lanes>& times) {
    const auto ratio = static_cast<float>(bounds::kInBlock / bounds::kBlock);
    const Lanes pad = allLanes<Lanes>(ray.pad * ratio);
    Lanes nears[3];
    Lanes fars[3];
    for (int i = 0; i < 3; ++i) {
      const Lanes extent = loadLanes<Lanes>(block.certain[i] + first) - pad;
      nears[i] = (times.middle[i] - extent) * times.inverse[i];
      fars[i] = (times.middle[i] + extent) * times.inverse[i];
    }
    enter = larger(larger(nears[0], nears[1]), larger(nears[2], allLanes<Lanes>(0.0F)));
    exit = smaller(smaller(fars[0], fars[1]), fars[2]);
  }

  /// Whether it certainly enters one of them up to a parameter.
  [[gnu::always_inline]] bool isMetBefore(float end) const {
    return notAbove(enter, smaller(exit, allLanes<Lanes>(end))) != 0;
  }
};
