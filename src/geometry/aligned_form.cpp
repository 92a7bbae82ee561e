// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/aligned_form.h"

#include "exact/double_double.h"

#include <cmath>

namespace box_query {
namespace {

/// The sign of each component of q, if all but zeros have the same magnitude.
bool signsOf(const Quaternion& q, int (&signs)[4], int& count) {
  const double values[4] = {q.w(), q.x(), q.y(), q.z()};
  double magnitude = 0.0;
  count = 0;
  for (int i = 0; i < 4; ++i) {
    signs[i] = (values[i] > 0.0) - (values[i] < 0.0);
    if (signs[i] != 0) {
      if (count > 0 && std::fabs(values[i]) != magnitude) {
        return false;
      }
      magnitude = std::fabs(values[i]);
      ++count;
    }
  }
  return true;
}

}  // namespace

std::optional<AlignedForm> findAlignedForm(const OrientedBox& box) {
  int s[4];
  int n = 0;
  // With 1, 2 or 4 equal magnitudes M / n is a permutation with signs; with 3 it is not.
  if (!signsOf(box.orientation, s, n) || n == 3) {
    return std::nullopt;
  }
  const int w = s[0], x = s[1], y = s[2], z = s[3];
  const int axes[3][3] = {
      {w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)},
      {2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)},
      {2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z}};
  AlignedForm form;
  for (int i = 0; i < 3; ++i) {
    const int j = axes[i][0] != 0 ? 0 : (axes[i][1] != 0 ? 1 : 2);
    const exact::DoubleDouble lo = exact::twoDiff(box.center[j], box.half_extents[i]);
    const exact::DoubleDouble hi = exact::twoSum(box.center[j], box.half_extents[i]);
    if (lo.lo != 0.0 || hi.lo != 0.0) {  // also where a sum overflows: NaN
      return std::nullopt;
    }
    form.box.min[j] = lo.hi;
    form.box.max[j] = hi.hi;
    const bool same = axes[i][j] > 0;
    const auto world = static_cast<std::size_t>(j);
    form.own_face[2 * world] = static_cast<std::uint8_t>(FaceSet::number(i, !same));
    form.own_face[2 * world + 1] = static_cast<std::uint8_t>(FaceSet::number(i, same));
  }
  return form;
}

}  // namespace box_query
