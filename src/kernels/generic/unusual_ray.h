// SPDX-License-Identifier: BSD-3-Clause
// A ray that is not a usual one, very far away or of a very long or short direction, prepared for
// bounds.
//
// Its parameter is s = t |d|_max, so that along the dominant axis it is metres, and r_i = |d|_max /
// d_i is at least 1. With o relative to the center of the scene, and u = 2^-24, the planes of axis
// i are at s = plane r_i - o r_i. Computed as multiplyAdd(plane, r_i, shift), r_i off by 1.1u, the
// shift by 1.1u |o r_i|, two roundings: since |plane r_i| <= |s| + |o r_i|, off by at most
// 4.2u |s| + 5.3u |o r_i|, where it matters |s| <= s_end. Both parts are in the shifts
// (kAlongError, kShiftError).
//
// An axis along which the ray hardly goes, |d_i| < 2^-40 |d|_max, has r_i = +-2^40 and moves by
// less than s_end / |r_i|: its planes are moved apart by twice s_end (where the ray is between
// them, or reaches one, they clip nothing before s_end).

constexpr double kSteepest = 0x1p40;

static inline Double4 doublesOf(const float* three) {
  const double numbers[3] = {three[0], three[1], three[2]};
  return lanes4(numbers);
}

[[gnu::noinline]] static Outcome prepareUnusual(const SceneView& view, const RayQuery& query,
                                                FloatRay& f) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  RayInDouble ray;
  const Double4 direction = directionOf(query);
  const Double4 size = magnitude(direction);
  const Double4 relative = lanes4(query.origin) - load4(view.center);
  if (!prepare(query, false, ray) || notBelow3(all4(kFarthestOrigin), magnitude(relative)) != 7U) {
    return Outcome::kNotTaken;
  }
  const Double4 scale = larger(larger(size, turned(size)), turnedTwice(size));
  f.scale = firstLane(scale);
  const Double4 is_flat = isNotBelow(scale, all4(kSteepest) * size);
  const Double4 inverse =
      choose(scale / direction, withSignOf(all4(kSteepest), direction), is_flat);
  const Double4 shift = relative * inverse;
  Double4 apart = fused(magnitude(shift), all4(bounds::kShiftError),
                        all4(bounds::kFloatUnderflow) * magnitude(inverse));
  // Clipped to the bounds of the scene, for as few stretches as can be, and so that the end is
  // finite where planes are moved by it.
  const Double4 lo = doublesOf(view.around[0]);
  const Double4 hi = doublesOf(view.around[1]);
  const Double4 near = (choose(lo, hi, direction) - relative) * inverse;
  const Double4 far = (choose(hi, lo, direction) - relative) * inverse;
  const Double4 nearest = (near - apart) - all4(bounds::kShiftError) * magnitude(near);
  const Double4 farthest = (far + apart) + all4(bounds::kShiftError) * magnitude(far);
  const double first = largest3(choose(nearest, all4(-kInfinity), is_flat), nearest).first;
  const double last = smallest3(choose(farthest, all4(kInfinity), is_flat), farthest).first;
  const double begin = first > 0.0 ? first : 0.0;
  const double whole = reachOf(query).outside * f.scale * bounds::kUp;
  const double end = last < whole ? last : whole;
  if (begin > end) {
    return Outcome::kMiss;
  }
  apart = apart + choose(all4(bounds::kAlongError * end), all4(bounds::kFlat * end), is_flat);
  store(f.inverse, floatsOf(inverse));
  store(f.near_shift, floatsOf(negated(shift) - apart));
  store(f.far_shift, floatsOf(apart - shift));
  f.goes_down = signs3(direction);
  f.stretch_s = firstStretch(view);
  f.certain_end = -1.0F;
  f.setRange(static_cast<float>(begin * (1.0 - bounds::kShiftError)),
             static_cast<float>(end * bounds::kUp + bounds::kFloatUnderflow));
  return Outcome::kReady;
}

/// Prepares any ray for the bounds of a scene; with a radius, a usual one.
template <bool kWithin>
[[gnu::always_inline]] static inline Outcome prepare(const SceneView& view, const RayQuery& query,
                                                     FloatRay& f, bool in_stretches) {
  const Outcome usual = prepareUsual<kWithin>(view, query, f, in_stretches);
  return usual == Outcome::kNotTaken && !kWithin ? prepareUnusual(view, query, f) : usual;
}
