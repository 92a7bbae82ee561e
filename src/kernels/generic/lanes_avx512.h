// SPDX-License-Identifier: BSD-3-Clause
// Sixteen floats in an AVX-512 register. Included in a target region.

struct Float16 {
  __m512 v;
};

/// GCC 12 warns of uninitialised registers in its own unmasked minimum and maximum (its bug
/// 105593); with a full mask it makes the same instructions.
constexpr __mmask16 kAllLanes = 0xffff;
constexpr __mmask8 kEightLanes = 0xff;
constexpr __mmask8 kFourLanes = 0xf;

static inline Float16 load16(const float* p) {
  return {_mm512_load_ps(p)};
}
static inline Float16 all16(float x) {
  return {_mm512_set1_ps(x)};
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
  _mm512_storeu_ps(p, a.v);
}
/// a * b + c, rounded once or twice.
static inline Float16 multiplyAdd(Float16 a, Float16 b, Float16 c) {
  return {_mm512_fmadd_ps(a.v, b.v, c.v)};
}
static inline Float16 operator*(Float16 a, Float16 b) {
  return {_mm512_mul_ps(a.v, b.v)};
}
static inline Float16 operator+(Float16 a, Float16 b) {
  return {_mm512_add_ps(a.v, b.v)};
}
static inline Float16 operator-(Float16 a, Float16 b) {
  return {_mm512_sub_ps(a.v, b.v)};
}
static inline Float16 operator/(Float16 a, Float16 b) {
  return {_mm512_div_ps(a.v, b.v)};
}
/// a / b, off by less than 2^-13 of it.
static inline Float16 roughQuotient(Float16 a, Float16 b) {
  return {_mm512_mul_ps(a.v, _mm512_maskz_rcp14_ps(kAllLanes, b.v))};
}
/// a / sqrt(b) by Newton's method from an estimate, off by less than 8u of it.
static inline Float16 overRoot(Float16 a, Float16 b) {
  const __m512 r = _mm512_maskz_rsqrt14_ps(kAllLanes, b.v);
  const __m512 half_b = _mm512_mul_ps(b.v, _mm512_set1_ps(0.5F));
  const __m512 factor = _mm512_fnmadd_ps(_mm512_mul_ps(half_b, r), r, _mm512_set1_ps(1.5F));
  return {_mm512_mul_ps(_mm512_mul_ps(a.v, r), factor)};
}
/// a / sqrt(b), off by less than 2^-13 of it.
static inline Float16 roughOverRoot(Float16 a, Float16 b) {
  return {_mm512_mul_ps(a.v, _mm512_maskz_rsqrt14_ps(kAllLanes, b.v))};
}
/// a where b is not 0.
static inline Float16 orZeroWhereZero(Float16 a, Float16 b) {
  return {_mm512_maskz_mov_ps(_mm512_cmp_ps_mask(b.v, _mm512_setzero_ps(), _CMP_NEQ_OQ), a.v)};
}
static inline Float16 magnitude(Float16 a) {
  return {_mm512_andnot_ps(_mm512_set1_ps(-0.0F), a.v)};
}
/// a times -1 where b is negative.
static inline Float16 withSignOf(Float16 a, Float16 b) {
  return {_mm512_xor_ps(a.v, _mm512_and_ps(b.v, _mm512_set1_ps(-0.0F)))};
}
/// (Of a NaN and b, b.)
static inline Float16 larger(Float16 a, Float16 b) {
  return {_mm512_maskz_max_ps(kAllLanes, a.v, b.v)};
}
static inline Float16 smaller(Float16 a, Float16 b) {
  return {_mm512_maskz_min_ps(kAllLanes, a.v, b.v)};
}
/// The smallest lane, where none is NaN.
static inline float smallestLane(Float16 a) {
  return smallestLane(Float8{_mm256_min_ps(_mm512_maskz_extractf32x8_ps(0xff, a.v, 0),
                                           _mm512_maskz_extractf32x8_ps(0xff, a.v, 1))});
}
/// Lanes of b where `negative` is, of a elsewhere; as they are, whatever they stand for.
static inline Float16 choose(Float16 a, Float16 b, Float16 negative) {
  return {_mm512_mask_mov_ps(a.v, _mm512_movepi32_mask(_mm512_castps_si512(negative.v)), b.v)};
}
/// a where a <= b, +inf elsewhere.
static inline Float16 orInfinity(Float16 a, Float16 b) {
  const __m512 infinity = _mm512_set1_ps(std::numeric_limits<float>::infinity());
  return {_mm512_mask_mov_ps(infinity, _mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ), a.v)};
}
/// a but for one lane, which is +inf.
static inline Float16 withInfinity(Float16 a, int lane) {
  const __m512 infinity = _mm512_set1_ps(std::numeric_limits<float>::infinity());
  return {_mm512_mask_mov_ps(a.v, static_cast<__mmask16>(1U << lane), infinity)};
}
/// A bit for every lane in which a <= b.
static inline std::uint32_t notAbove(Float16 a, Float16 b) {
  return _mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ);
}

static inline float lane(Float16 a, int i) {
  return _mm512_cvtss_f32(_mm512_maskz_permutexvar_ps(kAllLanes, _mm512_set1_epi32(i), a.v));
}

/// Appends `base` + slot for every slot of `bits`. Up to kSlots entries behind the last one are
/// written to.
static inline int append(std::uint32_t bits, std::uint32_t base, std::uint32_t* list, int count) {
  const __m512i slots = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const __m512i all = _mm512_add_epi32(slots, _mm512_set1_epi32(static_cast<int>(base)));
  // In a register first: compressing straight to memory is slow on some CPUs.
  _mm512_storeu_si512(list + count, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), all));
  return count + __builtin_popcount(bits);
}
/// The same with where each is entered.
static inline int append(std::uint32_t bits, std::uint32_t base, Float16 near, std::uint32_t* list,
                         float* nears, int count) {
  _mm512_storeu_ps(nears + count, _mm512_maskz_compress_ps(static_cast<__mmask16>(bits), near.v));
  return append(bits, base, list, count);
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
  const auto joined = [](__m128 a, __m128 b, __m128 c, __m128 d) -> Float16 {
    const __m512 low = _mm512_castps256_ps512(_mm256_set_m128(b, a));
    return {_mm512_maskz_insertf32x8(kAllLanes, low, _mm256_set_m128(d, c), 1)};
  };
  for (int i = 0; i < 3; ++i) {
    origin[i] = joined(four[0].origin[i], four[1].origin[i], four[2].origin[i], four[3].origin[i]);
    direction[i] = joined(four[0].direction[i], four[1].direction[i], four[2].direction[i],
                          four[3].direction[i]);
  }
}

/// What boxes of a block are compared in, where there are more than eight.
using BlockLanes = Float16;

/// Whether two vectors are sooner worked on in one register.
constexpr bool kTwoAtOnce = true;

/// Eight doubles in an AVX-512 register.
struct Double8 {
  __m512d v;
};

static inline Double8 load8(const double* p) {
  return {_mm512_load_pd(p)};
}
static inline Double8 all8(double x) {
  return {_mm512_set1_pd(x)};
}
static inline Double8 operator+(Double8 a, Double8 b) {
  return {_mm512_add_pd(a.v, b.v)};
}
static inline Double8 operator-(Double8 a, Double8 b) {
  return {_mm512_sub_pd(a.v, b.v)};
}
static inline Double8 operator*(Double8 a, Double8 b) {
  return {_mm512_mul_pd(a.v, b.v)};
}
static inline Double8 operator/(Double8 a, Double8 b) {
  return {_mm512_div_pd(a.v, b.v)};
}
/// a * b + c
static inline Double8 fused(Double8 a, Double8 b, Double8 c) {
  return {_mm512_fmadd_pd(a.v, b.v, c.v)};
}
/// The rest of the product p = a * b, exactly, where nothing underflows.
static inline Double8 restOfProduct(Double8 a, Double8 b, Double8 p) {
  return {_mm512_fmsub_pd(a.v, b.v, p.v)};
}
static inline Double8 negated(Double8 a) {
  return {_mm512_xor_pd(a.v, _mm512_set1_pd(-0.0))};
}
static inline Double8 magnitude(Double8 a) {
  return {_mm512_andnot_pd(_mm512_set1_pd(-0.0), a.v)};
}
/// a times -1 where b is negative.
static inline Double8 withSignOf(Double8 a, Double8 b) {
  return {_mm512_xor_pd(a.v, _mm512_and_pd(b.v, _mm512_set1_pd(-0.0)))};
}
/// (Of equal ones, b.)
static inline Double8 larger(Double8 a, Double8 b) {
  return {_mm512_maskz_max_pd(kEightLanes, a.v, b.v)};
}
static inline Double8 smaller(Double8 a, Double8 b) {
  return {_mm512_maskz_min_pd(kEightLanes, a.v, b.v)};
}
static inline Double8 squareRoot(Double8 a) {
  return {_mm512_maskz_sqrt_pd(kEightLanes, a.v)};
}

/// Four lanes each of a and of b.
static inline Double8 joined(Double4 a, Double4 b) {
  return {_mm512_maskz_insertf64x4(kEightLanes, _mm512_castpd256_pd512(a.v), b.v, 1)};
}
/// a in each half.
static inline Double8 repeated(Double4 a, Double8 /*like*/) {
  return {_mm512_maskz_broadcast_f64x4(kEightLanes, a.v)};
}
static inline Double4 firstHalf(Double8 a) {
  return {_mm512_maskz_extractf64x4_pd(kFourLanes, a.v, 0)};
}
static inline Double4 secondHalf(Double8 a) {
  return {_mm512_maskz_extractf64x4_pd(kFourLanes, a.v, 1)};
}
/// Of each half: lane k everywhere.
template <int k>
static inline Double8 spread(Double8 a) {
  return {_mm512_maskz_permutex_pd(kEightLanes, a.v, k | (k << 2) | (k << 4) | (k << 6))};
}
/// Of each half: (y, z, x) of (x, y, z), and (z, x, y).
static inline Double8 turned(Double8 a) {
  return {_mm512_maskz_permutex_pd(kEightLanes, a.v, _MM_SHUFFLE(3, 0, 2, 1))};
}
static inline Double8 turnedTwice(Double8 a) {
  return {_mm512_maskz_permutex_pd(kEightLanes, a.v, _MM_SHUFFLE(3, 1, 0, 2))};
}

/// Of each half: lane i of the k-th is lane k of the i-th then.
static inline void transposeHalves(const Double8 (&from)[4], Double8* to) {
  const __m512i lows = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
  const __m512i highs = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  const __m512d even[2] = {_mm512_maskz_unpacklo_pd(kEightLanes, from[0].v, from[1].v),
                           _mm512_maskz_unpacklo_pd(kEightLanes, from[2].v, from[3].v)};
  const __m512d odd[2] = {_mm512_maskz_unpackhi_pd(kEightLanes, from[0].v, from[1].v),
                          _mm512_maskz_unpackhi_pd(kEightLanes, from[2].v, from[3].v)};
  to[0] = {_mm512_permutex2var_pd(even[0], lows, even[1])};
  to[1] = {_mm512_permutex2var_pd(odd[0], lows, odd[1])};
  to[2] = {_mm512_permutex2var_pd(even[0], highs, even[1])};
  to[3] = {_mm512_permutex2var_pd(odd[0], highs, odd[1])};
}
/// The same of eight rows and four columns, and back.
static inline void transpose(const Double4* rows, Double8* columns) {
  transposeHalves({joined(rows[0], rows[4]), joined(rows[1], rows[5]), joined(rows[2], rows[6]),
                   joined(rows[3], rows[7])},
                  columns);
}
static inline void transpose(const Double8* columns, Double4* rows) {
  Double8 four[4];  // rows k and k + 4
  transposeHalves({columns[0], columns[1], columns[2], columns[3]}, four);
  for (int k = 0; k < 4; ++k) {
    rows[k] = firstHalf(four[k]);
    rows[k + 4] = secondHalf(four[k]);
  }
}

/// Lanes in which something holds.
struct Mask8 {
  __mmask8 bits;
};
static inline std::uint32_t bitsOf(Mask8 m) {
  return m.bits;
}
static inline Mask8 operator&(Mask8 a, Mask8 b) {
  return {static_cast<__mmask8>(a.bits & b.bits)};
}
static inline Mask8 operator|(Mask8 a, Mask8 b) {
  return {static_cast<__mmask8>(a.bits | b.bits)};
}
static inline Mask8 operator>(Double8 a, Double8 b) {
  return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_GT_OQ)};
}
static inline Mask8 operator==(Double8 a, Double8 b) {
  return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_EQ_OQ)};
}
/// a, or 0, where m holds.
static inline Double8 onlyWhere(Mask8 m, Double8 a) {
  return {_mm512_maskz_mov_pd(m.bits, a.v)};
}
static inline Double8 zeroWhere(Mask8 m, Double8 a) {
  return {_mm512_maskz_mov_pd(static_cast<__mmask8>(~m.bits), a.v)};
}
/// a where m holds, b elsewhere.
static inline Double8 either(Mask8 m, Double8 a, Double8 b) {
  return {_mm512_mask_mov_pd(b.v, m.bits, a.v)};
}
/// See Kernels. (Measured.)
static bool prefersBlocks(std::size_t boxes, const Density& density) {
  const double most = (boxes <= 192 ? 400.0 : 24.0) * density.in_vain;
  return boxes <= 32 || (boxes <= 64 && density.bounds_met > 1.0) ||
         (density.bounds_met > kManyBounds && static_cast<double>(boxes) < most);
}
