// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which box a component enters first, decided exactly.
#pragma once

#include "geometry/solve.h"
#include "scene/candidates.h"
#include "scene/scene_impl.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

namespace box_query {

template <typename T>
Solution solveBox(const T& linear, const DoubleComponent& component, const Box& box) {
  if (const auto* aligned = std::get_if<AlignedBox>(&box)) {
    return solve(linear, component, *aligned);
  }
  return solve(linear, component, *std::get_if<OrientedBox>(&box));
}

/// Where the face of a box is on the same axis of the world, exactly: nothing if it is not across
/// it.
inline std::optional<exact::DoubleDouble> worldPlane(const Box& any, int axis, bool positive) {
  if (const auto* box = std::get_if<AlignedBox>(&any)) {
    return exact::DoubleDouble{positive ? box->max[axis] : box->min[axis], 0.0};
  }
  const auto& box = *std::get_if<OrientedBox>(&any);
  const auto turn = box.orientation.vec();
  if (turn[(axis + 1) % 3] != 0.0 || turn[(axis + 2) % 3] != 0.0 || !isCompact(box)) {
    return std::nullopt;
  }
  const double extent = box.half_extents[axis];
  return exact::twoSum(box.center[axis], positive ? extent : -extent);
}

/// Takes boxes in any order; of those that are entered first the one of the lowest index stays.
template <typename T>
class FirstEntered {
 public:
  FirstEntered(const T& linear, const SceneBoxes& boxes) : linear_(linear), boxes_(boxes) {}

  const T& linear() const { return linear_; }
  /// In double, for whoever needs it.
  const DoubleComponent& component() {
    if (!component_) {
      component_ = doubleComponent(linear_);
    }
    return *component_;
  }

  bool any() const { return best_.box != kNoBox; }
  std::size_t box() const { return best_.box; }

  /// Enclose the parameter of entry.
  double lower() const { return best_.enter_lo; }
  /// A box that is entered later cannot be the first any more.
  double upper() const { return best_.enter_hi; }

  Solution& solution() { return solutionOf(best_); }

  void offer(const kernels::Candidate& c) {
    if (c.enter_lo > upper()) {
      return;
    }
    if (c.certain) {
      take({c.box, c.enter_lo, c.enter_hi});
    } else if (crossesThinSlab<T>(component(), boxes_.prepared(c.box))) {
      take({c.box, c.enter_lo, c.exit_hi});
    } else {
      Entry entry{c.box, c.enter_lo, c.exit_hi};
      if (solutionOf(entry).num_points > 0) {
        take(std::move(entry));
      }
    }
  }
  /// @param t_end a box that is certainly entered beyond it is none
  void offer(std::size_t index, double t_end) {
    const kernels::Candidate c = candidateOf<T>(component(), boxes_.prepared(index), index);
    if (c.enter_lo <= c.exit_hi && c.enter_lo <= t_end) {
      offer(c);
    }
  }
  void offer(const kernels::Found& found) {
    forEachCandidate(found, [&](const kernels::Candidate& c) {
      offer(c);
      return true;
    });
  }

  /// For kernels::Kernels::closest.
  static double take(void* context, const kernels::Found& found) {
    auto& first = *static_cast<FirstEntered*>(context);
    first.offer(found);
    return first.upper();
  }

 private:
  static constexpr double kInf = std::numeric_limits<double>::infinity();

  /// A box that is certainly met, entered at a parameter in [enter_lo, enter_hi]. With constructors
  /// of its own: for others GCC clears the room for the solution first, 2 kB.
  struct Entry {
    Entry() {}  // NOLINT(modernize-use-equals-default)
    Entry(std::size_t number, double lo, double hi) : box(number), enter_lo(lo), enter_hi(hi) {}

    std::size_t box = kNoBox;
    double enter_lo = kInf;
    double enter_hi = kInf;
    std::optional<Solution> solution;
  };

  void take(Entry&& entry) {
    if (any() && isAtStart(entry) && isAtStart(best_)) {
      if (entry.box < best_.box) {
        best_ = std::move(entry);
      }
      return;
    }
    if (!any() || entry.enter_hi < best_.enter_lo ||
        (!isBehindEnteredFace(entry) && isBefore(entry, best_))) {
      best_ = std::move(entry);
    }
  }

  /// Whether it is entered where the component starts: inside of it, or on it.
  static bool isAtStart(const Entry& entry) { return kHasStart<T> && entry.enter_hi <= 0.0; }

  /// Whether a box begins at a face of the best one that is entered, across an axis of the world,
  /// so that it is entered with it or later, and has the higher index: the rule among shelves.
  bool isBehindEnteredFace(const Entry& entry) {
    if (entry.box < best_.box) {
      return false;
    }
    const FaceSet entered = solutionOf(best_).entered;
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool positive : {false, true}) {
        if (entered.contains(axis, positive)) {
          const auto face = worldPlane(boxes_.simplest(best_.box), axis, positive);
          const auto front = worldPlane(boxes_.simplest(entry.box), axis, positive);
          if (face && front && face->hi == front->hi && face->lo == front->lo) {
            return true;
          }
        }
      }
    }
    return false;
  }

  bool isBefore(Entry& a, Entry& b) {
    if (isSame(boxes_.simplest(a.box), boxes_.simplest(b.box))) {
      return a.box < b.box;  // as where two topics know of one thing
    }
    const int order = compareEntries(linear_, boxes_.simplest(a.box), solutionOf(a),
                                     boxes_.simplest(b.box), solutionOf(b));
    return order < 0 || (order == 0 && a.box < b.box);
  }

  Solution& solutionOf(Entry& e) {
    if (!e.solution) {
      e.solution = solveBox(linear_, component(), boxes_.simplest(e.box));
    }
    return *e.solution;
  }

  const T& linear_;
  const SceneBoxes& boxes_;
  std::optional<DoubleComponent> component_;
  Entry best_;
};

}  // namespace box_query
