// SPDX-License-Identifier: BSD-3-Clause
// The axes of a box in double-double: of its quaternion, or of its record with what that lacks.
//
// In double-double n and M are within 8u^2 n (exact/bounds.h). The rest of M_ij / n beside a double
// within 16u of it is (M_ij - n R_ij) / n, in which the first difference is exact, those of the
// second parts are off by 40u^2 n, and the quotient by 4u of 16u: an entry is within 128u^2.
// Kept as a float, its rest is off by another 2^-24 of 16u: within kRests.

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Lane i of column j is coordinate j of axis i.
struct BoxFrame {
  Wide4 column[3];
  double error;  ///< of each, and of what dot products of them add
};

/// The same times n = |q|^2.
struct StretchedFrame {
  Wide4 n;
  Wide4 column[3];
};

/// Of the first three lanes those that `bits` has of b, of a the others.
template <int kBits>
static inline Wide4 replaced(const Wide4& a, const Wide4& b) {
  return {replaced<kBits>(a.hi, b.hi), replaced<kBits>(a.lo, b.lo)};
}

/// @param quaternion x, y, z, w
static inline StretchedFrame stretchedFrame(const double* quaternion) {
  const WideFrame by_axis = wideFrame(quaternion);  // its own coordinate i first
  const Wide4& own = by_axis.axis0;
  const Wide4& next = by_axis.axis1;
  const Wide4& last = by_axis.axis2;
  return {normalized(by_axis.n),
          {replaced<2>(replaced<4>(own, next), last), replaced<1>(replaced<4>(own, last), next),
           replaced<1>(replaced<2>(own, next), last)}};
}

/// Whether what underflows is far below the error.
static inline bool isInRange(const Wide4& n) {
  return firstLane(n.hi) >= exact::bounds::kSmallestStretch &&
         firstLane(n.hi) <= exact::bounds::kLargestStretch;
}

/// What `axis` lacks of M / n.
static inline Double4 restOf(const Wide4& stretched, const Wide4& n, Double4 inverse_n,
                             Double4 axis) {
  const Wide4 product = twoProduct(n.hi, axis);
  const Double4 rest =
      ((stretched.hi - product.hi) - product.lo) + fusedNegative(n.lo, axis, stretched.lo);
  return rest * inverse_n;
}

/// With an error of NaN where it is nothing.
static inline BoxFrame boxFrame(const double* quaternion) {
  const StretchedFrame stretched = stretchedFrame(quaternion);
  const Double4 inverse_n = all4(1.0) / stretched.n.hi;
  BoxFrame frame;
  for (int j = 0; j < 3; ++j) {
    const Double4 axis = stretched.column[j].hi * inverse_n;
    frame.column[j] = {axis, restOf(stretched.column[j], stretched.n, inverse_n, axis)};
  }
  frame.error = isInRange(stretched.n) ? exact::bounds::kFrame : kNan;
  return frame;
}

static inline BoxFrame boxFrame(const BoxRecord& box, const AxisRests& rests) {
  BoxFrame frame;
  for (int j = 0; j < 3; ++j) {
    frame.column[j] = {load4(box.column[j]), asDoubles(rests.column[j])};
  }
  frame.error = exact::bounds::kRests;
  return frame;
}

static void findRests(const double* quaternion, const BoxRecord& box, AxisRests& rests) {
  const StretchedFrame stretched = stretchedFrame(quaternion);
  const Double4 inverse_n = all4(1.0) / stretched.n.hi;
  for (int j = 0; j < 3; ++j) {
    storeAsFloats(rests.column[j],
                  restOf(stretched.column[j], stretched.n, inverse_n, load4(box.column[j])));
  }
  if (!isInRange(stretched.n)) {
    rests.column[0][0] = static_cast<float>(kNan);
  }
}
