// SPDX-License-Identifier: BSD-3-Clause
#include "exact/clip.h"

#include "exact/rounding.h"

#include <cmath>
#include <limits>
#include <variant>

namespace box_query::exact {
Clip clip(const Component& component, const Box& box) {
  const Slabs in_frame = std::visit([&](const auto& b) { return slabs(component, b); }, box);
  Clip result;
  clip(in_frame, component.has_start, component.has_end, result);
  return result;
}

double rounded(const Parameter& t) {
  return t.den.sign() != 0 ? roundedQuotient(t.num, t.den)
                           : t.num.sign() * std::numeric_limits<double>::infinity();
}

double roundedRange(const Parameter& t, const Dyadic& squared_length) {
  if (squared_length.sign() == 0) {
    return 0.0;
  }
  const double range = roundedSqrt(t.num * t.num * squared_length, t.den * t.den);
  return t.num.sign() >= 0 || range == 0.0 ? range : -range;
}

bool isWithin(const Parameter& t, const Dyadic& squared_length, double range) {
  if (std::isinf(range) || squared_length.sign() == 0) {
    return true;
  }
  const Dyadic reach = Dyadic(range) * t.den;
  return t.num * t.num * squared_length <= reach * reach;
}

Vector3 roundedPoint(const Component& component, const Parameter& t) {
  Vector3 point;
  for (std::size_t i = 0; i < 3; ++i) {
    const Dyadic& start = component.origin[i];
    point[static_cast<int>(i)] = t.den.sign() != 0
                                     ? finiteCoordinate(roundedQuotient(
                                           start * t.den + t.num * component.direction[i], t.den))
                                     : roundedQuotient(start, 1.0);
  }
  return point;
}

}  // namespace box_query::exact
