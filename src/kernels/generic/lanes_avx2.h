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
/// A number for all lanes, as it is best kept for long: there already.
using Kept16 = Float16;
static inline Kept16 kept16(float x) {
  return all16(x);
}
static inline Float16 all16(Kept16 x) {
  return x;
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
/// a / sqrt(b), off by less than 2^-11 of it.
static inline Float16 roughOverRoot(Float16 a, Float16 b) {
  return {_mm256_mul_ps(a.lo, _mm256_rsqrt_ps(b.lo)), _mm256_mul_ps(a.hi, _mm256_rsqrt_ps(b.hi))};
}
/// a where b is not 0.
static inline Float16 orZeroWhereZero(Float16 a, Float16 b) {
  const __m256 zero = _mm256_setzero_ps();
  return {_mm256_and_ps(_mm256_cmp_ps(b.lo, zero, _CMP_NEQ_OQ), a.lo),
          _mm256_and_ps(_mm256_cmp_ps(b.hi, zero, _CMP_NEQ_OQ), a.hi)};
}
static inline Float16 magnitude(Float16 a) {
  return {magnitude(Float8{a.lo}).v, magnitude(Float8{a.hi}).v};
}
/// a times -1 where b is negative.
static inline Float16 withSignOf(Float16 a, Float16 b) {
  return {withSignOf(Float8{a.lo}, Float8{b.lo}).v, withSignOf(Float8{a.hi}, Float8{b.hi}).v};
}
/// (Of a NaN and b, b.)
static inline Float16 larger(Float16 a, Float16 b) {
  return {_mm256_max_ps(a.lo, b.lo), _mm256_max_ps(a.hi, b.hi)};
}
static inline Float16 smaller(Float16 a, Float16 b) {
  return {_mm256_min_ps(a.lo, b.lo), _mm256_min_ps(a.hi, b.hi)};
}
/// Lanes of b where `negative` is, of a elsewhere; as they are, whatever they stand for.
static inline Float16 choose(Float16 a, Float16 b, Float16 negative) {
  return {_mm256_blendv_ps(a.lo, b.lo, negative.lo), _mm256_blendv_ps(a.hi, b.hi, negative.hi)};
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

static inline float lane(Float16 a, int i) {
  const __m256i at = _mm256_set1_epi32(i % 8);
  return _mm256_cvtss_f32(_mm256_permutevar8x32_ps(i < 8 ? a.lo : a.hi, at));
}

/// The slots of eight bits, in order, for every value of the bits.
struct SlotTable {
  std::uint8_t slots[256][8];
};
static constexpr SlotTable makeSlotTable() {
  SlotTable table = {};
  for (int bits = 0; bits < 256; ++bits) {
    int count = 0;
    for (int slot = 0; slot < 8; ++slot) {
      if ((bits >> slot & 1) != 0) {
        table.slots[bits][count++] = static_cast<std::uint8_t>(slot);
      }
    }
  }
  return table;
}
alignas(64) constexpr SlotTable kSlotTable = makeSlotTable();

static inline __m256i slotsOf(std::uint32_t bits) {
  return _mm256_cvtepu8_epi32(
      _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kSlotTable.slots[bits])));
}
static inline void storeSlots(__m256i slots, std::uint32_t base, std::uint32_t* list) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(list),
                      _mm256_add_epi32(slots, _mm256_set1_epi32(static_cast<int>(base))));
}

/// Appends `base` + slot for every slot of `bits`. Up to kSlots entries behind the last one are
/// written to.
static inline int append(std::uint32_t bits, std::uint32_t base, std::uint32_t* list, int count) {
  storeSlots(slotsOf(bits & 0xff), base, list + count);
  count += __builtin_popcount(bits & 0xff);
  storeSlots(slotsOf(bits >> 8), base + 8, list + count);
  return count + __builtin_popcount(bits >> 8);
}
/// The same with where each is entered.
static inline int append(std::uint32_t bits, std::uint32_t base, Float16 near, std::uint32_t* list,
                         float* nears, int count) {
  const __m256i low = slotsOf(bits & 0xff);
  const __m256i high = slotsOf(bits >> 8);
  const int middle = count + __builtin_popcount(bits & 0xff);
  storeSlots(low, base, list + count);
  _mm256_storeu_ps(nears + count, _mm256_permutevar8x32_ps(near.lo, low));
  storeSlots(high, base + 8, list + middle);
  _mm256_storeu_ps(nears + middle, _mm256_permutevar8x32_ps(near.hi, high));
  return middle + __builtin_popcount(bits >> 8);
}

/// Sixteen rays in lanes: origins relative to a center, and directions, of six numbers a ray:
/// origin and direction, or start and end.
template <bool kAreSegments>
static inline void loadRays(const double* rays, Double4 center, Float16* origin,
                            Float16* direction) {
  FourRays four[4];
  for (int k = 0; k < 4; ++k) {
    four[k] = loadFourRays<kAreSegments>(rays + 24 * k, center);
  }
  for (int i = 0; i < 3; ++i) {
    origin[i] = {_mm256_set_m128(four[1].origin[i], four[0].origin[i]),
                 _mm256_set_m128(four[3].origin[i], four[2].origin[i])};
    direction[i] = {_mm256_set_m128(four[1].direction[i], four[0].direction[i]),
                    _mm256_set_m128(four[3].direction[i], four[2].direction[i])};
  }
}

/// What boxes of a block are compared in, where there are more than eight.
using BlockLanes = Float8;

/// Whether two vectors are sooner worked on in one register.
constexpr bool kTwoAtOnce = false;

/// Eight doubles in two AVX registers.
struct Double8 {
  __m256d v[2];
};

static inline Double8 load8(const double* p) {
  return {{_mm256_load_pd(p), _mm256_load_pd(p + 4)}};
}
static inline Double8 all8(double x) {
  return {{_mm256_set1_pd(x), _mm256_set1_pd(x)}};
}
static inline Double8 operator+(const Double8& a, const Double8& b) {
  return {{_mm256_add_pd(a.v[0], b.v[0]), _mm256_add_pd(a.v[1], b.v[1])}};
}
static inline Double8 operator-(const Double8& a, const Double8& b) {
  return {{_mm256_sub_pd(a.v[0], b.v[0]), _mm256_sub_pd(a.v[1], b.v[1])}};
}
static inline Double8 operator*(const Double8& a, const Double8& b) {
  return {{_mm256_mul_pd(a.v[0], b.v[0]), _mm256_mul_pd(a.v[1], b.v[1])}};
}
static inline Double8 operator/(const Double8& a, const Double8& b) {
  return {{_mm256_div_pd(a.v[0], b.v[0]), _mm256_div_pd(a.v[1], b.v[1])}};
}
/// a * b + c
static inline Double8 fused(const Double8& a, const Double8& b, const Double8& c) {
  return {{_mm256_fmadd_pd(a.v[0], b.v[0], c.v[0]), _mm256_fmadd_pd(a.v[1], b.v[1], c.v[1])}};
}
/// The rest of the product p = a * b, exactly, where nothing underflows.
static inline Double8 restOfProduct(const Double8& a, const Double8& b, const Double8& p) {
  return {{_mm256_fmsub_pd(a.v[0], b.v[0], p.v[0]), _mm256_fmsub_pd(a.v[1], b.v[1], p.v[1])}};
}
static inline Double8 negated(const Double8& a) {
  return {
      {_mm256_xor_pd(a.v[0], _mm256_set1_pd(-0.0)), _mm256_xor_pd(a.v[1], _mm256_set1_pd(-0.0))}};
}
static inline Double8 magnitude(const Double8& a) {
  return {{_mm256_andnot_pd(_mm256_set1_pd(-0.0), a.v[0]),
           _mm256_andnot_pd(_mm256_set1_pd(-0.0), a.v[1])}};
}
/// a times -1 where b is negative.
static inline Double8 withSignOf(const Double8& a, const Double8& b) {
  return {{_mm256_xor_pd(a.v[0], _mm256_and_pd(b.v[0], _mm256_set1_pd(-0.0))),
           _mm256_xor_pd(a.v[1], _mm256_and_pd(b.v[1], _mm256_set1_pd(-0.0)))}};
}
/// (Of equal ones, b.)
static inline Double8 larger(const Double8& a, const Double8& b) {
  return {{_mm256_max_pd(a.v[0], b.v[0]), _mm256_max_pd(a.v[1], b.v[1])}};
}
static inline Double8 smaller(const Double8& a, const Double8& b) {
  return {{_mm256_min_pd(a.v[0], b.v[0]), _mm256_min_pd(a.v[1], b.v[1])}};
}
static inline Double8 squareRoot(const Double8& a) {
  return {{_mm256_sqrt_pd(a.v[0]), _mm256_sqrt_pd(a.v[1])}};
}

/// Lane i of the k-th is lane k of the i-th then.
static inline void transpose4(const __m256d (&from)[4], __m256d (&to)[4]) {
  const __m256d even[2] = {_mm256_unpacklo_pd(from[0], from[1]),
                           _mm256_unpacklo_pd(from[2], from[3])};
  const __m256d odd[2] = {_mm256_unpackhi_pd(from[0], from[1]),
                          _mm256_unpackhi_pd(from[2], from[3])};
  to[0] = _mm256_permute2f128_pd(even[0], even[1], 0x20);
  to[1] = _mm256_permute2f128_pd(odd[0], odd[1], 0x20);
  to[2] = _mm256_permute2f128_pd(even[0], even[1], 0x31);
  to[3] = _mm256_permute2f128_pd(odd[0], odd[1], 0x31);
}
/// The same of eight rows and four columns, and back.
static inline void transpose(const Double4* rows, Double8* columns) {
  for (int half = 0; half < 2; ++half) {
    const Double4* four = rows + 4 * half;
    __m256d to[4];
    transpose4({four[0].v, four[1].v, four[2].v, four[3].v}, to);
    for (int k = 0; k < 4; ++k) {
      columns[k].v[half] = to[k];
    }
  }
}
static inline void transpose(const Double8* columns, Double4* rows) {
  for (int half = 0; half < 2; ++half) {
    __m256d to[4];
    transpose4({columns[0].v[half], columns[1].v[half], columns[2].v[half], columns[3].v[half]},
               to);
    for (int k = 0; k < 4; ++k) {
      rows[4 * half + k].v = to[k];
    }
  }
}

/// Lanes in which something holds.
struct Mask8 {
  __m256d v[2];
};
static inline std::uint32_t bitsOf(const Mask8& m) {
  return static_cast<std::uint32_t>(_mm256_movemask_pd(m.v[0]) | (_mm256_movemask_pd(m.v[1]) << 4));
}
static inline Mask8 operator&(const Mask8& a, const Mask8& b) {
  return {{_mm256_and_pd(a.v[0], b.v[0]), _mm256_and_pd(a.v[1], b.v[1])}};
}
static inline Mask8 operator|(const Mask8& a, const Mask8& b) {
  return {{_mm256_or_pd(a.v[0], b.v[0]), _mm256_or_pd(a.v[1], b.v[1])}};
}
static inline Mask8 operator>(const Double8& a, const Double8& b) {
  return {{_mm256_cmp_pd(a.v[0], b.v[0], _CMP_GT_OQ), _mm256_cmp_pd(a.v[1], b.v[1], _CMP_GT_OQ)}};
}
static inline Mask8 operator==(const Double8& a, const Double8& b) {
  return {{_mm256_cmp_pd(a.v[0], b.v[0], _CMP_EQ_OQ), _mm256_cmp_pd(a.v[1], b.v[1], _CMP_EQ_OQ)}};
}
/// a, or 0, where m holds.
static inline Double8 onlyWhere(const Mask8& m, const Double8& a) {
  return {{_mm256_and_pd(m.v[0], a.v[0]), _mm256_and_pd(m.v[1], a.v[1])}};
}
static inline Double8 zeroWhere(const Mask8& m, const Double8& a) {
  return {{_mm256_andnot_pd(m.v[0], a.v[0]), _mm256_andnot_pd(m.v[1], a.v[1])}};
}
/// a where m holds, b elsewhere.
static inline Double8 either(const Mask8& m, const Double8& a, const Double8& b) {
  return {{_mm256_blendv_pd(b.v[0], a.v[0], m.v[0]), _mm256_blendv_pd(b.v[1], a.v[1], m.v[1])}};
}
/// See Kernels. (Measured.)
static bool prefersBlocks(std::size_t boxes, const Density& density) {
  return boxes <= 16 || (boxes <= 48 && density.bounds_met > 1.0) ||
         (density.bounds_met > kManyBounds && static_cast<double>(boxes) < 16.0 * density.in_vain);
}
