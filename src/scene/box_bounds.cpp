// SPDX-License-Identifier: BSD-3-Clause
#include "scene/box_bounds.h"

#include "kernels/float_bounds.h"

#include <cmath>
#include <cstddef>
#include <limits>

namespace box_query {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

/// More than what rounding takes from a bound, relative to |middle| + half: the axes are within 10
/// units of 2^-53, and a difference in double and a float follow.
constexpr double kOutward = 0x1p-23;

}  // namespace

Extent extentOf(const PreparedBox& box) {
  Extent r;
  if (box.kind == PreparedBox::Kind::kAligned) {
    for (int j = 0; j < 3; ++j) {
      r.middle[j] = 0.5 * (box.aligned.bound[0][j] + box.aligned.bound[1][j]);
      r.half[j] = 0.5 * (box.aligned.bound[1][j] - box.aligned.bound[0][j]);
    }
    return r;
  }
  const OrientedSlabs& slabs = box.oriented;
  for (int j = 0; j < 3; ++j) {
    r.middle[j] = slabs.center[j];
    r.half[j] = std::fabs(slabs.axes[0][j]) * slabs.half_extents[0] +
                std::fabs(slabs.axes[1][j]) * slabs.half_extents[1] +
                std::fabs(slabs.axes[2][j]) * slabs.half_extents[2];
  }
  return r;
}

bool findBounds(const Extent& r, const double* center, FloatBounds& bounds) {
  for (int j = 0; j < 3; ++j) {
    const double middle = r.middle[j] - center[j];
    // The middle of an aligned box is rounded at its own size, not at that of the difference.
    const double slack =
        kOutward * (std::fabs(middle) + r.half[j]) + 0x1p-50 * std::fabs(r.middle[j]) + 0x1p-100;
    bounds.lo[j] = static_cast<float>((middle - r.half[j]) - slack);
    bounds.hi[j] = static_cast<float>((middle + r.half[j]) + slack);
    if (!(std::fabs(middle) + r.half[j] < kernels::kFarthestOrigin)) {
      return false;
    }
  }
  return true;
}

kernels::BoxRecord recordOf(const PreparedBox& box) {
  kernels::BoxRecord record = {};
  if (box.kind == PreparedBox::Kind::kAligned) {
    for (int i = 0; i < 3; ++i) {
      record.column[0][i] = box.aligned.bound[0][i];
      record.column[1][i] = box.aligned.bound[1][i];
    }
    record.extent[3] = -1.0;
    return record;
  }
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      record.column[j][i] = box.oriented.axes[i][j];
    }
    record.column[j][3] = box.oriented.center[j];
    record.extent[j] = box.oriented.half_extents[j];
  }
  record.extent[3] = box.oriented.padded_extent_sum;
  return record;
}

namespace {

/// What is known of a box that is kept as an oriented one in float.
struct FloatForm {
  double half_extents[3];
  double size;   ///< |center|_1 + |half extents|_1, relative to the center of the scene
  double error;  ///< of its center, beside that of floats
};

/// Sets axes and center of a box in a slot.
template <typename Boxes>
FloatForm setForm(Boxes& boxes, std::size_t slot, const kernels::BoxRecord& box,
                  const double* scene_center) {
  FloatForm form = {{}, 0.0, kernels::bounds::kFloatUnderflow};
  for (int j = 0; j < 3; ++j) {
    double middle = box.column[j][3];
    form.half_extents[j] = box.extent[j];
    for (int i = 0; i < 3; ++i) {
      boxes.axis[i][j][slot] = static_cast<float>(box.column[j][i]);
    }
    if (box.isAligned()) {
      middle = 0.5 * (box.column[0][j] + box.column[1][j]);
      form.half_extents[j] = 0.5 * (box.column[1][j] - box.column[0][j]);
      for (int i = 0; i < 3; ++i) {
        boxes.axis[i][j][slot] = i == j ? 1.0F : 0.0F;
      }
      form.error += 0x1p-50 * std::fabs(middle);  // it is rounded at its own size
    }
    const double relative = middle - scene_center[j];
    boxes.center[j][slot] = static_cast<float>(relative);
    form.size += std::fabs(relative) + form.half_extents[j];
  }
  return form;
}

}  // namespace

/// Boxes in blocks; none if one of them is too far away, or too large.
/// @pre every one is for the kernels
std::vector<kernels::BoxBlock> blocksOf(const std::vector<kernels::BoxRecord>& records,
                                        const double* scene_center) {
  constexpr std::size_t kSlots = kernels::kSlots;
  std::vector<kernels::BoxBlock> blocks((records.size() + kSlots - 1) / kSlots);
  for (std::size_t k = 0; k < kSlots * blocks.size(); ++k) {
    kernels::BoxBlock& block = blocks[k / kSlots];
    const std::size_t slot = k % kSlots;
    if (k >= records.size()) {
      clearSlot(block, slot);
      continue;
    }
    const FloatForm form = setForm(block, slot, records[k], scene_center);
    if (!(form.size <= kernels::kFarthestInBlocks)) {
      return {};
    }
    const double outward = form.error + kernels::bounds::kBlock * form.size;
    const double inward = form.error + kernels::bounds::kInBlock * form.size;
    for (int i = 0; i < 3; ++i) {
      const double extent = form.half_extents[i];
      block.extent[i][slot] = static_cast<float>((extent + outward) * kernels::bounds::kUp);
      block.certain[i][slot] = static_cast<float>(extent * (2.0 - kernels::bounds::kUp) - inward);
    }
  }
  return blocks;
}

void clearSlot(kernels::BoxBlock& block, std::size_t slot) {
  for (int i = 0; i < 3; ++i) {
    block.extent[i][slot] = -kInf;
    block.certain[i][slot] = -kInf;
  }
}

kernels::LeafBoxes emptyLeaf() {
  kernels::LeafBoxes leaf = {};
  for (std::size_t slot = 0; slot < kernels::kSlots; ++slot) {
    clearSlot(leaf, slot);
  }
  return leaf;
}

void clearSlot(kernels::LeafBoxes& leaf, std::size_t slot) {
  leaf.center[0][slot] = std::numeric_limits<float>::quiet_NaN();
}

void setSlot(kernels::LeafBoxes& leaf, std::size_t slot, const kernels::BoxRecord& box,
             const double* scene_center) {
  const FloatForm form = setForm(leaf, slot, box, scene_center);
  for (int i = 0; i < 3; ++i) {
    leaf.extent[i][slot] = static_cast<float>(form.half_extents[i]);
  }
  leaf.error[slot] =
      static_cast<float>((kernels::bounds::kLoss * form.size + form.error) * kernels::bounds::kUp);
}

}  // namespace box_query
