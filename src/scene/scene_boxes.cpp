// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene_boxes.h"

#include "geometry/aligned_form.h"

#include <utility>
#include <variant>

namespace box_query {
namespace {

/// Boxes with another form, from which on it is foreseen how many there will be.
constexpr std::size_t kSample = 64;

}  // namespace

SceneBoxes::SceneBoxes(std::vector<Box> boxes) : given_(std::move(boxes)) {
  for (std::size_t i = 0; i < given_.size(); ++i) {
    if (const auto* oriented = std::get_if<OrientedBox>(&given_[i])) {
      if (const auto form = alignedForm(*oriented)) {
        form_of_.resize(given_.size(), kItself);
        form_of_[i] = static_cast<std::uint32_t>(forms_.size());
        if (forms_.size() == kSample) {  // the others are most likely as these are
          forms_.reserve((kSample + 1) * given_.size() / (i + 1));
        }
        forms_.emplace_back(form->box);
      }
    }
  }
}

}  // namespace box_query
