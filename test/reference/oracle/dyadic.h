// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Exact numbers of the oracle: dyadic rationals and fractions of them. No common factor is ever
/// taken out: fractions are compared by cross multiplication, which costs far less.
#pragma once

#include <array>
#include <utility>

#include <gmpxx.h>

namespace box_query::oracle {

/// mantissa * 2^exponent, of any size. Sums, differences and products of doubles are dyadic.
class Dyadic {
 public:
  Dyadic() = default;
  /// The exact value of a finite double.
  Dyadic(double value);  // NOLINT(google-explicit-constructor): a double is a dyadic number.

  int sign() const { return sgn(mantissa_); }
  /// This number times 2^power.
  Dyadic scaled(long power) const;
  mpq_class toRational() const;

  Dyadic operator-() const;
  friend Dyadic operator+(const Dyadic& a, const Dyadic& b);
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b);
  friend Dyadic operator*(const Dyadic& a, const Dyadic& b);
  /// Sign of a - b.
  friend int compare(const Dyadic& a, const Dyadic& b);
  /// a / b within a few parts in 2^53, for reports only. b is not zero.
  friend double approximateRatio(const Dyadic& a, const Dyadic& b);

 private:
  /// Sum of a and sign * b.
  static Dyadic sum(const Dyadic& a, const Dyadic& b, int sign);
  /// Position of the highest bit: 2^(top - 1) <= |value| < 2^top. Not for zero.
  long top() const;

  mpz_class mantissa_;
  long exponent_ = 0;
};

using DyadicVector = std::array<Dyadic, 3>;

inline Dyadic square(const Dyadic& a) {
  return a * a;
}
Dyadic dot(const DyadicVector& a, const DyadicVector& b);

/// numerator / denominator, the denominator greater than zero.
struct Fraction {
  Dyadic numerator;
  Dyadic denominator = 1.0;

  mpq_class toRational() const;
};

/// Sign of a - b.
int compare(const Fraction& a, const Fraction& b);
inline bool operator<(const Fraction& a, const Fraction& b) {
  return compare(a, b) < 0;
}
double approximate(const Fraction& value);

/// The smaller root of a t^2 + 2 b t + c = 0, (-b - sqrt(discriminant)) / a with a > 0 and
/// discriminant = b^2 - a c >= 0.
struct Root {
  Dyadic a = 1.0;
  Dyadic b;
  Dyadic discriminant;

  Root() = default;
  Root(Dyadic a_, Dyadic b_, Dyadic discriminant_)
      : a(std::move(a_)), b(std::move(b_)), discriminant(std::move(discriminant_)) {}
  explicit Root(const Fraction& value) : a(value.denominator), b(-value.numerator) {}
  explicit Root(double value) : b(-value) {}
};

/// Sign of p - q.
int compare(const Root& p, const Root& q);
double approximate(const Root& root);

}  // namespace box_query::oracle
