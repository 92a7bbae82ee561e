// SPDX-License-Identifier: BSD-3-Clause
#include "reference/oracle/interval.h"

namespace box_query::oracle {
namespace {

/// Where a component with d != 0 crosses the two planes of a slab.
struct Crossing {
  Fraction near;
  Fraction far;
  bool forward;  ///< Towards the positive side.
};

Crossing cross(const Dyadic& y, const Dyadic& d, const Dyadic& low, const Dyadic& high) {
  if (d.sign() > 0) {
    return {{low - y, d}, {high - y, d}, true};
  }
  const Dyadic speed = -d;
  return {{y - high, speed}, {y - low, speed}, false};
}

bool contains(const Dyadic& y, const Dyadic& low, const Dyadic& high) {
  return compare(low, y) <= 0 && compare(y, high) <= 0;
}

void clip(const Crossing& crossing, int axis, Interval& result) {
  const Bound near{0, crossing.near};
  const Bound far{0, crossing.far};
  const int later = compare(near, result.enter);
  if (later > 0) {
    result.enter = near;
    result.entered = FaceSet();
  }
  if (later >= 0) {
    result.entered.insert(axis, !crossing.forward);
  }
  const int earlier = compare(far, result.exit);
  if (earlier < 0) {
    result.exit = far;
    result.left = FaceSet();
  }
  if (earlier <= 0) {
    result.left.insert(axis, crossing.forward);
  }
}

}  // namespace

int compare(const Bound& a, const Bound& b) {
  if (a.infinity != 0 || b.infinity != 0) {
    return a.infinity < b.infinity ? -1 : (a.infinity > b.infinity ? 1 : 0);
  }
  return compare(a.value, b.value);
}

Interval interval(const ExactComponent& component, const ExactBox& box) {
  const Slabs slabs(component, box);
  Interval result;
  result.enter.infinity = slabs.kind == Kind::kLine ? -1 : 0;
  result.exit.infinity = slabs.kind == Kind::kSegment ? 0 : 1;
  result.exit.value.numerator = 1.0;

  bool start_inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool inside = contains(slabs.y[i], slabs.low[i], slabs.high[i]);
    start_inside = start_inside && inside;
    if (slabs.d[i].sign() != 0) {
      clip(cross(slabs.y[i], slabs.d[i], slabs.low[i], slabs.high[i]), static_cast<int>(i), result);
    } else if (!inside) {
      return Interval();
    }
  }
  const int length = compare(result.exit, result.enter);
  if (length < 0) {
    return Interval();
  }
  result.num_points = length == 0 || component.isPoint() ? 1 : 2;
  result.started_inside = start_inside && slabs.kind != Kind::kLine;
  return result;
}

Fraction squaredRange(const Fraction& t, const ExactComponent& component) {
  return {square(t.numerator) * dot(component.direction, component.direction),
          square(t.denominator)};
}

}  // namespace box_query::oracle
