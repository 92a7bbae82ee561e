// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/solve.h"
#include "scene/candidates.h"
#include "scene/counters.h"
#include "scene/scene_impl.h"

#include <box_query/scene.h>

#include <algorithm>
#include <type_traits>
#include <variant>

namespace box_query {
namespace {

/// Exact order of two boxes that the component meets.
template <typename T>
bool isEnteredBefore(const T& linear, const DoubleComponent& component, const Box& a,
                     const Box& b) {
  const auto solveBox = [&](const Box& box) {
    return std::visit([&](const auto& x) { return solve(linear, component, x); }, box);
  };
  Solution at_a = solveBox(a);
  Solution at_b = solveBox(b);
  return compareEntries(linear, a, at_a, b, at_b) < 0;
}

using Indices = std::vector<std::uint32_t>;

double addTo(void* indices, const kernels::Found& found) {
  for (int i = 0; i < found.count; ++i) {
    static_cast<Indices*>(indices)->push_back(found.candidates[i].box);
  }
  return 1.0;
}

}  // namespace

template <typename T>
std::vector<BoxIntersection> Scene::Impl::findAll(const T& linear, const BoxMask* mask) const {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const DoubleComponent component = doubleComponent(linear);
  Indices maybe;
  const auto addAlong = [&](const auto& ray) {
    kernels::Found found(&work_of_thread, addTo, &maybe);
    const auto ask = [&](const auto& half) {
      const kernels::Answer answer = kernels.all(view, rayQuery(half, kInf, mask), found);
      addTo(&maybe, found);
      return answer != kernels::Answer::kNotTaken;
    };
    if (ask(ray)) {
      return true;
    }
    if constexpr (std::is_same_v<std::decay_t<decltype(ray)>, Ray>) {
      const auto scaled = withDirectionNearOne(ray);
      return scaled && ask(*scaled);
    }
    return false;
  };
  bool taken = false;
  if constexpr (kHasStart<T>) {
    taken = addAlong(linear);
  } else {
    // A line is two rays.
    taken = addAlong(Ray{linear.origin, linear.direction}) &&
            addAlong(Ray{linear.origin, -linear.direction});
  }
  forEachOther(tree, taken, boxes.size(), mask, [&](std::size_t i) {
    if (!enclose<T>(component, boxes.prepared(i)).isMiss()) {
      maybe.push_back(static_cast<std::uint32_t>(i));
    }
    return true;
  });
  std::sort(maybe.begin(), maybe.end());
  maybe.erase(std::unique(maybe.begin(), maybe.end()), maybe.end());

  std::vector<BoxIntersection> found;
  for (const std::uint32_t i : maybe) {
    BoxIntersection candidate{
        i,
        std::visit([&](const auto& b) { return findIntersection(linear, b); }, boxes.given()[i])};
    if (candidate.intersection.num_points > 0) {
      found.push_back(candidate);
    }
  }
  // Rounding keeps the order, but for the parameters that it makes equal. Found in order of the
  // index, ties stay in it.
  std::stable_sort(
      found.begin(), found.end(), [&](const BoxIntersection& a, const BoxIntersection& b) {
        if (a.intersection.t_enter != b.intersection.t_enter) {
          return a.intersection.t_enter < b.intersection.t_enter;
        }
        return isEnteredBefore(linear, component, boxes.simplest(a.box), boxes.simplest(b.box));
      });
  return found;
}

std::vector<BoxIntersection> Scene::findAll(const Line& line, const BoxMask* mask) const {
  return impl_->findAll(line, mask);
}

std::vector<BoxIntersection> Scene::findAll(const Ray& ray, const BoxMask* mask) const {
  return impl_->findAll(ray, mask);
}

std::vector<BoxIntersection> Scene::findAll(const Segment& segment, const BoxMask* mask) const {
  return impl_->findAll(segment, mask);
}

}  // namespace box_query
