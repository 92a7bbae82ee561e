// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the tree of a scene keeps of one box.
#pragma once

#include "kernels/scene_view.h"
#include "scene/prepared_boxes.h"
#include "scene/tree_partition.h"

#include <cstddef>
#include <vector>

namespace box_query {

/// The middle of a box and how far it extents along the axes of the world.
struct Extent {
  double middle[3];
  double half[3];
};

/// @pre the box is not kExactOnly
Extent extentOf(const PreparedBox& box);

/// Sets the bounds of a box relative to the center of its scene.
/// @return whether the kernels may take it: all of it is near enough
bool findBounds(const Extent& r, const double* center, FloatBounds& bounds);

/// @pre the box is not kExactOnly
kernels::BoxRecord recordOf(const PreparedBox& box);

/// Boxes in blocks; none if one of them is too far away, or too large.
/// @pre every one is for the kernels
std::vector<kernels::BoxBlock> blocksOf(const std::vector<kernels::BoxRecord>& records,
                                        const double* scene_center);
void clearSlot(kernels::BoxBlock& block, std::size_t slot);

/// Leaves without boxes.
kernels::LeafBoxes emptyLeaf();
void setSlot(kernels::LeafBoxes& leaf, std::size_t slot, const kernels::BoxRecord& box,
             const double* scene_center);
void clearSlot(kernels::LeafBoxes& leaf, std::size_t slot);

}  // namespace box_query
