// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed_report.h"

#include "benchmark/format.h"

namespace box_query::benchmark {
namespace {

/// Of a count over all answers that were compared.
double each(std::uint64_t count, const SpeedRow& row) {
  return row.asked > 0 ? static_cast<double>(count) / static_cast<double>(row.asked) : 0.0;
}

/// Decisions that double left open.
std::uint64_t open(const QueryCounters& work) {
  return work.certified_decisions + work.exact_decisions;
}

}  // namespace

void printHeader(std::ostream& out) {
  out << format("%-11s %7s  %-29s %-7s %-27s %9s  %19s  %6s  %7s  %s\n", "workload", "boxes",
                "question", "mode", "method", "ns", "quartiles", "ratio", "hits",
                "wrong, and what an answer took");
}

void print(const SpeedRow& row, std::ostream& out) {
  const Timing& timing = row.timing;
  out << format("%-11s %7zu  %-29s %-7s %-27s %9.1f  %9.1f %9.1f  %6.2f", row.workload.c_str(),
                row.boxes, nameOf(row.question), nameOf(row.mode), row.method.c_str(),
                timing.ns.median, timing.ns.low, timing.ns.high, timing.ratio.median);
  if (row.asked > 0) {
    out << format("  %5.1f %%  %zu of %zu",
                  100.0 * static_cast<double>(row.hits) / static_cast<double>(row.asked), row.wrong,
                  row.asked);
  }
  if (row.work.nodes > 0) {
    out << format("; %.1f nodes, %.2f boxes, %.2g left open", each(row.work.nodes, row),
                  each(row.work.boxes, row), each(open(row.work), row));
  }
  out << '\n';
}

void writeCsv(const std::vector<SpeedRow>& rows, std::ostream& out) {
  out << "workload,boxes,question,mode,method,ns,ns_low,ns_high,ratio,ratio_low,ratio_high,asked,"
         "hits,wrong,nodes,boxes_in_double,turned_boxes,left_open,exact,rounded_exactly\n";
  for (const SpeedRow& row : rows) {
    const Timing& timing = row.timing;
    out << format(R"(%s,%zu,"%s",%s,"%s",%.1f,%.1f,%.1f,%.3f,%.3f,%.3f,%zu,%zu,%zu,)",
                  row.workload.c_str(), row.boxes, nameOf(row.question), nameOf(row.mode),
                  row.method.c_str(), timing.ns.median, timing.ns.low, timing.ns.high,
                  timing.ratio.median, timing.ratio.low, timing.ratio.high, row.asked, row.hits,
                  row.wrong);
    out << format("%.2f,%.3f,%.3f,%.3g,%.3g,%.3g\n", each(row.work.nodes, row),
                  each(row.work.boxes, row), each(row.work.turned_boxes, row),
                  each(open(row.work), row), each(row.work.exact_decisions, row),
                  each(row.work.exact_roundings, row));
  }
}

}  // namespace box_query::benchmark
