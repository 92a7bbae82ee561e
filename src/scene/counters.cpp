// SPDX-License-Identifier: BSD-3-Clause
#include "scene/counters.h"

#include "exact/stage_counters.h"

#include <box_query/counters.h>

namespace box_query {
namespace {

// Of the model for libraries that are loaded with the program, one load away: a call of the dynamic
// linker would cost a tenth of a short query. So few bytes are there for libraries that come later
// too, as with nodelets.
__attribute__((tls_model("initial-exec"))) thread_local kernels::Work work_of_thread;

}  // namespace

void countWork(const kernels::Work& work) noexcept {
  work_of_thread.nodes += work.nodes;
  work_of_thread.boxes += work.boxes;
  work_of_thread.turned_boxes += work.turned_boxes;
}

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
