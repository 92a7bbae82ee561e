// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene_impl.h"

#include <box_query/scene.h>

#include <optional>
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

namespace {

void checkBoxes(const std::vector<Box>& boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!isValid(boxes[i])) {
      throw std::invalid_argument("box " + std::to_string(i) +
                                  " of the scene is not valid: every number must be finite, sizes "
                                  "not negative, the orientation not zero");
    }
  }
}

BoxChanges changesOf(const SceneBoxes& before, const SceneBoxes& boxes,
                     const std::vector<std::size_t>& previous) {
  BoxChanges changes;
  changes.now.resize(before.size(), BoxChanges::kGone);
  changes.is_new.resize(boxes.size());
  changes.removed = before.size();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const std::size_t old = previous[i];
    if (old == kNoBox) {
      changes.added.push_back(static_cast<std::uint32_t>(i));
      changes.is_new[i] = true;
      continue;
    }
    if (old >= before.size() || changes.now[old] != BoxChanges::kGone) {
      throw std::invalid_argument("previous index " + std::to_string(old) + " of box " +
                                  std::to_string(i) + " is none, or that of another box too");
    }
    changes.now[old] = static_cast<std::uint32_t>(i);
    --changes.removed;
    if (!isSame(before.given()[old], boxes.given()[i])) {
      changes.is_new[i] = true;
      ++changes.moved;
    }
  }
  return changes;
}

}  // namespace

Scene::Impl::Impl(std::vector<Box> all) : boxes(std::move(all)), tree(boxes) {
  update.added = boxes.size();
  view = tree.view();
}

Scene::Impl::Impl(const Impl& before, std::vector<Box> all,
                  const std::vector<std::size_t>& previous)
    : boxes(std::move(all)) {
  const BoxChanges changes = changesOf(before.boxes, boxes, previous);
  std::optional<BoxTree> updated = before.tree.updated(boxes, changes);
  update = {!updated.has_value(), changes.moved, changes.added.size(), changes.removed};
  tree = updated ? std::move(*updated) : BoxTree(boxes);
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
  checkBoxes(boxes);
  impl_ = std::make_shared<const Impl>(std::move(boxes));
}

Scene::Scene(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

Scene Scene::updated(std::vector<Box> boxes, const std::vector<std::size_t>& previous) const {
  checkBoxes(boxes);
  if (previous.size() != boxes.size()) {
    throw std::invalid_argument("there are " + std::to_string(previous.size()) +
                                " previous indices for " + std::to_string(boxes.size()) + " boxes");
  }
  return Scene(std::make_shared<const Impl>(*impl_, std::move(boxes), previous));
}

const SceneUpdate& Scene::update() const noexcept {
  return impl_->update;
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
