// SPDX-License-Identifier: BSD-3-Clause
// Double-doubles (exact/double_double.h), several at a time, and what exact/clip.h makes of a box
// and a component in them, all three axes side by side.

/// The unevaluated sum hi + lo.
template <typename Lanes>
struct Wide {
  Lanes hi;
  Lanes lo;
};
using Wide4 = Wide<Double4>;

template <typename Lanes>
static inline Wide<Lanes> twoSum(const Lanes& a, const Lanes& b) {
  const Lanes sum = a + b;
  const Lanes rest = sum - a;
  return {sum, (a - (sum - rest)) + (b - rest)};
}
template <typename Lanes>
static inline Wide<Lanes> fastTwoSum(const Lanes& a, const Lanes& b) {
  const Lanes sum = a + b;
  return {sum, b - (sum - a)};
}
template <typename Lanes>
static inline Wide<Lanes> twoProduct(const Lanes& a, const Lanes& b) {
  const Lanes product = a * b;
  return {product, restOfProduct(a, b, product)};
}
// None of these makes lo small beside hi again, which would be the longest part of the way to a
// result; normalized() does where it matters.
template <typename Lanes>
static inline Wide<Lanes> operator+(const Wide<Lanes>& a, const Wide<Lanes>& b) {
  const Wide<Lanes> sum = twoSum(a.hi, b.hi);
  return {sum.hi, sum.lo + (a.lo + b.lo)};
}
template <typename Lanes>
static inline Wide<Lanes> operator-(const Wide<Lanes>& a, const Wide<Lanes>& b) {
  const Wide<Lanes> sum = twoSum(a.hi, negated(b.hi));
  return {sum.hi, sum.lo + (a.lo - b.lo)};
}
template <typename Lanes>
static inline Wide<Lanes> operator*(const Wide<Lanes>& a, const Lanes& b) {
  const Wide<Lanes> product = twoProduct(a.hi, b);
  return {product.hi, fused(a.lo, b, product.lo)};
}
static inline Wide4 turned(const Wide4& a) {
  return {turned(a.hi), turned(a.lo)};
}
static inline Wide4 turnedTwice(const Wide4& a) {
  return {turnedTwice(a.hi), turnedTwice(a.lo)};
}
template <typename Lanes>
static inline Wide<Lanes> withSignOf(const Wide<Lanes>& a, const Lanes& b) {
  return {withSignOf(a.hi, b), withSignOf(a.lo, b)};
}
template <typename Lanes>
static inline Wide<Lanes> normalized(const Wide<Lanes>& a) {
  return fastTwoSum(a.hi, a.lo);
}
/// a0 b0 + a1 b1 + a2 b2.
template <typename Lanes>
static inline Wide<Lanes> sumOfProducts(const Wide<Lanes>& a0, const Wide<Lanes>& b0,
                                        const Wide<Lanes>& a1, const Wide<Lanes>& b1,
                                        const Wide<Lanes>& a2, const Wide<Lanes>& b2) {
  const Wide<Lanes> p0 = twoProduct(a0.hi, b0.hi);
  const Wide<Lanes> p1 = twoProduct(a1.hi, b1.hi);
  const Wide<Lanes> p2 = twoProduct(a2.hi, b2.hi);
  const Lanes c0 = p0.lo + fused(a0.hi, b0.lo, a0.lo * b0.hi);
  const Lanes c1 = p1.lo + fused(a1.hi, b1.lo, a1.lo * b1.hi);
  const Lanes c2 = p2.lo + fused(a2.hi, b2.lo, a2.lo * b2.hi);
  const Wide<Lanes> s = twoSum(p0.hi, p1.hi);
  const Wide<Lanes> r = twoSum(s.hi, p2.hi);
  return {r.hi, (s.lo + r.lo) + ((c0 + c1) + c2)};
}
/// a / b of normalized ones, given q, which is a.hi / b.hi rounded as the product of a.hi and the
/// rounded `inverse` of b.hi: q is off by 2u, so that its rest is exact but for 10u^2 and is
/// divided with an error of 3u of 6u.
static inline Wide4 quotient(const Wide4& a, const Wide4& b, Double4 q, Double4 inverse) {
  const Wide4 product = twoProduct(q, b.hi);
  const Double4 rest = ((a.hi - product.hi) - product.lo) + fusedNegative(q, b.lo, a.lo);
  return fastTwoSum(q, rest * inverse);
}

/// The frame of a box stretched by n = |q|^2: lane i has axis i, its own coordinate i first.
struct WideFrame {
  Wide4 n;
  Wide4 axis0;
  Wide4 axis1;
  Wide4 axis2;

  Wide4 along(const Wide4& v) const {
    return sumOfProducts(axis0, v, axis1, turned(v), axis2, turnedTwice(v));
  }
};

/// @param quaternion x, y, z, w
static inline WideFrame wideFrame(const double* quaternion) {
  const Double4 imaginary = lanes4(quaternion);
  const Double4 real = all4(quaternion[3]);
  const Wide4 squares = twoProduct(imaginary, imaginary);
  const Wide4 along = twoProduct(real, real) + squares;
  const Wide4 across = turned(squares) + turnedTwice(squares);
  const Double4 doubled = imaginary + imaginary;
  const Wide4 mixed = twoProduct(doubled, turned(imaginary));
  const Wide4 turning = twoProduct(doubled, real);
  return {along + across, along - across, mixed + turnedTwice(turning),
          turnedTwice(mixed) - turned(turning)};
}
