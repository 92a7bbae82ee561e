// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/solve.h"

#include "exact/separating_axes.h"
#include "exact/stage_counters.h"
#include "geometry/moved_into.h"
#include "geometry/planes.h"
#include "geometry/solve_by_kernel.h"

#include <array>
#include <type_traits>
#include <utility>
#include <variant>

namespace box_query {
namespace {

using exact::BasicClip;
using exact::Certified;
using exact::DoubleDouble;

/// The axes that bound the interval; kOwn where the component's own start or end does.
struct Ends {
  static constexpr int kOwn = -1;
  int enter;
  int exit;
};

/// Finds the one axis at which the component certainly enters, and the one where it leaves.
///
/// On a hit that the filter decided, a parameter t after near_hi_i and before far_lo_i has the
/// exact point strictly between the planes of axis i. So where near_lo_i exceeds all other near_hi,
/// and the start, nothing but axis i can bound the interval from below.
template <typename T>
bool identify(const SlabTimes& t, Ends& ends) {
  int first = 0;
  int last = 0;
  for (int i = 1; i < 3; ++i) {
    first = t.near_lo[i] > t.near_lo[first] ? i : first;
    last = t.far_hi[i] < t.far_hi[last] ? i : last;
  }
  const double near = t.near_lo[first];
  const double other_near = std::max(t.near_hi[(first + 1) % 3], t.near_hi[(first + 2) % 3]);
  const double far = t.far_hi[last];
  const double other_far = std::min(t.far_lo[(last + 1) % 3], t.far_lo[(last + 2) % 3]);

  const bool from_start = kHasStart<T> && std::max(t.near_hi[first], other_near) < 0.0;
  const bool to_end = kHasEnd<T> && std::min(t.far_lo[last], other_far) > 1.0;
  ends = {from_start ? Ends::kOwn : first, to_end ? Ends::kOwn : last};
  return (from_start || (near > other_near && (!kHasStart<T> || near > 0.0))) &&
         (to_end || (far < other_far && (!kHasEnd<T> || far < 1.0)));
}

/// That the sign of a direction is right where it decides faces: where it is not, |d_i| < 15u |D|
/// in the terms of bounds::kSlab, so that axis i alone leaves entry and exit open by more than the
/// other axes allow, and nothing is certain.
template <typename T>
void setFaces(const SlabTimes& times, const Ends& ends, Solution& solution) {
  solution.num_points = 2;
  solution.started_inside = kHasStart<T> && ends.enter == Ends::kOwn;
  if (ends.enter == Ends::kOwn) {
    solution.enter.t = {0.0, 1.0};
  } else {
    const bool positive = times.negative[ends.enter];
    solution.entered.insert(ends.enter, positive);
    solution.enter.axis = ends.enter;
    solution.enter.positive = positive;
  }
  if (ends.exit == Ends::kOwn) {
    solution.exit.t = {1.0, 1.0};
  } else {
    const bool positive = !times.negative[ends.exit];
    solution.left.insert(ends.exit, positive);
    solution.exit.axis = ends.exit;
    solution.exit.positive = positive;
  }
}

/// The parameter of a crossing, worked out once.
template <typename T, typename BoxType>
const CertifiedParameter& parameterOf(const T& linear, const BoxType& box, Crossing& crossing) {
  if (!crossing.t) {
    crossing.t = parameterAtFace(linear, box, crossing.axis, crossing.positive);
  }
  return *crossing.t;
}
template <typename T>
const CertifiedParameter& parameterOf(const T& linear, const Box& any, Crossing& crossing) {
  return *std::visit([&](const auto& box) { return &parameterOf(linear, box, crossing); }, any);
}

template <typename Number>
void setDecisions(const BasicClip<Number>& clip, Solution& solution) {
  solution.num_points = clip.num_points;
  solution.started_inside = clip.started_inside;
  if (clip.num_points > 0) {
    solution.entered = clip.entered;
    solution.left = clip.left;
  }
}

template <typename T, typename BoxType>
bool certifiedClip(const T& linear, const BoxType& box, BasicClip<Certified>& clip) {
  ++exact::stageCounters().certified_decisions;
  const auto component = exact::basicComponent<Certified>(linear);
  return exact::clip(exact::basicSlabs(component, box, true), kHasStart<T>, kHasEnd<T>, clip);
}

template <typename T, typename BoxType>
exact::Clip exactClip(const T& linear, const BoxType& box) {
  return exact::clip(exact::component(linear), box);
}

/// Replaces parameters from double-double rows by ones that may be known without error.
template <typename T>
void tighten(const T& linear, const Box& box, Solution& solution) {
  if (parameterOf(linear, box, solution.enter).num.error() == 0.0) {
    return;
  }
  BasicClip<Certified> clip;
  if (std::visit([&](const auto& b) { return certifiedClip(linear, b, clip); }, box)) {
    solution.enter.t = clip.enter;
    solution.exit.t = clip.exit;
  }
}

/// The exact solution of a box whose solution so far could not be rounded.
template <typename T, typename BoxType>
const exact::Clip& exactly(const T& linear, const BoxType& box, Solution& solution) {
  if (!solution.exactly) {
    ++exact::stageCounters().exact_roundings;
    solution.exactly = exactClip(linear, box);
  }
  return *solution.exactly;
}

/// Whether a component is parallel to an axis of the world.
template <typename T>
bool isAxisParallel(const T& linear) {
  const bool zero[3] = {exactDirection(linear, 0).hi == 0.0, exactDirection(linear, 1).hi == 0.0,
                        exactDirection(linear, 2).hi == 0.0};
  return zero[0] + zero[1] + zero[2] == 2;
}

template <typename T, typename BoxType>
const exact::Estimate& estimateOf(const T& linear, const BoxType& box, Crossing& crossing) {
  if (!crossing.estimate) {
    const CertifiedParameter& t = parameterOf(linear, box, crossing);
    crossing.estimate = exact::quotient(t.num, t.den);
  }
  return *crossing.estimate;
}

Crossing& crossingAt(Solution& solution, End end) {
  return end == End::kEnter ? solution.enter : solution.exit;
}

/// The distance in metres that belongs to an end.
///
/// Along an axis of the world the distance to a plane across it is num itself, which is exact for
/// an aligned box and would often be a tie that Ziv's test cannot resolve.
template <typename T, typename BoxType>
exact::Estimate estimatedRange(const T& linear, const BoxType& box, Crossing& crossing,
                               const DoubleDouble& length) {
  if (std::is_same_v<BoxType, AlignedBox> || crossing.t) {
    const CertifiedParameter& t = parameterOf(linear, box, crossing);
    const DoubleDouble den = t.den.value();
    if (t.num.error() == 0.0 && t.den.error() == 0.0 && den.hi == length.hi &&
        den.lo == length.lo && isAxisParallel(linear)) {
      return {t.num.value(), 0.0};
    }
  }
  return exact::product(estimateOf(linear, box, crossing), length);
}

const exact::Parameter& exactEnd(const exact::Clip& clip, End end) {
  return end == End::kEnter ? clip.enter : clip.exit;
}

template <typename T>
exact::Dyadic squaredLength(const T& linear) {
  const auto direction = exact::component(linear).direction;
  return exact::dot(direction, direction);
}

template <typename Number, typename T, typename BoxType>
int meetsBySeparatingAxes(const T& linear, const BoxType& box) {
  const auto component = exact::basicComponent<Number>(linear);
  return exact::meetsBySeparatingAxes(exact::basicSlabs(component, box, true), kHasStart<T>,
                                      kHasEnd<T>);
}

/// Whether the component meets the box, where the filter could not tell.
template <typename T, typename BoxType>
bool meetsSlowly(const T& linear, const DoubleComponent& component, const BoxType& box) {
  if (component.compact && isCompact(box)) {
    if constexpr (std::is_same_v<BoxType, OrientedBox>) {
      Solution solution;
      if (solveByKernel(linear, component, box, solution)) {
        ++exact::stageCounters().certified_decisions;
        return solution.num_points > 0;
      }
    }
    ++exact::stageCounters().certified_decisions;
    const int meets = meetsBySeparatingAxes<Certified>(linear, box);
    if (meets != exact::kUnknownSign) {
      return meets == 1;
    }
  }
  ++exact::stageCounters().exact_decisions;
  return meetsBySeparatingAxes<exact::Dyadic>(linear, box) == 1;
}

}  // namespace

template <typename T, typename BoxType, typename SlabsType>
bool meetsByStages(const T& linear, const BoxType& box, const Prepared<SlabsType>& prepared) {
  const DoubleComponent component = doubleComponent(linear);
  if (component.moderate && prepared.moderate) {
    const Enclosure e = enclose<T>(component, prepared.slabs);
    if (e.isHit()) {
      return true;
    }
    if (e.isMiss()) {
      return false;
    }
    if (crossesThinSlab<T>(slabTimes(component, prepared.slabs))) {
      return true;
    }
  }
  return meetsSlowly(linear, component, box);
}

template <typename T, typename BoxType>
Solution solve(const T& linear, const DoubleComponent& component, const BoxType& box) {
  Solution solution;  // the only one, made where the caller wants it
  const bool compact = component.compact && isCompact(box);
  if (component.moderate && isModerate(box)) {
    if constexpr (std::is_same_v<BoxType, OrientedBox>) {
      if (compact && solveByKernel(linear, component, box, solution)) {
        return solution;
      }
    }
    const SlabTimes times = slabTimes(component, doubleSlabs(box));
    const Enclosure e = enclose<T>(times);
    if (e.isMiss()) {
      return solution;
    }
    if (compact) {
      Ends ends;
      if (e.enter_hi < e.exit_lo && identify<T>(times, ends)) {
        setFaces<T>(times, ends, solution);
        return solution;
      }
      BasicClip<Certified> clip;
      if (certifiedClip(linear, box, clip)) {
        setDecisions(clip, solution);
        solution.enter.t = clip.enter;
        solution.exit.t = clip.exit;
        return solution;
      }
    }
  }
  ++exact::stageCounters().exact_decisions;
  solution.exactly = exactClip(linear, box);
  setDecisions(*solution.exactly, solution);
  return solution;
}

template <typename T>
int compareEntries(const T& linear, const Box& box_a, Solution& a, const Box& box_b, Solution& b) {
  if (!a.exactly && !b.exactly) {
    if (a.enter.estimate && b.enter.estimate) {
      const Certified gap = Certified(a.enter.estimate->value, a.enter.estimate->error) -
                            Certified(b.enter.estimate->value, b.enter.estimate->error);
      if (const int order = gap.sign(); order != exact::kUnknownSign && order != 0) {
        return order;
      }
    }
    for (const bool tightened : {false, true}) {
      if (tightened) {
        tighten(linear, box_a, a);
        tighten(linear, box_b, b);
      }
      const int order =
          exact::compare(parameterOf(linear, box_a, a.enter), parameterOf(linear, box_b, b.enter));
      if (order != exact::kUnknownSign) {
        return order;
      }
    }
  }
  return exact::compare(exactly(linear, box_a, a).enter, exactly(linear, box_b, b).enter);
}

template <typename T>
DoubleDouble directionLength(const T& linear) {
  const DoubleDouble d[3] = {exactDirection(linear, 0), exactDirection(linear, 1),
                             exactDirection(linear, 2)};
  for (int i = 0; i < 3; ++i) {
    if (d[(i + 1) % 3].hi == 0.0 && d[(i + 2) % 3].hi == 0.0) {
      return d[i].hi < 0.0 ? -d[i] : d[i];
    }
  }
  return sqrt(dot(d, d));
}

template <typename T, typename BoxType>
double roundedParameter(const T& linear, const BoxType& box, Solution& solution, End end) {
  double rounded = 0.0;
  if (!solution.exactly &&
      exact::round(estimateOf(linear, box, crossingAt(solution, end)), rounded)) {
    return rounded;
  }
  return exact::rounded(exactEnd(exactly(linear, box, solution), end));
}

template <typename T, typename BoxType>
double roundedRange(const T& linear, const BoxType& box, Solution& solution, End end,
                    const DoubleDouble& length) {
  double rounded = 0.0;
  if (!solution.exactly &&
      exact::round(estimatedRange(linear, box, crossingAt(solution, end), length), rounded)) {
    return rounded;
  }
  return exact::roundedRange(exactEnd(exactly(linear, box, solution), end), squaredLength(linear));
}

template <typename T, typename BoxType>
bool isEnteredWithin(const T& linear, const BoxType& box, Solution& solution, double max_range,
                     const DoubleDouble& length) {
  if (std::isinf(max_range)) {
    return true;
  }
  if (!solution.exactly) {
    const exact::Estimate range = estimatedRange(linear, box, solution.enter, length);
    const Certified excess = Certified(range.value, range.error) - Certified(max_range);
    if (excess.sign() != exact::kUnknownSign) {
      return excess.sign() <= 0;
    }
  }
  return exact::isWithin(exactly(linear, box, solution).enter, squaredLength(linear), max_range);
}

template <typename T, typename BoxType>
Vector3 pointAt(const T& linear, const DoubleComponent& component, const BoxType& box,
                Solution& solution, End end, double t) {
  if (!component.moderate || !isModerate(box)) {
    return exact::roundedPoint(exact::component(linear),
                               exactEnd(exactly(linear, box, solution), end));
  }
  const FaceSet faces = end == End::kEnter ? solution.entered : solution.left;
  if constexpr (kHasStart<T>) {
    if (t == 0.0 && solution.started_inside) {
      return startOf(linear);
    }
  }
  if constexpr (kHasEnd<T>) {
    if (t == 1.0) {  // perhaps only rounded to 1
      return faces.empty() ? linear.end : movedInto(box, linear.end, faces);
    }
  }
  const Vector3 direction(component.direction[0], component.direction[1], component.direction[2]);
  return movedInto(box, startOf(linear) + t * direction, faces);
}

#define BOX_QUERY_INSTANTIATE(T, BoxType, SlabsType)                                               \
  template bool meetsByStages(const T&, const BoxType&, const Prepared<SlabsType>&);               \
  template Solution solve(const T&, const DoubleComponent&, const BoxType&);                       \
  template double roundedParameter(const T&, const BoxType&, Solution&, End);                      \
  template double roundedRange(const T&, const BoxType&, Solution&, End, const DoubleDouble&);     \
  template bool isEnteredWithin(const T&, const BoxType&, Solution&, double, const DoubleDouble&); \
  template Vector3 pointAt(const T&, const DoubleComponent&, const BoxType&, Solution&, End,       \
                           double);
#define BOX_QUERY_INSTANTIATE_COMPONENT(T)                                             \
  BOX_QUERY_INSTANTIATE(T, AlignedBox, AlignedSlabs)                                   \
  BOX_QUERY_INSTANTIATE(T, OrientedBox, OrientedSlabs)                                 \
  template int compareEntries(const T&, const Box&, Solution&, const Box&, Solution&); \
  template DoubleDouble directionLength(const T&);

BOX_QUERY_INSTANTIATE_COMPONENT(Line)
BOX_QUERY_INSTANTIATE_COMPONENT(Ray)
BOX_QUERY_INSTANTIATE_COMPONENT(Segment)

}  // namespace box_query
