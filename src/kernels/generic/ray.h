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

constexpr double kShiftError = 0x1p-20;
constexpr float kFarther = 1.0F + 0x1p-20F;
/// The same for numbers that are rounded up by it.
constexpr double kUp = 1.0 + 0x1p-20;
constexpr double kSteepest = 0x1p40;
/// More than what is lost where floats underflow.
constexpr double kFloatUnderflow = 0x1p-100;

struct FloatRay {
  int near_side[3];
  Float16 inverse[3];
  Float16 near_shift[3];
  Float16 far_shift[3];
  Float16 begin;
  Float16 end;
  float begin_s;
  float end_s;
  double scale;  ///< |d|_max: s = t * scale

  void setRange(float from, float to) {
    begin_s = from;
    end_s = to;
    begin = all16(from);
    end = all16(to);
  }
  /// Parameter t in s, rounded up.
  float roundedUp(double t) const { return static_cast<float>(t * scale * kUp + kFloatUnderflow); }
};

/// Prepares a ray for the bounds of a scene.
/// @return false if it certainly meets none of them up to query.t_end
static inline bool prepare(const SceneView& view, const RayQuery& query, FloatRay& ray) {
  double origin[3];
  double inverse[3];
  bool flat[3];
  const double size[3] = {std::fabs(query.direction[0]), std::fabs(query.direction[1]),
                          std::fabs(query.direction[2])};
  const double larger_of_two = size[0] > size[1] ? size[0] : size[1];
  ray.scale = larger_of_two > size[2] ? larger_of_two : size[2];
  double begin = 0.0;
  double end = query.t_end * ray.scale * kUp;
  for (int i = 0; i < 3; ++i) {
    origin[i] = query.origin[i] - view.center[i];
    flat[i] = size[i] * kSteepest < ray.scale;
    inverse[i] =
        flat[i] ? (query.negative[i] ? -kSteepest : kSteepest) : ray.scale / query.direction[i];
    ray.near_side[i] = query.negative[i] ? 1 : 0;
    if (!flat[i]) {
      const double near = (view.around[ray.near_side[i]][i] - origin[i]) * inverse[i];
      const double far = (view.around[1 - ray.near_side[i]][i] - origin[i]) * inverse[i];
      const double shift_error = kShiftError * std::fabs(origin[i] * inverse[i]) + kFloatUnderflow;
      const double nearest = near - kShiftError * std::fabs(near) - shift_error;
      const double farthest = far + kShiftError * std::fabs(far) + shift_error;
      begin = begin > nearest ? begin : nearest;
      end = end < farthest ? end : farthest;
    }
  }
  if (begin > end) {
    return false;
  }
  for (int i = 0; i < 3; ++i) {
    const double shift = -(origin[i] * inverse[i]);
    const double error = kShiftError * std::fabs(shift) + kFloatUnderflow * std::fabs(inverse[i]) +
                         (flat[i] ? 2.1 * end : 0.0);
    ray.inverse[i] = all16(static_cast<float>(inverse[i]));
    ray.near_shift[i] = all16(static_cast<float>(shift - error));
    ray.far_shift[i] = all16(static_cast<float>(shift + error));
  }
  ray.setRange(static_cast<float>(begin * (1.0 - kShiftError)),
               static_cast<float>(end * kUp + kFloatUnderflow));
  return true;
}

/// The slots whose bounds the ray may meet between its begin and its end, a bit each.
/// @param near where it enters them, too early by at most what the floats cannot tell
static inline std::uint32_t meets(const Bounds& bounds, const FloatRay& ray, Float16& near) {
  const auto nearPlane = [&](int i) {
    return multiplyAdd(load16(bounds.plane[ray.near_side[i]][i]), ray.inverse[i],
                       ray.near_shift[i]);
  };
  const auto farPlane = [&](int i) {
    return multiplyAdd(load16(bounds.plane[1 - ray.near_side[i]][i]), ray.inverse[i],
                       ray.far_shift[i]);
  };
  near = larger(larger(nearPlane(0), nearPlane(1)), larger(nearPlane(2), ray.begin));
  const Float16 far = smaller(smaller(farPlane(0), farPlane(1)), smaller(farPlane(2), ray.end));
  return notAbove(near, far * all16(kFarther));
}
