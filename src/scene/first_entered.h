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
Solution solveBox(const T& linear, const DoubleComponent& component, const Box& box,
                  const PreparedBox& prepared) {
  const bool moderate = prepared.kind != PreparedBox::Kind::kExactOnly;
  if (const auto* aligned = std::get_if<AlignedBox>(&box)) {
    return solve(linear, component, *aligned,
                 Prepared<AlignedSlabs>{prepared.aligned, moderate, prepared.compact});
  }
  return solve(linear, component, *std::get_if<OrientedBox>(&box),
               Prepared<OrientedSlabs>{prepared.oriented, moderate, prepared.compact});
}

/// Takes boxes in any order; of those that are entered first the one of the lowest index stays.
template <typename T>
class FirstEntered {
 public:
  FirstEntered(const T& linear, const std::vector<Box>& boxes,
               const std::vector<PreparedBox>& prepared)
      : linear_(linear), boxes_(boxes), prepared_(prepared) {}

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
      take({c.box, c.enter_lo, c.enter_hi, std::nullopt});
    } else if (crossesThinSlab<T>(component(), prepared_[c.box])) {
      take({c.box, c.enter_lo, c.exit_hi, std::nullopt});
    } else {
      Entry entry{c.box, c.enter_lo, c.exit_hi, std::nullopt};
      if (solutionOf(entry).num_points > 0) {
        take(std::move(entry));
      }
    }
  }
  /// @param t_end a box that is certainly entered beyond it is none
  void offer(std::size_t index, double t_end) {
    const kernels::Candidate c = candidateOf<T>(component(), prepared_[index], index);
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

  /// A box that is certainly met, entered at a parameter in [enter_lo, enter_hi].
  struct Entry {
    std::size_t box = kNoBox;
    double enter_lo = kInf;
    double enter_hi = kInf;
    std::optional<Solution> solution;
  };

  void take(Entry&& entry) {
    if (!any() || entry.enter_hi < best_.enter_lo ||
        (!isBehindEnteredFace(entry) && isBefore(entry, best_))) {
      best_ = std::move(entry);
    }
  }

  /// Whether an aligned box begins at a face of the best one that is entered, so that it is entered
  /// with it or later, and has the higher index: the rule in a row of shelves.
  bool isBehindEnteredFace(const Entry& entry) {
    const auto* box = std::get_if<AlignedBox>(&boxes_[entry.box]);
    const auto* best = std::get_if<AlignedBox>(&boxes_[best_.box]);
    if (box == nullptr || best == nullptr || entry.box < best_.box) {
      return false;
    }
    const FaceSet entered = solutionOf(best_).entered;
    for (int i = 0; i < 3; ++i) {
      if ((entered.contains(i, false) && box->min[i] == best->min[i]) ||
          (entered.contains(i, true) && box->max[i] == best->max[i])) {
        return true;
      }
    }
    return false;
  }

  bool isBefore(Entry& a, Entry& b) {
    const int order =
        compareEntries(linear_, boxes_[a.box], solutionOf(a), boxes_[b.box], solutionOf(b));
    return order < 0 || (order == 0 && a.box < b.box);
  }

  Solution& solutionOf(Entry& e) {
    if (!e.solution) {
      e.solution = solveBox(linear_, component(), boxes_[e.box], prepared_[e.box]);
    }
    return *e.solution;
  }

  const T& linear_;
  const std::vector<Box>& boxes_;
  const std::vector<PreparedBox>& prepared_;
  std::optional<DoubleComponent> component_;
  Entry best_;
};

}  // namespace box_query
