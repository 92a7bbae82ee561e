// SPDX-License-Identifier: BSD-3-Clause
// Sixteen usual rays in lanes, against one bound after the other: their numbers are those of ray.h.

struct RaysInLanes {
  Float16 inverse[3];
  Float16 shift[2][3];  ///< of the planes at the minimum and at the maximum
  Float16 end;
  Float16 squared_length;  ///< of the direction
  std::uint32_t fit;       ///< a bit for each ray that is a usual one
};

/// @param rays sixteen of them
/// @param outward how far bounds are moved outward, where kWithin
template <bool kAreSegments, bool kWithin>
static inline void prepareLanes(const SceneView& view, const double* rays, Float16 max_range,
                                float outward, RaysInLanes& lanes) {
  const Float16 zero = all16(0.0F);
  Float16 o[3];
  Float16 d[3];
  loadRays<kAreSegments>(rays, load4(view.center), o, d);
  const auto largest = [](const Float16* v) {
    return larger(larger(magnitude(v[0]), magnitude(v[1])), magnitude(v[2]));
  };
  const Float16 size = largest(d);
  // (Nothing is said of NaN either.)
  lanes.fit = notAbove(largest(o), all16(kUsualDistance)) & notAbove(size, all16(kUsualLength)) &
              notAbove(all16(1.0F / kUsualLength), size);
  Float16 apart =
      multiplyAdd(magnitude(o[0]) + magnitude(o[1]) + magnitude(o[2]),
                  all16(static_cast<float>(bounds::kApart * bounds::kUp)), all16(view.apart));
  if constexpr (kWithin) {
    apart = apart + all16(outward);
  }
  Float16 squared = zero;
  for (int i = 0; i < 3; ++i) {
    const Float16 steep = larger(magnitude(d[i]), all16(kFlattest));
    lanes.inverse[i] = withSignOf(all16(1.0F) / steep, d[i]);
    lanes.shift[0][i] = zero - (o[i] + apart) * lanes.inverse[i];
    lanes.shift[1][i] = (apart - o[i]) * lanes.inverse[i];
    squared = multiplyAdd(d[i], d[i], squared);
  }
  lanes.squared_length = squared;
  lanes.end = multiplyAdd(overRoot(max_range, squared), all16(static_cast<float>(bounds::kUp)),
                          all16(static_cast<float>(bounds::kFloatUnderflow)));
  if constexpr (kAreSegments) {
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
  alignas(64) float near_shift[3][kSlots];
  alignas(64) float far_shift[3][kSlots];
  alignas(64) float end[kSlots];
  // Of Bounds, counted in floats:
  alignas(64) std::uint32_t near_plane[3][kSlots];
  alignas(64) std::uint32_t far_plane[3][kSlots];

  RaysOfLanes() = default;
  explicit RaysOfLanes(const RaysInLanes& lanes) {
    for (int i = 0; i < 3; ++i) {
      const Float16 goes = lanes.inverse[i];
      const Float16 lo = bitsOfAll(i * kSlots);
      const Float16 hi = bitsOfAll((3 + i) * kSlots);
      store16(inverse[i], goes);
      store16(near_shift[i], choose(lanes.shift[0][i], lanes.shift[1][i], goes));
      store16(far_shift[i], choose(lanes.shift[1][i], lanes.shift[0][i], goes));
      storeBits(near_plane[i], choose(lo, hi, goes));
      storeBits(far_plane[i], choose(hi, lo, goes));
    }
    store16(end, lanes.end);
  }

 private:
  static Float16 bitsOfAll(int number) {
    float bits = 0.0F;
    __builtin_memcpy(&bits, &number, sizeof(bits));
    return all16(bits);
  }
  static void storeBits(std::uint32_t* p, const Float16& bits) {
    alignas(64) float all[kSlots];
    store16(all, bits);
    __builtin_memcpy(p, all, sizeof(all));
  }
};

[[gnu::always_inline]] static inline std::uint32_t meets(const Bounds& bounds,
                                                         const RaysOfLanes& rays, std::uint32_t ray,
                                                         Float16& near) {
  const float* planes = &bounds.plane[0][0][0];
  Float16 nears[3];
  Float16 fars[3];
  for (int i = 0; i < 3; ++i) {
    const Float16 inverse = all16(rays.inverse[i][ray]);
    nears[i] = multiplyAdd(load16(planes + rays.near_plane[i][ray]), inverse,
                           all16(rays.near_shift[i][ray]));
    fars[i] = multiplyAdd(load16(planes + rays.far_plane[i][ray]), inverse,
                          all16(rays.far_shift[i][ray]));
  }
  near = larger(larger(nears[0], nears[1]), larger(nears[2], all16(0.0F)));
  const Float16 far = smaller(smaller(fars[0], fars[1]), smaller(fars[2], all16(rays.end[ray])));
  return notAbove(near, far);
}

/// What searches of sixteen rays have in common.
template <typename What>
class LaneSearch {
 public:
  using Visit = typename What::Visit;

  LaneSearch(const SceneView& view, const RayQueries& queries, const Delivery& to)
      : view_(view), queries_(queries), to_(to) {}

 protected:
  /// Takes up rays.
  /// @return a bit for each that can be in lanes
  std::uint32_t takeUp(std::size_t first, int count) {
    first_ = first;
    begun_ = 0;
    prepareLanes<What::kAreSegments, Visit::kWithin>(view_, raysFrom(first, count),
                                                     rangesFrom(first, count),
                                                     outwardBy(queries_.radius), lanes_);
    store16(ends_, lanes_.end);
    return lanes_.fit & ((1U << count) - 1);
  }

  [[gnu::always_inline]] void visit(int ray, std::uint32_t record, float near) {
    Companion<Visit>& c = rays_[ray];
    if ((begun_ >> ray & 1) == 0) {
      begin(ray, c);
    }
    if (near <= c.in_float.end_s && !c.visit(record)) {
      c.in_float.end_s = -1.0F;  // nothing lies before it
    }
  }

  void deliver(int ray) {
    Companion<Visit>& c = rays_[ray];
    to_.take(c.number, c.visit.answer(), c.found);
  }

  void askEachAlone(std::uint32_t rays) {
    for (; rays != 0; rays &= rays - 1) {
      const std::size_t number = first_ + static_cast<std::size_t>(lowestBit(rays));
      if constexpr (Visit::kWithin) {  // it would not be taken
        to_.take(number, Answer::kNotTaken, Found(&to_.work));
      } else {
        askAlone<What>(view_, queries_, number, to_);
      }
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
    const std::size_t number = first_ + static_cast<std::size_t>(ray);
    c.in_float.scale = 1.0;
    c.in_float.setRange(0.0F, std::numeric_limits<float>::infinity());
    c.in_float.certain_end = certainEnd(ends_[ray]);
    to_.begin(view_, queries_.query(number, What::kAreSegments), number, c);
    if (!c.visit.begin()) {
      c.in_float.end_s = -1.0F;
    }
    begun_ |= 1U << ray;
  }

  alignas(64) float ends_[kSlots];
  double copies_[6 * kSlots];
};
