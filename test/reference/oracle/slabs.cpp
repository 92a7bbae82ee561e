// SPDX-License-Identifier: BSD-3-Clause
#include "reference/oracle/slabs.h"

namespace box_query::oracle {
namespace {

DyadicVector exact(const Vector3& v) {
  return {Dyadic(v[0]), Dyadic(v[1]), Dyadic(v[2])};
}

DyadicVector difference(const DyadicVector& a, const DyadicVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

}  // namespace

ExactComponent::ExactComponent(const Line& line)
    : kind(Kind::kLine), origin(exact(line.origin)), direction(exact(line.direction)) {}

ExactComponent::ExactComponent(const Ray& ray)
    : kind(Kind::kRay), origin(exact(ray.origin)), direction(exact(ray.direction)) {}

ExactComponent::ExactComponent(const Segment& segment)
    : kind(Kind::kSegment),
      origin(exact(segment.start)),
      direction(difference(exact(segment.end), origin)) {}

bool ExactComponent::isPoint() const {
  return direction[0].sign() == 0 && direction[1].sign() == 0 && direction[2].sign() == 0;
}

ExactBox::ExactBox(const AlignedBox& box) : low(exact(box.min)), high(exact(box.max)) {}

ExactBox::ExactBox(const OrientedBox& box) : center(exact(box.center)), rotated(true) {
  const Dyadic w = box.orientation.w();
  const Dyadic x = box.orientation.x();
  const Dyadic y = box.orientation.y();
  const Dyadic z = box.orientation.z();
  const Dyadic ww = w * w;
  const Dyadic xx = x * x;
  const Dyadic yy = y * y;
  const Dyadic zz = z * z;
  const Dyadic wx = w * x;
  const Dyadic wy = w * y;
  const Dyadic wz = w * z;
  const Dyadic xy = x * y;
  const Dyadic xz = x * z;
  const Dyadic yz = y * z;
  columns[0] = {ww + xx - yy - zz, (xy + wz).scaled(1), (xz - wy).scaled(1)};
  columns[1] = {(xy - wz).scaled(1), ww - xx + yy - zz, (yz + wx).scaled(1)};
  columns[2] = {(xz + wy).scaled(1), (yz - wx).scaled(1), ww - xx - yy + zz};
  n = ww + xx + yy + zz;
  for (std::size_t i = 0; i < 3; ++i) {
    high[i] = n * Dyadic(box.half_extents[static_cast<Eigen::Index>(i)]);
    low[i] = -high[i];
  }
}

ExactBox::ExactBox(const Box& box)
    : ExactBox(std::visit([](const auto& b) { return ExactBox(b); }, box)) {}

DyadicVector ExactBox::toBox(const DyadicVector& v) const {
  return rotated ? DyadicVector{dot(columns[0], v), dot(columns[1], v), dot(columns[2], v)} : v;
}

DyadicVector ExactBox::toWorld(const DyadicVector& v) const {
  if (!rotated) {
    return v;
  }
  DyadicVector result;
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = columns[0][i] * v[0] + columns[1][i] * v[1] + columns[2][i] * v[2];
  }
  return result;
}

Slabs::Slabs(const ExactComponent& component, const ExactBox& box)
    : kind(component.kind),
      y(box.toBox(difference(component.origin, box.center))),
      d(box.toBox(component.direction)),
      low(box.low),
      high(box.high),
      n(box.n) {}

}  // namespace box_query::oracle
