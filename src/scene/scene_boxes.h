// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The boxes of a scene, as they were given and as queries solve them.
#pragma once

#include "scene/prepared_boxes.h"

#include <box_query/geometry.h>

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

namespace box_query {

/// Whether two boxes are the same numbers.
inline bool isSame(const Box& a, const Box& b) {
  if (const auto* first = std::get_if<AlignedBox>(&a)) {
    const auto* second = std::get_if<AlignedBox>(&b);
    return second != nullptr && first->min == second->min && first->max == second->max;
  }
  const auto& first = *std::get_if<OrientedBox>(&a);
  const auto* second = std::get_if<OrientedBox>(&b);
  return second != nullptr && first.center == second->center &&
         first.half_extents == second->half_extents &&
         first.orientation.coeffs() == second->orientation.coeffs();
}

/// What can be worked out of a box is not kept: it takes less time than to wait for it from memory.
class SceneBoxes {
 public:
  /// @pre isValid() of each
  explicit SceneBoxes(std::vector<Box> boxes);

  std::size_t size() const { return given_.size(); }
  const std::vector<Box>& given() const { return given_; }

  /// The box; an oriented one that is an aligned one, exactly, in that form. Only faces and normals
  /// need the box as it was given.
  const Box& simplest(std::size_t i) const {
    return form_of_.empty() || form_of_[i] == kItself ? given_[i] : forms_[form_of_[i]];
  }
  PreparedBox prepared(std::size_t i) const { return PreparedBox(simplest(i)); }

 private:
  static constexpr std::uint32_t kItself = ~std::uint32_t{0};

  std::vector<Box> given_;
  std::vector<Box> forms_;
  std::vector<std::uint32_t> form_of_;  ///< empty where no box has another form
};

}  // namespace box_query
