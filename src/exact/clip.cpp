// SPDX-License-Identifier: BSD-3-Clause
#include "exact/clip.h"

#include "exact/rounding.h"

#include <cmath>
#include <limits>
#include <variant>

namespace box_query::exact {
namespace {

Dyadic3 dyadic(const Vector3& v) {
  return {v[0], v[1], v[2]};
}

Dyadic3 operator-(const Dyadic3& a, const Dyadic3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

}  // namespace

Component component(const Line& line) {
  return {dyadic(line.origin), dyadic(line.direction), false, false};
}

Component component(const Ray& ray) {
  return {dyadic(ray.origin), dyadic(ray.direction), true, false};
}

Component component(const Segment& segment) {
  return {dyadic(segment.start), dyadic(segment.end) - dyadic(segment.start), true, true};
}

Slabs slabs(const Component& component, const AlignedBox& box) {
  return {dyadic(box.min) - component.origin, dyadic(box.max) - component.origin,
          component.direction};
}

Slabs slabs(const Component& component, const OrientedBox& box) {
  const Dyadic w = box.orientation.w();
  const Dyadic x = box.orientation.x();
  const Dyadic y = box.orientation.y();
  const Dyadic z = box.orientation.z();
  const Dyadic ww = w * w, xx = x * x, yy = y * y, zz = z * z;
  const Dyadic xy = (x * y).scaled(1), xz = (x * z).scaled(1), yz = (y * z).scaled(1);
  const Dyadic wx = (w * x).scaled(1), wy = (w * y).scaled(1), wz = (w * z).scaled(1);
  const Dyadic n = ww + xx + yy + zz;
  const Dyadic3 axes[3] = {{ww + xx - yy - zz, xy + wz, xz - wy},
                           {xy - wz, ww - xx + yy - zz, yz + wx},
                           {xz + wy, yz - wx, ww - xx - yy + zz}};
  const Dyadic3 offset = component.origin - dyadic(box.center);

  Slabs result;
  for (std::size_t i = 0; i < 3; ++i) {
    const Dyadic position =
        axes[i][0] * offset[0] + axes[i][1] * offset[1] + axes[i][2] * offset[2];
    const Dyadic extent = n * box.half_extents[static_cast<int>(i)];
    result.below[i] = -extent - position;
    result.above[i] = extent - position;
    result.direction[i] = axes[i][0] * component.direction[0] +
                          axes[i][1] * component.direction[1] + axes[i][2] * component.direction[2];
  }
  return result;
}

int compare(const Parameter& a, const Parameter& b) {
  return compare(a.num * b.den, b.num * a.den);
}

Clip clip(const Slabs& slabs, bool has_start, bool has_end) {
  Clip result;
  result.enter = has_start ? Parameter{0.0, 1.0} : Parameter{-1.0, 0.0};
  result.exit = has_end ? Parameter{1.0, 1.0} : Parameter{1.0, 0.0};
  result.started_inside = has_start;
  bool is_point = true;
  bool outside = false;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const Dyadic& below = slabs.below[axis];
    const Dyadic& above = slabs.above[axis];
    const int sign = slabs.direction[axis].sign();
    const bool contains_start = below.sign() <= 0 && above.sign() >= 0;
    result.started_inside = result.started_inside && contains_start;
    if (sign == 0) {
      outside = outside || !contains_start;
      continue;
    }
    is_point = false;
    // For a direction d < 0: -above <= t * (-d) <= -below.
    const bool positive = sign > 0;
    const Dyadic length = abs(slabs.direction[axis]);
    const Parameter near{positive ? below : -above, length};
    const Parameter far{positive ? above : -below, length};
    const int enters = compare(near, result.enter);
    if (enters > 0) {
      result.enter = near;
      result.entered = FaceSet();
    }
    if (enters >= 0) {
      result.entered.insert(i, !positive);
    }
    const int leaves = compare(far, result.exit);
    if (leaves < 0) {
      result.exit = far;
      result.left = FaceSet();
    }
    if (leaves <= 0) {
      result.left.insert(i, positive);
    }
  }
  const int order = compare(result.enter, result.exit);
  if (!outside && (is_point || order <= 0)) {
    result.num_points = is_point || order == 0 ? 1 : 2;
  }
  return result;
}

Clip clip(const Component& component, const Box& box) {
  return clip(std::visit([&](const auto& b) { return slabs(component, b); }, box),
              component.has_start, component.has_end);
}

Dyadic squaredNorm(const Dyadic3& v) {
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
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
    point[static_cast<int>(i)] =
        t.den.sign() != 0 ? roundedQuotient(start * t.den + t.num * component.direction[i], t.den)
                          : roundedQuotient(start, 1.0);
  }
  return point;
}

}  // namespace box_query::exact
