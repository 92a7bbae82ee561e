// SPDX-License-Identifier: BSD-3-Clause
// One box in double, its three axes side by side: the enclosures of geometry/slabs.h.

/// Encloses the parameters of entry and exit, if there are any.
struct Times {
  double enter_lo;
  double enter_hi;
  double exit_lo;
  double exit_hi;
};

/// See bounds::kSlab. Fused operations round less often, so that its derivation covers them.
static inline Times orientedTimes(const BoxRecord& box, const RayInDouble& ray) {
  const auto column = [&](int j) { return load4(box.column[j]); };
  const auto offset = [&](int j) { return all4(ray.origin[j]) - all4(box.column[j][3]); };
  const Double4 v0 = offset(0);
  const Double4 v1 = offset(1);
  const Double4 v2 = offset(2);
  const Double4 eta = all4(exact::bounds::kSlab) *
                      ((magnitude(v0) + magnitude(v1)) + (magnitude(v2) + all4(box.extent[3])));
  const Double4 y = fused(column(2), v2, fused(column(1), v1, column(0) * v0));
  const Double4 d =
      fused(column(2), all4(ray.direction[2]),
            fused(column(1), all4(ray.direction[1]), column(0) * all4(ray.direction[0])));
  const Double4 inverse = all4(1.0) / awayFromZero(d, exact::bounds::kFlattest);
  const Double4 size = magnitude(inverse);
  const Double4 extent = load4(box.extent);
  const Double4 outer = (extent + eta) * size;
  const Double4 inner = (extent - eta) * size;
  const Double4 minus_middle = y * inverse;
  const Pair enter = largest3(all4(0.0) - minus_middle - outer, all4(0.0) - minus_middle - inner);
  const Pair exit = smallest3(inner - minus_middle, outer - minus_middle);
  return {enter.first, enter.second, exit.first, exit.second};
}

/// See bounds::kAlignedSlab and enclose(): a plane that the ray lies in, NaN, does not clip.
static inline Times alignedTimes(const BoxRecord& box, const RayInDouble& ray) {
  constexpr double kC = exact::bounds::kAlignedSlab;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Double4 origin = lanes4(ray.origin);
  const Double4 min = load4(box.column[0]);
  const Double4 max = load4(box.column[1]);
  const Double4 nears = orIfNan((choose(min, max, ray.inverse) - origin) * ray.inverse, -kInfinity);
  const Double4 fars = orIfNan((choose(max, min, ray.inverse) - origin) * ray.inverse, kInfinity);
  double near = largest3(nears, nears).first;
  const double far = smallest3(fars, fars).first;
  near = near > 0.0 ? near : 0.0;
  return {near * (1.0 - kC), near * (1.0 + kC), far * (1.0 - kC), far * (1.0 + kC)};
}

/// Within [0, ray.own_end].
static inline Times timesOf(const BoxRecord& box, const RayInDouble& ray) {
  Times t = box.isAligned() ? alignedTimes(box, ray) : orientedTimes(box, ray);
  t.enter_lo = t.enter_lo > 0.0 ? t.enter_lo : 0.0;
  t.enter_hi = t.enter_hi > 0.0 ? t.enter_hi : 0.0;
  t.exit_lo = t.exit_lo < ray.own_end ? t.exit_lo : ray.own_end;
  t.exit_hi = t.exit_hi < ray.own_end ? t.exit_hi : ray.own_end;
  return t;
}
