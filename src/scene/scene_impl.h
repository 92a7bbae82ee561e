// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <box_query/scene.h>

#include <vector>

namespace box_query {

struct Scene::Impl {
  std::vector<Box> boxes;
};

/// Calls visit(index) for every box that the mask looks at, in order of the index, until it returns
/// false.
template <typename Visit>
void forEachBox(std::size_t size, const BoxMask* mask, Visit&& visit) {
  for (std::size_t i = 0; i < size; ++i) {
    if ((mask == nullptr || (*mask)[i]) && !visit(i)) {
      return;
    }
  }
}

}  // namespace box_query
