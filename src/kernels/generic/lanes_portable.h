// SPDX-License-Identifier: BSD-3-Clause
// Four doubles as an array, eight and sixteen floats by four: what the compiler makes of them is up
// to it.

struct Double4 {
  double v[4];
};

template <typename Function>
static inline Double4 each4(Function&& f) {
  return {{f(0), f(1), f(2), f(3)}};
}
static inline Double4 load4(const double* p) {
  return {{p[0], p[1], p[2], p[3]}};
}
static inline Double4 all4(double x) {
  return {{x, x, x, x}};
}
/// The three numbers at p, and 0.
static inline Double4 lanes4(const double* p) {
  return {{p[0], p[1], p[2], 0.0}};
}
static inline Double4 operator+(const Double4& a, const Double4& b) {
  return each4([&](int i) { return a.v[i] + b.v[i]; });
}
static inline Double4 operator-(const Double4& a, const Double4& b) {
  return each4([&](int i) { return a.v[i] - b.v[i]; });
}
static inline Double4 operator*(const Double4& a, const Double4& b) {
  return each4([&](int i) { return a.v[i] * b.v[i]; });
}
static inline Double4 operator/(const Double4& a, const Double4& b) {
  return each4([&](int i) { return a.v[i] / b.v[i]; });
}
/// a * b + c
static inline Double4 fused(const Double4& a, const Double4& b, const Double4& c) {
  return a * b + c;
}
/// c - a * b
static inline Double4 fusedNegative(const Double4& a, const Double4& b, const Double4& c) {
  return c - a * b;
}
static inline Double4 magnitude(const Double4& a) {
  return each4([&](int i) { return std::fabs(a.v[i]); });
}
/// max(|a|, least) with the sign of a.
static inline Double4 awayFromZero(const Double4& a, double least) {
  return each4([&](int i) {
    const double size = std::fabs(a.v[i]);
    return std::copysign(size > least ? size : least, a.v[i]);
  });
}
/// `other` where a is NaN.
static inline Double4 orIfNan(const Double4& a, double other) {
  return each4([&](int i) { return std::isnan(a.v[i]) ? other : a.v[i]; });
}
/// Lanes of b where `negative` is, of a elsewhere.
static inline Double4 choose(const Double4& a, const Double4& b, const Double4& negative) {
  return each4([&](int i) { return std::signbit(negative.v[i]) ? b.v[i] : a.v[i]; });
}
struct Pair {
  double first;
  double second;
};
static inline double largerOf(double a, double b) {
  return a > b ? a : b;
}
static inline double smallerOf(double a, double b) {
  return a < b ? a : b;
}
/// The largest of the first three lanes, of a and of b.
static inline Pair largest3(const Double4& a, const Double4& b) {
  return {largerOf(largerOf(a.v[0], a.v[1]), a.v[2]), largerOf(largerOf(b.v[0], b.v[1]), b.v[2])};
}
static inline Pair smallest3(const Double4& a, const Double4& b) {
  return {smallerOf(smallerOf(a.v[0], a.v[1]), a.v[2]),
          smallerOf(smallerOf(b.v[0], b.v[1]), b.v[2])};
}
static inline void prefetch(const void* p) {
  __builtin_prefetch(p);
}
static inline Double4 negated(const Double4& a) {
  return each4([&](int i) { return -a.v[i]; });
}
/// a times -1 where b is negative.
static inline Double4 withSignOf(const Double4& a, const Double4& b) {
  return each4([&](int i) { return std::signbit(b.v[i]) ? -a.v[i] : a.v[i]; });
}
static inline Double4 larger(const Double4& a, const Double4& b) {
  return each4([&](int i) { return largerOf(a.v[i], b.v[i]); });
}
static inline Double4 smaller(const Double4& a, const Double4& b) {
  return each4([&](int i) { return smallerOf(a.v[i], b.v[i]); });
}
/// a where b is not 0.
static inline Double4 orZeroWhereZero(const Double4& a, const Double4& b) {
  return each4([&](int i) { return b.v[i] != 0.0 ? a.v[i] : 0.0; });
}
static inline double sum3(const Double4& a) {
  return (a.v[0] + a.v[1]) + a.v[2];
}
static inline void store4(double* p, const Double4& a) {
  for (int i = 0; i < 4; ++i) {
    p[i] = a.v[i];
  }
}
static inline double firstLane(const Double4& a) {
  return a.v[0];
}
static inline void storeAsFloats(float* p, const Double4& a) {
  for (int i = 0; i < 4; ++i) {
    p[i] = static_cast<float>(a.v[i]);
  }
}
/// Of signs.
static inline Double4 operator&(const Double4& a, const Double4& b) {
  return each4([&](int i) { return std::signbit(a.v[i]) && std::signbit(b.v[i]) ? -1.0 : 1.0; });
}
static inline Double4 operator|(const Double4& a, const Double4& b) {
  return each4([&](int i) { return std::signbit(a.v[i]) || std::signbit(b.v[i]) ? -1.0 : 1.0; });
}
/// Lanes whose sign is set where a >= b.
static inline Double4 isNotBelow(const Double4& a, const Double4& b) {
  return each4([&](int i) { return a.v[i] >= b.v[i] ? -1.0 : 1.0; });
}
/// (y, z, x) of (x, y, z), and (z, x, y).
static inline Double4 turned(const Double4& a) {
  return {{a.v[1], a.v[2], a.v[0], a.v[3]}};
}
static inline Double4 turnedTwice(const Double4& a) {
  return {{a.v[2], a.v[0], a.v[1], a.v[3]}};
}
/// A bit for each of the first three lanes in which a >= b, and in which the sign is set.
static inline unsigned notBelow3(const Double4& a, const Double4& b) {
  return (a.v[0] >= b.v[0] ? 1U : 0U) | (a.v[1] >= b.v[1] ? 2U : 0U) | (a.v[2] >= b.v[2] ? 4U : 0U);
}
static inline unsigned signs3(const Double4& a) {
  return (std::signbit(a.v[0]) ? 1U : 0U) | (std::signbit(a.v[1]) ? 2U : 0U) |
         (std::signbit(a.v[2]) ? 4U : 0U);
}
static inline int lowestBit(std::uint32_t bits) {
  return __builtin_ctz(bits);
}

/// Above 1 / sqrt(x), by less than 2^-9 of it.
static inline float aboveInverseRoot(float x) {
  return 1.0F / std::sqrt(x) * (1.0F + 0x1p-10F);
}

/// Four floats, or what comparing them says: GCC and Clang make of it what the CPU has.
using Quad [[gnu::vector_size(16)]] = float;
using Int4 [[gnu::vector_size(16)]] = std::int32_t;

static inline Quad fill(float x) {
  return Quad{x, x, x, x};
}
static inline Int4 bitsOf(Quad a) {
  return reinterpret_cast<Int4>(a);
}
static inline Quad floatOf(Int4 bits) {
  return reinterpret_cast<Quad>(bits);
}

template <int kLanes>
struct Floats {
  Quad v[kLanes / 4];
};
using Float16 = Floats<kSlots>;
using Float8 = Floats<8>;
using Float4 = Floats<4>;

template <int kLanes, typename Function>
static inline Floats<kLanes> each(Function&& f) {
  if constexpr (kLanes == 4) {
    return {{f(0)}};
  } else if constexpr (kLanes == 8) {
    return {{f(0), f(1)}};
  } else {
    return {{f(0), f(1), f(2), f(3)}};
  }
}
template <int kLanes>
static inline Floats<kLanes> load(const float* p) {
  Floats<kLanes> a;
  __builtin_memcpy(&a, p, sizeof(a));
  return a;
}
static inline Float16 load16(const float* p) {
  return load<kSlots>(p);
}
static inline Float8 load8(const float* p) {
  return load<8>(p);
}
static inline Float4 quad(float x) {
  return {{fill(x)}};
}
static inline Float4 loadQuad(const float* p) {
  return load<4>(p);
}
static inline Float4 floatsOf(const Double4& a) {
  alignas(16) float all[4];
  storeAsFloats(all, a);
  return loadQuad(all);
}
/// Of the first three lanes, in some order, in each of them.
static inline Float4 sumOf3(const Float4& a) {
  const Quad& v = a.v[0];
  return quad((v[0] + v[1]) + v[2]);
}
static inline float largestOf3(const Float4& a) {
  const Quad& v = a.v[0];
  const float two = v[0] > v[1] ? v[0] : v[1];
  return two > v[2] ? two : v[2];
}
static inline float smallestOf3(const Float4& a) {
  const Quad& v = a.v[0];
  const float two = v[0] < v[1] ? v[0] : v[1];
  return two < v[2] ? two : v[2];
}
static inline float firstLane(const Float4& a) {
  return a.v[0][0];
}
/// A bit for every lane in which the sign is set.
static inline std::uint32_t signsOf(const Float4& a) {
  const Int4 bits = (bitsOf(a.v[0]) < 0) & Int4{1, 2, 4, 8};
  return static_cast<std::uint32_t>((bits[0] | bits[1]) | (bits[2] | bits[3]));
}
static inline Float16 all16(float x) {
  return each<kSlots>([&](int) { return fill(x); });
}
/// A number for all lanes, as it is best kept for long: by itself, since there are few registers.
using Kept16 = float;
static inline Kept16 kept16(float x) {
  return x;
}
static inline Float8 all8(float x) {
  return each<8>([&](int) { return fill(x); });
}
template <int kLanes>
static inline void store(float* p, const Floats<kLanes>& a) {
  __builtin_memcpy(p, &a, sizeof(a));
}
static inline void store16(float* p, const Float16& a) {
  store(p, a);
}
static inline void store8(float* p, const Float8& a) {
  store(p, a);
}
/// a * b + c, rounded once or twice.
template <int kLanes>
static inline Floats<kLanes> multiplyAdd(const Floats<kLanes>& a, const Floats<kLanes>& b,
                                         const Floats<kLanes>& c) {
  return each<kLanes>([&](int i) { return a.v[i] * b.v[i] + c.v[i]; });
}
template <int kLanes>
static inline Floats<kLanes> operator*(const Floats<kLanes>& a, const Floats<kLanes>& b) {
  return each<kLanes>([&](int i) { return a.v[i] * b.v[i]; });
}
template <int kLanes>
static inline Floats<kLanes> operator+(const Floats<kLanes>& a, const Floats<kLanes>& b) {
  return each<kLanes>([&](int i) { return a.v[i] + b.v[i]; });
}
template <int kLanes>
static inline Floats<kLanes> operator-(const Floats<kLanes>& a, const Floats<kLanes>& b) {
  return each<kLanes>([&](int i) { return a.v[i] - b.v[i]; });
}
template <int kLanes>
static inline Floats<kLanes> operator/(const Floats<kLanes>& a, const Floats<kLanes>& b) {
  return each<kLanes>([&](int i) { return a.v[i] / b.v[i]; });
}
template <int kLanes>
static inline Floats<kLanes> magnitude(const Floats<kLanes>& a) {
  return each<kLanes>([&](int i) { return floatOf(bitsOf(a.v[i]) & ~bitsOf(fill(-0.0F))); });
}
/// a times -1 where b is negative.
template <int kLanes>
static inline Floats<kLanes> withSignOf(const Floats<kLanes>& a, const Floats<kLanes>& b) {
  return each<kLanes>(
      [&](int i) { return floatOf(bitsOf(a.v[i]) ^ (bitsOf(b.v[i]) & bitsOf(fill(-0.0F)))); });
}
/// a / b; an estimate would do.
static inline Float16 roughQuotient(const Float16& a, const Float16& b) {
  return a / b;
}
/// a / sqrt(b) by Newton's method from half the exponent, off by less than 8u of it.
static inline Float16 overRoot(const Float16& a, const Float16& b) {
  return each<kSlots>([&](int i) {
    const Quad half_b = b.v[i] * 0.5F;
    Quad r = floatOf(0x5f375a86 - (bitsOf(b.v[i]) >> 1));
    for (int step = 0; step < 3; ++step) {
      r = r * (1.5F - half_b * r * r);
    }
    return a.v[i] * r;
  });
}
/// a / sqrt(b); an estimate would do.
static inline Float16 roughOverRoot(const Float16& a, const Float16& b) {
  return overRoot(a, b);
}
/// a where b is not 0.
static inline Float16 orZeroWhereZero(const Float16& a, const Float16& b) {
  return each<kSlots>([&](int i) { return floatOf((b.v[i] != 0.0F) & bitsOf(a.v[i])); });
}
/// (Of a NaN and b, b.)
template <int kLanes>
static inline Floats<kLanes> larger(const Floats<kLanes>& a, const Floats<kLanes>& b) {
  return each<kLanes>([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
}
template <int kLanes>
static inline Floats<kLanes> smaller(const Floats<kLanes>& a, const Floats<kLanes>& b) {
  return each<kLanes>([&](int i) { return a.v[i] < b.v[i] ? a.v[i] : b.v[i]; });
}
/// The smallest lane, where none is NaN.
template <int kLanes>
static inline float smallestLane(const Floats<kLanes>& a) {
  Quad least = a.v[0];
  for (int i = 1; i < kLanes / 4; ++i) {
    least = least < a.v[i] ? least : a.v[i];
  }
  const auto lesser = [](float x, float y) { return x < y ? x : y; };
  return lesser(lesser(least[0], least[1]), lesser(least[2], least[3]));
}
/// Lanes of b where `negative` is, of a elsewhere; as they are, whatever they stand for.
template <int kLanes>
static inline Floats<kLanes> choose(const Floats<kLanes>& a, const Floats<kLanes>& b,
                                    const Floats<kLanes>& negative) {
  return each<kLanes>([&](int i) { return bitsOf(negative.v[i]) < 0 ? b.v[i] : a.v[i]; });
}
/// a where a <= b, +inf elsewhere.
template <int kLanes>
static inline Floats<kLanes> orInfinity(const Floats<kLanes>& a, const Floats<kLanes>& b) {
  const Quad infinity = fill(std::numeric_limits<float>::infinity());
  return each<kLanes>([&](int i) { return a.v[i] <= b.v[i] ? a.v[i] : infinity; });
}
/// a but for one lane, which is +inf.
static inline Float16 withInfinity(const Float16& a, int lane) {
  const Quad infinity = fill(std::numeric_limits<float>::infinity());
  return each<kSlots>([&](int i) {
    const Int4 at = Int4{0, 1, 2, 3} + 4 * i;
    return at == lane ? infinity : a.v[i];
  });
}
/// A bit for every lane in which a <= b.
template <int kLanes>
static inline std::uint32_t notAbove(const Floats<kLanes>& a, const Floats<kLanes>& b) {
  Int4 bits = {0, 0, 0, 0};
  for (int i = 0; i < kLanes / 4; ++i) {
    bits |= (a.v[i] <= b.v[i]) & (Int4{1, 2, 4, 8} << (4 * i));
  }
  return static_cast<std::uint32_t>((bits[0] | bits[1]) | (bits[2] | bits[3]));
}

/// Appends `base` + slot for every slot of `bits`.
static inline int append(std::uint32_t bits, std::uint32_t base, std::uint32_t* list, int count) {
  for (; bits != 0; bits &= bits - 1) {
    list[count++] = base + static_cast<std::uint32_t>(lowestBit(bits));
  }
  return count;
}
/// The same with where each is entered.
static inline int append(std::uint32_t bits, std::uint32_t base, const Float16& near,
                         std::uint32_t* list, float* nears, int count) {
  float all[kSlots];
  store16(all, near);
  for (; bits != 0; bits &= bits - 1) {
    const int slot = lowestBit(bits);
    nears[count] = all[slot];
    list[count++] = base + static_cast<std::uint32_t>(slot);
  }
  return count;
}

/// Sixteen rays in lanes: origins relative to a center, and directions, of six numbers a ray:
/// origin and direction, or start and end.
template <bool kAreSegments>
static inline void loadRays(const double* rays, const Double4& center, Float16* origin,
                            Float16* direction) {
  for (int i = 0; i < 3; ++i) {
    alignas(64) float o[kSlots];
    alignas(64) float d[kSlots];
    for (int k = 0; k < kSlots; ++k) {
      o[k] = static_cast<float>(rays[6 * k + i] - center.v[i]);
      d[k] = static_cast<float>(rays[6 * k + 3 + i] - (kAreSegments ? rays[6 * k + i] : 0.0));
    }
    origin[i] = load16(o);
    direction[i] = load16(d);
  }
}

/// What boxes of a block are compared in, where there are more than eight.
using BlockLanes = Float8;
/// See Kernels. (Measured.)
static bool prefersBlocks(std::size_t boxes, const Density& density) {
  return boxes <= 16 || (boxes <= 48 && density.bounds_met > 1.0);
}
