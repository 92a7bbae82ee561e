// SPDX-License-Identifier: BSD-3-Clause
#include "scene/counters.h"

#include "exact/stage_counters.h"

#include <box_query/counters.h>

namespace box_query {

__thread kernels::Work work_of_thread;

QueryCounters queryCounters() noexcept {
  const exact::StageCounters& stages = exact::stageCounters();
  return {work_of_thread.nodes,       work_of_thread.boxes,   work_of_thread.turned_boxes,
          stages.certified_decisions, stages.exact_decisions, stages.exact_roundings};
}

QueryCounters& operator+=(QueryCounters& a, const QueryCounters& b) noexcept {
  a.nodes += b.nodes;
  a.boxes += b.boxes;
  a.turned_boxes += b.turned_boxes;
  a.certified_decisions += b.certified_decisions;
  a.exact_decisions += b.exact_decisions;
  a.exact_roundings += b.exact_roundings;
  return a;
}

QueryCounters operator-(const QueryCounters& a, const QueryCounters& b) noexcept {
  return {a.nodes - b.nodes,
          a.boxes - b.boxes,
          a.turned_boxes - b.turned_boxes,
          a.certified_decisions - b.certified_decisions,
          a.exact_decisions - b.exact_decisions,
          a.exact_roundings - b.exact_roundings};
}

}  // namespace box_query
