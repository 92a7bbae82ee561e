// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The library's own ways to an answer, and its slow stages on their own.
#pragma once

#include "benchmark/library_box.h"
#include "exact/clip.h"
#include "exact/estimate.h"
#include "geometry/solve.h"

#include <box_query/intersection.h>

namespace box_query::benchmark {

struct LibraryTest {
  static constexpr const char* kName = "box_query, yes or no";
  static constexpr bool kGivesT = false;
  static constexpr bool kLooksAtT = false;
  using Prepared = LibraryBox;
  static Prepared prepare(const OrientedBox& box) { return LibraryBox(box); }
  template <typename Component>
  static Answer ask(const Component& component, const Prepared& box) {
    return {meets(component, box.box(), box.filter)};
  }
};

/// Rounds the parameter of entry.
struct LibraryRounded {
  static constexpr const char* kName = "box_query, rounded t";
  static constexpr bool kGivesT = true;
  static constexpr bool kLooksAtT = true;
  using Prepared = LibraryBox;
  static Prepared prepare(const OrientedBox& box) { return LibraryBox(box); }
  template <typename Component>
  static Answer ask(const Component& component, const Prepared& box) {
    Solution solution = solve(component, doubleComponent(component), box.box());
    if (solution.num_points == 0) {
      return {};
    }
    return {true, roundedParameter(component, box.box(), solution, End::kEnter)};
  }
};

/// Certain of the yes or no, content with the enclosure of t that the filter has.
struct LibraryEnclosed {
  static constexpr const char* kName = "box_query, enclosed t";
  static constexpr bool kGivesT = true;
  static constexpr bool kLooksAtT = true;
  using Prepared = LibraryBox;
  static Prepared prepare(const OrientedBox& box) { return LibraryBox(box); }
  template <typename Component>
  static Answer ask(const Component& component, const Prepared& box) {
    return ask(component, box.box(), box.filter);
  }
  template <typename Component>
  static Answer ask(const Component& component, const OrientedBox& box,
                    const box_query::Prepared<OrientedSlabs>& filter) {
    const DoubleComponent doubles = doubleComponent(component);
    if (!doubles.moderate || !filter.moderate) {
      Solution solution = solve(component, doubles, box);
      const bool hit = solution.num_points > 0;
      const double t = hit ? roundedParameter(component, box, solution, End::kEnter) : 0.0;
      return {hit, t, t};
    }
    const Enclosure e = enclose<Component>(doubles, filter.slabs);
    const bool hit = !e.isMiss() && (e.isHit() || meetsByStages(component, box, filter));
    return {hit, e.enter_lo, e.enter_hi};
  }
};

/// The exact stage alone.
struct ExactAlways {
  static constexpr const char* kName = "exact always";
  static constexpr bool kGivesT = true;
  static constexpr bool kLooksAtT = true;
  using Prepared = OrientedBox;
  static const OrientedBox& prepare(const OrientedBox& box) { return box; }
  template <typename Component>
  static Answer ask(const Component& component, const OrientedBox& box) {
    const exact::Clip clip = exact::clip(exact::component(component), box);
    if (clip.num_points == 0) {
      return {};
    }
    return {true, exact::rounded(clip.enter)};
  }
};

/// The double-double stage without the filter before it; the exact one where that cannot tell.
struct DoubleDoubleAlways {
  static constexpr const char* kName = "double-double always";
  static constexpr bool kGivesT = true;
  static constexpr bool kLooksAtT = true;
  using Prepared = OrientedBox;
  static const OrientedBox& prepare(const OrientedBox& box) { return box; }
  template <typename Component>
  static Answer ask(const Component& component, const OrientedBox& box) {
    using exact::Certified;
    if (doubleComponent(component).compact && isCompact(box)) {
      exact::BasicClip<Certified> clip;
      const auto certified = exact::basicComponent<Certified>(component);
      if (exact::clip(exact::basicSlabs(certified, box), kHasStart<Component>, kHasEnd<Component>,
                      clip)) {
        if (clip.num_points == 0) {
          return {};
        }
        double t = 0.0;
        if (exact::round(exact::quotient(clip.enter.num, clip.enter.den), t)) {
          return {true, t};
        }
      }
    }
    return ExactAlways::ask(component, box);
  }
};

/// A lone box is asked through the public functions.
template <>
struct Lone<LibraryTest> {
  static constexpr const char* kName = LibraryTest::kName;
  static constexpr bool kGivesT = false;
  static constexpr bool kLooksAtT = false;
  using Prepared = OrientedBox;
  static const OrientedBox& prepare(const OrientedBox& box) { return box; }
  template <typename Component>
  static Answer ask(const Component& component, const OrientedBox& box) {
    return {testIntersection(component, box)};
  }
};

/// With the other end, faces and points, since findIntersection gives them all.
template <>
struct Lone<LibraryRounded> {
  static constexpr const char* kName = LibraryRounded::kName;
  static constexpr bool kGivesT = true;
  static constexpr bool kLooksAtT = true;
  using Prepared = OrientedBox;
  static const OrientedBox& prepare(const OrientedBox& box) { return box; }
  template <typename Component>
  static Answer ask(const Component& component, const OrientedBox& box) {
    const Intersection found = findIntersection(component, box);
    return {found.num_points > 0, found.t_enter};
  }
};

/// Nothing but the filter's own preparation.
template <>
struct Lone<LibraryEnclosed> {
  static constexpr const char* kName = LibraryEnclosed::kName;
  static constexpr bool kGivesT = true;
  static constexpr bool kLooksAtT = true;
  using Prepared = OrientedBox;
  static const OrientedBox& prepare(const OrientedBox& box) { return box; }
  template <typename Component>
  static Answer ask(const Component& component, const OrientedBox& box) {
    return LibraryEnclosed::ask(component, box, prepared(box));
  }
};

}  // namespace box_query::benchmark
