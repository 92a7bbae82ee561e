// SPDX-License-Identifier: BSD-3-Clause
// Sixteen rays in lanes, against one bound after the other. Most rays are done with what is
// compared in float; only for those that may meet a box is anything prepared in double.
//
// A ray is o + t d, o relative to the center of the scene, d raised to +-kFlattestInLanes in each
// coordinate. With u = 2^-24, S = |o|_1 + A, A the largest |p|_1 of a point p in the bounds of the
// scene: where the ray is in bounds, |t d|_2 <= |o|_2 + |p|_2 <= S. Computed as
// multiplyAdd(plane, r, -o r), r = 1 / d, in metres along the axis
// - r is off by 2u, of d and of the quotient, the product with a plane by u: 3u S,
// - -o r by u of o, 2u of r, u of the product and u of what is added to o below: 5u S,
// - the sum by u S, and the ray by t kFlattestInLanes <= 2^-39 S where d is raised.
// Together 9u S and what is left of second order: planes are moved apart by kInLanes S. No product
// overflows: |plane| and |o| < 2^61, r <= 2^60.

constexpr float kFlattestInLanes = 0x1p-60F;

struct RaysInLanes {
  Float16 inverse[3];
  Float16 shift[2][3];  ///< of the planes at the minimum and at the maximum
  Float16 end;
  Float16 squared_length;      ///< of the direction
  std::uint32_t fit;           ///< a bit for each ray for which all this holds
  std::uint32_t goes_down[3];  ///< and, of each axis, for those that go down it
};

/// The largest |p|_1 of a point in the bounds of the scene.
static inline double reachOf(const SceneView& view) {
  const Double4 size = larger(magnitude(load4(view.around[0])), magnitude(load4(view.around[1])));
  return sum3(size);
}

/// @param rays sixteen of them
template <bool kHaveEnds>
static inline void prepareLanes(const SceneView& view, const double* rays, Float16 max_range,
                                RaysInLanes& lanes) {
  const Float16 zero = all16(0.0F);
  Float16 o[3];
  Float16 d[3];
  loadRays(rays, load4(view.center), o, d);
  const Float16 reach = magnitude(o[0]) + magnitude(o[1]) + magnitude(o[2]);
  const Float16 size = magnitude(d[0]) + magnitude(d[1]) + magnitude(d[2]);
  // (Nothing is said of NaN either.)
  lanes.fit = notAbove(reach, all16(static_cast<float>(kFarthestInBlocks))) &
              notAbove(size, all16(static_cast<float>(kLongestInBlocks))) &
              notAbove(all16(static_cast<float>(1.0 / kLongestInBlocks)), size);
  const auto pad = static_cast<float>(bounds::kInLanes * bounds::kUp);
  const Float16 apart = multiplyAdd(
      reach, all16(pad),
      all16(static_cast<float>(reachOf(view)) * pad + static_cast<float>(bounds::kFloatUnderflow)));
  Float16 squared = zero;
  for (int i = 0; i < 3; ++i) {
    const Float16 steep = larger(magnitude(d[i]), all16(kFlattestInLanes));
    lanes.inverse[i] = withSignOf(all16(1.0F) / steep, d[i]);
    lanes.shift[0][i] = zero - (o[i] + apart) * lanes.inverse[i];
    lanes.shift[1][i] = (apart - o[i]) * lanes.inverse[i];
    squared = multiplyAdd(d[i], d[i], squared);
    lanes.goes_down[i] = ~notAbove(zero, lanes.inverse[i]);
  }
  lanes.squared_length = squared;
  lanes.end = multiplyAdd(overRoot(max_range, squared), all16(static_cast<float>(bounds::kUp)),
                          all16(static_cast<float>(bounds::kFloatUnderflow)));
  if constexpr (kHaveEnds) {
    lanes.end = smaller(lanes.end, all16(1.0F));
  }
}

/// The planes of one bound, as they lie in memory.
struct OneBound {
  const float* planes;
  int distance;

  OneBound(const Bounds& bounds, int slot) : planes(&bounds.plane[0][0][slot]), distance(kSlots) {}
  /// @param six minimum and maximum, one after the other
  explicit OneBound(const float* six) : planes(six), distance(1) {}

  Float16 lo(int axis) const { return all16(planes[axis * distance]); }
  Float16 hi(int axis) const { return all16(planes[(3 + axis) * distance]); }
};

/// The rays that may meet a bound, which is not empty, before they end, a bit each. (Inlined, so
/// that the rays stay in registers.)
/// @param near where they enter it, not too late
/// @param far where they leave it, or end, not too soon
[[gnu::always_inline]] static inline std::uint32_t meets(const OneBound& bound,
                                                         const RaysInLanes& rays, Float16& near,
                                                         Float16& far) {
  Float16 nears[3];
  Float16 fars[3];
  for (int i = 0; i < 3; ++i) {
    const Float16 lo = multiplyAdd(bound.lo(i), rays.inverse[i], rays.shift[0][i]);
    const Float16 hi = multiplyAdd(bound.hi(i), rays.inverse[i], rays.shift[1][i]);
    nears[i] = smaller(lo, hi);
    fars[i] = larger(lo, hi);
  }
  near = larger(larger(nears[0], nears[1]), larger(nears[2], all16(0.0F)));
  far = smaller(smaller(fars[0], fars[1]), smaller(fars[2], rays.end));
  return notAbove(near, far);
}
[[gnu::always_inline]] static inline std::uint32_t meets(const OneBound& bound,
                                                         const RaysInLanes& rays, Float16& near) {
  Float16 far;
  return meets(bound, rays, near, far);
}

/// The same rays one by one, against sixteen bounds at once.
struct RaysOfLanes {
  alignas(64) float inverse[3][kSlots];
  alignas(64) float shift[2][3][kSlots];
  alignas(64) float end[kSlots];
  std::uint32_t goes_down[3];

  RaysOfLanes() = default;
  explicit RaysOfLanes(const RaysInLanes& lanes) {
    for (int i = 0; i < 3; ++i) {
      store16(inverse[i], lanes.inverse[i]);
      store16(shift[0][i], lanes.shift[0][i]);
      store16(shift[1][i], lanes.shift[1][i]);
      goes_down[i] = lanes.goes_down[i];
    }
    store16(end, lanes.end);
  }
};

[[gnu::always_inline]] static inline std::uint32_t meets(const Bounds& bounds,
                                                         const RaysOfLanes& rays, std::uint32_t ray,
                                                         Float16& near) {
  Float16 planes[2][3];
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t side = rays.goes_down[i] >> ray & 1;
    planes[0][i] = multiplyAdd(load16(bounds.plane[side][i]), all16(rays.inverse[i][ray]),
                               all16(rays.shift[side][i][ray]));
    planes[1][i] = multiplyAdd(load16(bounds.plane[1 - side][i]), all16(rays.inverse[i][ray]),
                               all16(rays.shift[1 - side][i][ray]));
  }
  near = larger(larger(planes[0][0], planes[0][1]), larger(planes[0][2], all16(0.0F)));
  const Float16 far =
      smaller(smaller(planes[1][0], planes[1][1]), smaller(planes[1][2], all16(rays.end[ray])));
  return notAbove(near, far);
}

/// What searches of sixteen rays have in common.
template <typename Ask>
class LaneSearch {
 public:
  using Visit = typename Ask::Visit;

  LaneSearch(const SceneView& view, const RayQueries& queries, const Delivery& to)
      : view_(view), queries_(queries), to_(to) {}

 protected:
  /// Takes up rays.
  /// @return a bit for each that can be in lanes
  std::uint32_t takeUp(std::size_t first, int count) {
    first_ = first;
    begun_ = 0;
    prepareLanes<Ask::kHaveEnds>(view_, raysFrom(first, count), rangesFrom(first, count), lanes_);
    return lanes_.fit & ((1U << count) - 1);
  }

  [[gnu::always_inline]] void visit(int ray, std::uint32_t record, float near) {
    Companion<Visit>& c = rays_[ray];
    if ((begun_ >> ray & 1) == 0) {
      begin(ray, c);
    }
    if (near <= c.inFloat().end_s * static_cast<float>(bounds::kFarther) && !c.visit(record)) {
      c.inFloat().end_s = -1.0F;  // nothing lies before it
    }
  }

  void deliver(int ray) {
    Companion<Visit>& c = rays_[ray];
    to_.take(c.number, is_taken_ >> ray & 1 ? Ask::answerOf(c) : Answer::kNotTaken, c.gave_up,
             c.found);
  }

  void askEachAlone(std::uint32_t rays) {
    for (; rays != 0; rays &= rays - 1) {
      askAlone<Ask>(view_, queries_, first_ + static_cast<std::size_t>(lowestBit(rays)), to_);
    }
  }

  const SceneView& view_;
  const RayQueries& queries_;
  const Delivery& to_;
  RaysInLanes lanes_;
  Companion<Visit> rays_[kSlots];
  std::size_t first_ = 0;
  std::uint32_t begun_ = 0;  ///< a bit for each ray for which something was prepared in double

 private:
  /// Sixteen rays, the last of them again where there are fewer.
  const double* raysFrom(std::size_t first, int count) {
    const double* rays = queries_.rays + 6 * first;
    if (count == kSlots) {
      return rays;
    }
    for (int k = 0; k < kSlots; ++k) {
      const double* ray = rays + 6 * (k < count ? k : count - 1);
      for (int i = 0; i < 6; ++i) {
        copies_[6 * k + i] = ray[i];
      }
    }
    return copies_;
  }
  Float16 rangesFrom(std::size_t first, int count) const {
    if (queries_.range_distance == 0) {
      return all16(static_cast<float>(queries_.maxRange(0)));
    }
    alignas(64) float ranges[kSlots];
    for (int k = 0; k < kSlots; ++k) {
      ranges[k] = static_cast<float>(
          queries_.maxRange(first + static_cast<std::size_t>(k < count ? k : count - 1)));
    }
    return load16(ranges);
  }

  [[gnu::always_inline]] void begin(int ray, Companion<Visit>& c) {
    c.number = first_ + static_cast<std::size_t>(ray);
    c.query = queries_.query(c.number, Ask::kHaveEnds);
    c.gave_up = false;
    c.found.count = 0;
    c.found.work = Work();
    c.inFloat().scale = 1.0;
    const bool taken = prepareInDouble(view_, c.query, partsOf(view_, c.query), c.ray);
    c.found.t_inside = c.ray.t_inside;
    c.inFloat().setRange(0.0F, taken ? c.inFloat().roundedUp(c.ray.t_end) : -1.0F);
    c.visit = Ask::visitOf(view_, c);
    begun_ |= 1U << ray;
    is_taken_ = (is_taken_ & ~(1U << ray)) | (static_cast<std::uint32_t>(taken) << ray);
  }

  double copies_[6 * kSlots];
  std::uint32_t is_taken_ = 0;  ///< of those begun, for which it could be
};
