// SPDX-License-Identifier: BSD-3-Clause
#include "reference/oracle/dyadic.h"

#include <cmath>
#include <cstdint>

namespace box_query::oracle {

Dyadic::Dyadic(double value) {
  int exponent = 0;
  // 53 bits as an integer, also where the double is denormal: frexp normalises.
  auto bits = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  exponent_ = exponent - 53;
  if (bits == 0) {
    exponent_ = 0;
    return;
  }
  const int zeros = __builtin_ctzll(static_cast<unsigned long long>(bits));
  mantissa_ = static_cast<long>(bits >> zeros);  // exact: the bits shifted out are zero
  exponent_ += zeros;
}

Dyadic Dyadic::scaled(long power) const {
  Dyadic result = *this;
  result.exponent_ += power;
  return result;
}

mpq_class Dyadic::toRational() const {
  mpq_class result(mantissa_);
  if (exponent_ >= 0) {
    mpq_mul_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent_));
  } else {
    mpq_div_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent_));
  }
  return result;
}

Dyadic Dyadic::operator-() const {
  Dyadic result = *this;
  mpz_neg(result.mantissa_.get_mpz_t(), result.mantissa_.get_mpz_t());
  return result;
}

Dyadic Dyadic::sum(const Dyadic& a, const Dyadic& b, int sign) {
  if (b.sign() == 0) {
    return a;
  }
  if (a.sign() == 0) {
    return sign > 0 ? b : -b;
  }
  const auto add = sign > 0 ? mpz_add : mpz_sub;
  Dyadic result;
  auto* const out = result.mantissa_.get_mpz_t();
  if (a.exponent_ >= b.exponent_) {
    mpz_mul_2exp(out, a.mantissa_.get_mpz_t(), static_cast<mp_bitcnt_t>(a.exponent_ - b.exponent_));
    add(out, out, b.mantissa_.get_mpz_t());
    result.exponent_ = b.exponent_;
  } else {
    mpz_mul_2exp(out, b.mantissa_.get_mpz_t(), static_cast<mp_bitcnt_t>(b.exponent_ - a.exponent_));
    add(out, a.mantissa_.get_mpz_t(), out);
    result.exponent_ = a.exponent_;
  }
  return result;
}

Dyadic operator+(const Dyadic& a, const Dyadic& b) {
  return Dyadic::sum(a, b, 1);
}

Dyadic operator-(const Dyadic& a, const Dyadic& b) {
  return Dyadic::sum(a, b, -1);
}

Dyadic operator*(const Dyadic& a, const Dyadic& b) {
  Dyadic result;
  if (a.sign() != 0 && b.sign() != 0) {
    mpz_mul(result.mantissa_.get_mpz_t(), a.mantissa_.get_mpz_t(), b.mantissa_.get_mpz_t());
    result.exponent_ = a.exponent_ + b.exponent_;
  }
  return result;
}

long Dyadic::top() const {
  return static_cast<long>(mpz_sizeinbase(mantissa_.get_mpz_t(), 2)) + exponent_;
}

int compare(const Dyadic& a, const Dyadic& b) {
  const int sign = a.sign();
  if (sign != b.sign()) {
    return sign < b.sign() ? -1 : 1;
  }
  if (sign == 0) {
    return 0;
  }
  if (a.top() != b.top()) {
    return a.top() < b.top() ? -sign : sign;
  }
  return (a - b).sign();
}

double approximateRatio(const Dyadic& a, const Dyadic& b) {
  long exponent_a = 0;
  long exponent_b = 0;
  const double mantissa_a = mpz_get_d_2exp(&exponent_a, a.mantissa_.get_mpz_t());
  const double mantissa_b = mpz_get_d_2exp(&exponent_b, b.mantissa_.get_mpz_t());
  return std::scalbln(mantissa_a / mantissa_b, exponent_a + a.exponent_ - exponent_b - b.exponent_);
}

Dyadic dot(const DyadicVector& a, const DyadicVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

mpq_class Fraction::toRational() const {
  return numerator.toRational() / denominator.toRational();
}

int compare(const Fraction& a, const Fraction& b) {
  return compare(a.numerator * b.denominator, b.numerator * a.denominator);
}

double approximate(const Fraction& value) {
  return approximateRatio(value.numerator, value.denominator);
}

namespace {

/// Sign of x + sqrt(u), u >= 0.
int signOfSum(const Dyadic& x, const Dyadic& u) {
  if (x.sign() >= 0) {
    return x.sign() > 0 || u.sign() > 0 ? 1 : 0;
  }
  return compare(u, square(x));
}

/// Sign of x + sqrt(u) - sqrt(v) for x >= 0: both sides of x + sqrt(u) <=> sqrt(v) are not
/// negative, so their squares compare alike: x^2 + u - v + sqrt(4 x^2 u) <=> 0.
int signOfDifference(const Dyadic& x, const Dyadic& u, const Dyadic& v) {
  const Dyadic x_squared = square(x);
  return signOfSum(x_squared + u - v, (x_squared * u).scaled(2));
}

}  // namespace

int compare(const Root& p, const Root& q) {
  // Times p.a q.a > 0: (q.b p.a - p.b q.a) - sqrt(p.disc q.a^2) + sqrt(q.disc p.a^2).
  const Dyadic x = q.b * p.a - p.b * q.a;
  const Dyadic u = q.discriminant * square(p.a);
  const Dyadic v = p.discriminant * square(q.a);
  return x.sign() >= 0 ? signOfDifference(x, u, v) : -signOfDifference(-x, v, u);
}

double approximate(const Root& root) {
  if (root.discriminant.sign() == 0) {
    return approximateRatio(-root.b, root.a);
  }
  // In units of a, so that nothing overflows that need not.
  return approximateRatio(-root.b, root.a) -
         std::sqrt(approximateRatio(root.discriminant, square(root.a)));
}

}  // namespace box_query::oracle
