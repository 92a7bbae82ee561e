// SPDX-License-Identifier: BSD-3-Clause
// Sixteen floats in two AVX registers. Included in a target region.

struct Float16 {
  __m256 lo;
  __m256 hi;
};

static inline Float16 load16(const float* p) {
  return {_mm256_load_ps(p), _mm256_load_ps(p + 8)};
}
static inline Float16 all16(float x) {
  return {_mm256_set1_ps(x), _mm256_set1_ps(x)};
}
static inline void store16(float* p, Float16 a) {
  _mm256_storeu_ps(p, a.lo);
  _mm256_storeu_ps(p + 8, a.hi);
}
/// a * b + c, rounded once or twice.
static inline Float16 multiplyAdd(Float16 a, Float16 b, Float16 c) {
  return {_mm256_fmadd_ps(a.lo, b.lo, c.lo), _mm256_fmadd_ps(a.hi, b.hi, c.hi)};
}
static inline Float16 operator*(Float16 a, Float16 b) {
  return {_mm256_mul_ps(a.lo, b.lo), _mm256_mul_ps(a.hi, b.hi)};
}
static inline Float16 operator+(Float16 a, Float16 b) {
  return {_mm256_add_ps(a.lo, b.lo), _mm256_add_ps(a.hi, b.hi)};
}
static inline Float16 operator-(Float16 a, Float16 b) {
  return {_mm256_sub_ps(a.lo, b.lo), _mm256_sub_ps(a.hi, b.hi)};
}
static inline Float16 operator/(Float16 a, Float16 b) {
  return {_mm256_div_ps(a.lo, b.lo), _mm256_div_ps(a.hi, b.hi)};
}
/// a / b, off by less than 2^-11 of it.
static inline Float16 roughQuotient(Float16 a, Float16 b) {
  return {_mm256_mul_ps(a.lo, _mm256_rcp_ps(b.lo)), _mm256_mul_ps(a.hi, _mm256_rcp_ps(b.hi))};
}
/// a / sqrt(b), off by less than 8u of it.
static inline Float16 overRoot(Float16 a, Float16 b) {
  return {overRoot(Float8{a.lo}, Float8{b.lo}).v, overRoot(Float8{a.hi}, Float8{b.hi}).v};
}
/// a where b is not 0.
static inline Float16 orZeroWhereZero(Float16 a, Float16 b) {
  const __m256 zero = _mm256_setzero_ps();
  return {_mm256_and_ps(_mm256_cmp_ps(b.lo, zero, _CMP_NEQ_OQ), a.lo),
          _mm256_and_ps(_mm256_cmp_ps(b.hi, zero, _CMP_NEQ_OQ), a.hi)};
}
/// (Of a NaN and b, b.)
static inline Float16 larger(Float16 a, Float16 b) {
  return {_mm256_max_ps(a.lo, b.lo), _mm256_max_ps(a.hi, b.hi)};
}
static inline Float16 smaller(Float16 a, Float16 b) {
  return {_mm256_min_ps(a.lo, b.lo), _mm256_min_ps(a.hi, b.hi)};
}
/// The smallest lane, where none is NaN.
static inline float smallestLane(Float16 a) {
  return smallestLane(Float8{_mm256_min_ps(a.lo, a.hi)});
}
/// a but for one lane, which is +inf.
static inline Float16 withInfinity(Float16 a, int lane) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  static const float there[2 * kSlots - 1] = {
      -kInf, -kInf, -kInf, -kInf, -kInf, -kInf, -kInf, -kInf, -kInf, -kInf, -kInf,
      -kInf, -kInf, -kInf, -kInf, kInf,  -kInf, -kInf, -kInf, -kInf, -kInf, -kInf,
      -kInf, -kInf, -kInf, -kInf, -kInf, -kInf, -kInf, -kInf, -kInf};
  const float* from = there + (kSlots - 1 - lane);
  return {_mm256_max_ps(a.lo, _mm256_loadu_ps(from)),
          _mm256_max_ps(a.hi, _mm256_loadu_ps(from + 8))};
}
/// A bit for every lane in which a <= b.
static inline std::uint32_t notAbove(Float16 a, Float16 b) {
  const int lo = _mm256_movemask_ps(_mm256_cmp_ps(a.lo, b.lo, _CMP_LE_OQ));
  const int hi = _mm256_movemask_ps(_mm256_cmp_ps(a.hi, b.hi, _CMP_LE_OQ));
  return static_cast<std::uint32_t>(lo) | (static_cast<std::uint32_t>(hi) << 8);
}

/// Appends `base` + slot for every slot of `bits`.
static inline int append(std::uint32_t bits, std::uint32_t base, std::uint32_t* list, int count) {
  for (; bits != 0; bits &= bits - 1) {
    list[count++] = base + static_cast<std::uint32_t>(lowestBit(bits));
  }
  return count;
}
/// The same with where each is entered.
static inline int append(std::uint32_t bits, std::uint32_t base, Float16 near, std::uint32_t* list,
                         float* nears, int count) {
  alignas(64) float all[kSlots];
  store16(all, near);
  for (; bits != 0; bits &= bits - 1) {
    const int slot = lowestBit(bits);
    nears[count] = all[slot];
    list[count++] = base + static_cast<std::uint32_t>(slot);
  }
  return count;
}
