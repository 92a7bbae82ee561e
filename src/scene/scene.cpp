// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene_impl.h"

#include <box_query/scene.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace box_query {

BoxMask::BoxMask(std::size_t size, bool all)
    : size_(size), words_((size + 63) / 64, all ? ~std::uint64_t{0} : std::uint64_t{0}) {}

void BoxMask::set(std::size_t box, bool look) noexcept {
  const std::uint64_t bit = std::uint64_t{1} << (box % 64);
  words_[box / 64] = look ? words_[box / 64] | bit : words_[box / 64] & ~bit;
}

Scene::Impl::Impl(std::vector<Box> all) : boxes(std::move(all)) {
  std::vector<PreparedBox> prepared;
  prepared.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    prepared.push_back(boxes.prepared(i));
  }
  tree = BoxTree(prepared);
  view = tree.view();
}

const char* activeKernels() noexcept {
  return kernels::active().name;
}
bool isKernelChoiceRefused() noexcept {
  return kernels::isChoiceRefused();
}

Scene::Scene() : Scene(std::vector<Box>()) {}

Scene::Scene(std::vector<Box> boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!isValid(boxes[i])) {
      throw std::invalid_argument("box " + std::to_string(i) +
                                  " of the scene is not valid: every number must be finite, sizes "
                                  "not negative, the orientation not zero");
    }
  }
  impl_ = std::make_shared<const Impl>(std::move(boxes));
}

Scene::~Scene() = default;
Scene::Scene(const Scene&) = default;
Scene& Scene::operator=(const Scene&) = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

std::size_t Scene::size() const noexcept {
  return impl_->boxes.size();
}
const std::vector<Box>& Scene::boxes() const noexcept {
  return impl_->boxes.given();
}

}  // namespace box_query
