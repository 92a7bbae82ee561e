// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The boxes of a scene, as they were given and as queries solve them.
#pragma once

#include "scene/prepared_boxes.h"

#include <box_query/geometry.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace box_query {

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
