// SPDX-License-Identifier: BSD-3-Clause
#include "exact/stage_counters.h"

namespace box_query::exact {

StageCounters& stageCounters() {
  // Touched by slow stages only: no model of its own.
  thread_local StageCounters counters;
  return counters;
}

}  // namespace box_query::exact
