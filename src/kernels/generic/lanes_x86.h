// SPDX-License-Identifier: BSD-3-Clause
// Four doubles, or eight floats, in an AVX register. Included in a target region.

struct Double4 {
  __m256d v;
};

static inline Double4 load4(const double* p) {
  return {_mm256_load_pd(p)};
}
/// From any address.
static inline Double4 loadAny4(const double* p) {
  return {_mm256_loadu_pd(p)};
}
static inline Double4 all4(double x) {
  return {_mm256_set1_pd(x)};
}
/// The three numbers at p, and 0. Read one by one: just written by themselves, they cannot be had
/// at once yet.
static inline Double4 lanes4(const double* p) {
  return {_mm256_setr_pd(p[0], p[1], p[2], 0.0)};
}
static inline Double4 lanes4(double x, double y, double z) {
  return {_mm256_setr_pd(x, y, z, 0.0)};
}
static inline Double4 operator+(Double4 a, Double4 b) {
  return {_mm256_add_pd(a.v, b.v)};
}
static inline Double4 operator-(Double4 a, Double4 b) {
  return {_mm256_sub_pd(a.v, b.v)};
}
static inline Double4 operator*(Double4 a, Double4 b) {
  return {_mm256_mul_pd(a.v, b.v)};
}
static inline Double4 operator/(Double4 a, Double4 b) {
  return {_mm256_div_pd(a.v, b.v)};
}
/// a * b + c
static inline Double4 fused(Double4 a, Double4 b, Double4 c) {
  return {_mm256_fmadd_pd(a.v, b.v, c.v)};
}
/// c - a * b
static inline Double4 fusedNegative(Double4 a, Double4 b, Double4 c) {
  return {_mm256_fnmadd_pd(a.v, b.v, c.v)};
}
static inline Double4 magnitude(Double4 a) {
  return {_mm256_andnot_pd(_mm256_set1_pd(-0.0), a.v)};
}
/// max(|a|, least) with the sign of a.
static inline Double4 awayFromZero(Double4 a, double least) {
  const __m256d sign_bit = _mm256_set1_pd(-0.0);
  const __m256d size = _mm256_max_pd(_mm256_andnot_pd(sign_bit, a.v), _mm256_set1_pd(least));
  return {_mm256_or_pd(size, _mm256_and_pd(a.v, sign_bit))};
}
/// `other` where a is NaN.
static inline Double4 orIfNan(Double4 a, double other) {
  return {_mm256_blendv_pd(a.v, _mm256_set1_pd(other), _mm256_cmp_pd(a.v, a.v, _CMP_UNORD_Q))};
}
/// Lanes of b where `negative` is, of a elsewhere.
static inline Double4 choose(Double4 a, Double4 b, Double4 negative) {
  return {_mm256_blendv_pd(a.v, b.v, negative.v)};
}
struct Pair {
  double first;
  double second;
};
/// The largest of the first three lanes, of a and of b.
static inline Pair largest3(Double4 a, Double4 b) {
  const __m256d even = _mm256_unpacklo_pd(a.v, b.v);
  const __m256d odd = _mm256_unpackhi_pd(a.v, b.v);
  const __m128d m =
      _mm_max_pd(_mm_max_pd(_mm256_castpd256_pd128(even), _mm256_castpd256_pd128(odd)),
                 _mm256_extractf128_pd(even, 1));
  return {_mm_cvtsd_f64(m), _mm_cvtsd_f64(_mm_unpackhi_pd(m, m))};
}
static inline Pair smallest3(Double4 a, Double4 b) {
  const __m256d even = _mm256_unpacklo_pd(a.v, b.v);
  const __m256d odd = _mm256_unpackhi_pd(a.v, b.v);
  const __m128d m =
      _mm_min_pd(_mm_min_pd(_mm256_castpd256_pd128(even), _mm256_castpd256_pd128(odd)),
                 _mm256_extractf128_pd(even, 1));
  return {_mm_cvtsd_f64(m), _mm_cvtsd_f64(_mm_unpackhi_pd(m, m))};
}
static inline void prefetch(const void* p) {
  _mm_prefetch(static_cast<const char*>(p), _MM_HINT_T0);
}
/// The rest of the product p = a * b, exactly, where nothing underflows.
static inline Double4 restOfProduct(Double4 a, Double4 b, Double4 p) {
  return {_mm256_fmsub_pd(a.v, b.v, p.v)};
}
static inline Double4 negated(Double4 a) {
  return {_mm256_xor_pd(a.v, _mm256_set1_pd(-0.0))};
}
/// The sum of the first three lanes, everywhere.
static inline Double4 sumOf3(Double4 a) {
  return {_mm256_add_pd(_mm256_add_pd(_mm256_permute4x64_pd(a.v, _MM_SHUFFLE(0, 0, 0, 0)),
                                      _mm256_permute4x64_pd(a.v, _MM_SHUFFLE(1, 1, 1, 1))),
                        _mm256_permute4x64_pd(a.v, _MM_SHUFFLE(2, 2, 2, 2)))};
}
static inline double sum3(Double4 a) {
  const __m128d two = _mm256_castpd256_pd128(a.v);
  return _mm_cvtsd_f64(
      _mm_add_sd(_mm_add_sd(two, _mm_unpackhi_pd(two, two)), _mm256_extractf128_pd(a.v, 1)));
}
static inline Double4 larger(Double4 a, Double4 b) {
  return {_mm256_max_pd(a.v, b.v)};
}
static inline Double4 smaller(Double4 a, Double4 b) {
  return {_mm256_min_pd(a.v, b.v)};
}
static inline Double4 squareRoot(Double4 a) {
  return {_mm256_sqrt_pd(a.v)};
}
/// a where b is not 0.
static inline Double4 orZeroWhereZero(Double4 a, Double4 b) {
  return {_mm256_and_pd(_mm256_cmp_pd(b.v, _mm256_setzero_pd(), _CMP_NEQ_OQ), a.v)};
}
static inline double firstLane(Double4 a) {
  return _mm256_cvtsd_f64(a.v);
}
static inline Double4 asDoubles(const float* p) {
  return {_mm256_cvtps_pd(_mm_load_ps(p))};
}
/// Lanes of b where `bits` has theirs, of a elsewhere.
template <int kBits>
static inline Double4 replaced(Double4 a, Double4 b) {
  return {_mm256_blend_pd(a.v, b.v, kBits)};
}
static inline void storeAsFloats(float* p, Double4 a) {
  _mm_store_ps(p, _mm256_cvtpd_ps(a.v));
}
static inline Double4 operator&(Double4 a, Double4 b) {
  return {_mm256_and_pd(a.v, b.v)};
}
static inline Double4 operator|(Double4 a, Double4 b) {
  return {_mm256_or_pd(a.v, b.v)};
}
/// Lanes whose sign is set where a >= b.
static inline Double4 isNotBelow(Double4 a, Double4 b) {
  return {_mm256_cmp_pd(a.v, b.v, _CMP_GE_OQ)};
}
/// a times -1 where b is negative.
static inline Double4 withSignOf(Double4 a, Double4 b) {
  return {_mm256_xor_pd(a.v, _mm256_and_pd(b.v, _mm256_set1_pd(-0.0)))};
}
/// (y, z, x) of (x, y, z), and (z, x, y).
static inline Double4 turned(Double4 a) {
  return {_mm256_permute4x64_pd(a.v, _MM_SHUFFLE(3, 0, 2, 1))};
}
static inline Double4 turnedTwice(Double4 a) {
  return {_mm256_permute4x64_pd(a.v, _MM_SHUFFLE(3, 1, 0, 2))};
}
/// As often as there are halves of four lanes in what it is to be like.
static inline Double4 repeated(Double4 a, Double4 /*like*/) {
  return a;
}
/// Lane k everywhere.
template <int k>
static inline Double4 spread(Double4 a) {
  return {_mm256_permute4x64_pd(a.v, k | (k << 2) | (k << 4) | (k << 6))};
}
/// Lane i of the j-th is lane j of the i-th then, for the first three; the fourth lanes are
/// nothing.
static inline void transpose3(Double4* a) {
  const __m256d low = _mm256_unpacklo_pd(a[0].v, a[1].v);   // 00 10 02 12
  const __m256d high = _mm256_unpackhi_pd(a[0].v, a[1].v);  // 01 11
  const __m256d last = a[2].v;                              // 20 21 22
  a[0].v = _mm256_insertf128_pd(low, _mm256_castpd256_pd128(last), 1);
  a[1].v = _mm256_insertf128_pd(
      high, _mm_unpackhi_pd(_mm256_castpd256_pd128(last), _mm256_castpd256_pd128(last)), 1);
  a[2].v = _mm256_permute2f128_pd(low, last, 0x31);
}
static inline void store4(double* p, Double4 a) {
  _mm256_store_pd(p, a.v);
}
static inline void storeAny4(double* p, Double4 a) {
  _mm256_storeu_pd(p, a.v);
}
/// A bit for each of the first three lanes in which a >= b, and in which the sign is set.
static inline unsigned notBelow3(Double4 a, Double4 b) {
  return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(a.v, b.v, _CMP_GE_OQ))) & 7U;
}
static inline bool isSame3(Double4 a, Double4 b) {
  return (static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(a.v, b.v, _CMP_EQ_OQ))) & 7U) ==
         7U;
}
static inline unsigned signs3(Double4 a) {
  return static_cast<unsigned>(_mm256_movemask_pd(a.v)) & 7U;
}
static inline int lowestBit(std::uint32_t bits) {
  return __builtin_ctz(bits);
}

/// Above 1 / sqrt(x), by less than 2^-9 of it.
static inline float aboveInverseRoot(float x) {
  return _mm_cvtss_f32(_mm_rsqrt_ss(_mm_set_ss(x))) * (1.0F + 0x1p-10F);
}

struct Float4 {
  __m128 v;
};

static inline Float4 quad(float x) {
  return {_mm_set1_ps(x)};
}
static inline Float4 loadQuad(const float* p) {
  return {_mm_load_ps(p)};
}
static inline void store(float* p, Float4 a) {
  _mm_store_ps(p, a.v);
}
static inline Float4 floatsOf(Double4 a) {
  return {_mm256_cvtpd_ps(a.v)};
}
static inline Float4 multiplyAdd(Float4 a, Float4 b, Float4 c) {
  return {_mm_fmadd_ps(a.v, b.v, c.v)};
}
static inline Float4 operator+(Float4 a, Float4 b) {
  return {_mm_add_ps(a.v, b.v)};
}
static inline Float4 operator-(Float4 a, Float4 b) {
  return {_mm_sub_ps(a.v, b.v)};
}
static inline Float4 operator*(Float4 a, Float4 b) {
  return {_mm_mul_ps(a.v, b.v)};
}
static inline Float4 operator/(Float4 a, Float4 b) {
  return {_mm_div_ps(a.v, b.v)};
}
static inline Float4 magnitude(Float4 a) {
  return {_mm_andnot_ps(_mm_set1_ps(-0.0F), a.v)};
}
static inline Float4 withSignOf(Float4 a, Float4 b) {
  return {_mm_xor_ps(a.v, _mm_and_ps(b.v, _mm_set1_ps(-0.0F)))};
}
static inline Float4 larger(Float4 a, Float4 b) {
  return {_mm_max_ps(a.v, b.v)};
}
/// Lanes of b where `negative` is, of a elsewhere.
static inline Float4 choose(Float4 a, Float4 b, Float4 negative) {
  return {_mm_blendv_ps(a.v, b.v, negative.v)};
}
/// Of the first three lanes, in some order, in each of them.
static inline Float4 sumOf3(Float4 a) {
  const __m128 turned = _mm_permute_ps(a.v, _MM_SHUFFLE(3, 0, 2, 1));
  return {_mm_add_ps(_mm_add_ps(a.v, turned), _mm_permute_ps(a.v, _MM_SHUFFLE(3, 1, 0, 2)))};
}
static inline float largestOf3(Float4 a) {
  return _mm_cvtss_f32(
      _mm_max_ss(_mm_max_ss(a.v, _mm_movehdup_ps(a.v)), _mm_unpackhi_ps(a.v, a.v)));
}
static inline float smallestOf3(Float4 a) {
  return _mm_cvtss_f32(
      _mm_min_ss(_mm_min_ss(a.v, _mm_movehdup_ps(a.v)), _mm_unpackhi_ps(a.v, a.v)));
}
static inline float firstLane(Float4 a) {
  return _mm_cvtss_f32(a.v);
}
/// A bit for every lane in which a <= b, and in which the sign is set.
static inline std::uint32_t notAbove(Float4 a, Float4 b) {
  return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
}
static inline std::uint32_t signsOf(Float4 a) {
  return static_cast<std::uint32_t>(_mm_movemask_ps(a.v));
}

struct Float8 {
  __m256 v;
};

static inline Float8 load8(const float* p) {
  return {_mm256_load_ps(p)};
}
static inline Float8 all8(float x) {
  return {_mm256_set1_ps(x)};
}
static inline void store8(float* p, Float8 a) {
  _mm256_store_ps(p, a.v);
}
static inline Float8 multiplyAdd(Float8 a, Float8 b, Float8 c) {
  return {_mm256_fmadd_ps(a.v, b.v, c.v)};
}
static inline Float8 operator+(Float8 a, Float8 b) {
  return {_mm256_add_ps(a.v, b.v)};
}
static inline Float8 operator-(Float8 a, Float8 b) {
  return {_mm256_sub_ps(a.v, b.v)};
}
static inline Float8 operator*(Float8 a, Float8 b) {
  return {_mm256_mul_ps(a.v, b.v)};
}
static inline Float8 operator/(Float8 a, Float8 b) {
  return {_mm256_div_ps(a.v, b.v)};
}
static inline Float8 magnitude(Float8 a) {
  return {_mm256_andnot_ps(_mm256_set1_ps(-0.0F), a.v)};
}
/// a times -1 where b is negative.
static inline Float8 withSignOf(Float8 a, Float8 b) {
  return {_mm256_xor_ps(a.v, _mm256_and_ps(b.v, _mm256_set1_ps(-0.0F)))};
}
static inline Float8 larger(Float8 a, Float8 b) {
  return {_mm256_max_ps(a.v, b.v)};
}
static inline Float8 smaller(Float8 a, Float8 b) {
  return {_mm256_min_ps(a.v, b.v)};
}
static inline std::uint32_t notAbove(Float8 a, Float8 b) {
  return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
}
/// a where a <= b, +inf elsewhere.
static inline Float8 orInfinity(Float8 a, Float8 b) {
  const __m256 infinity = _mm256_set1_ps(std::numeric_limits<float>::infinity());
  return {_mm256_blendv_ps(infinity, a.v, _mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ))};
}
/// a / sqrt(b) by Newton's method from an estimate, off by less than 8u of it.
static inline Float8 overRoot(Float8 a, Float8 b) {
  const __m256 r = _mm256_rsqrt_ps(b.v);
  const __m256 half_b = _mm256_mul_ps(b.v, _mm256_set1_ps(0.5F));
  const __m256 factor = _mm256_fnmadd_ps(_mm256_mul_ps(half_b, r), r, _mm256_set1_ps(1.5F));
  return {_mm256_mul_ps(_mm256_mul_ps(a.v, r), factor)};
}
/// The smallest lane, where none is NaN.
static inline float smallestLane(Float8 a) {
  __m128 m = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  m = _mm_min_ps(m, _mm_movehl_ps(m, m));
  return _mm_cvtss_f32(_mm_min_ss(m, _mm_movehdup_ps(m)));
}

/// Four rays in lanes: origins relative to a center, and directions, of six numbers a ray: origin
/// and direction, or start and end.
struct FourRays {
  __m128 origin[3];
  __m128 direction[3];
};

template <bool kAreSegments>
static inline FourRays loadFourRays(const double* rays, Double4 center) {
  __m128 head[4];
  __m128 tail[4];
  for (int k = 0; k < 4; ++k) {
    const __m256d first = _mm256_loadu_pd(rays + 6 * k);
    __m256d last = _mm256_loadu_pd(rays + 6 * k + 2);
    if constexpr (kAreSegments) {
      last = _mm256_sub_pd(last, _mm256_permute4x64_pd(first, _MM_SHUFFLE(2, 1, 0, 0)));
    }
    head[k] = _mm256_cvtpd_ps(_mm256_sub_pd(first, center.v));
    tail[k] = _mm256_cvtpd_ps(last);
  }
  _MM_TRANSPOSE4_PS(head[0], head[1], head[2], head[3]);
  _MM_TRANSPOSE4_PS(tail[0], tail[1], tail[2], tail[3]);
  return {{head[0], head[1], head[2]}, {tail[1], tail[2], tail[3]}};
}
