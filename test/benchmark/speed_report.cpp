// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed_report.h"

#include "benchmark/format.h"

namespace box_query::benchmark {

void printHeader(std::ostream& out) {
  out << format("%-11s %7s  %-29s %-7s %-27s %9s  %19s  %6s  %7s  %s\n", "workload", "boxes",
                "question", "mode", "method", "ns", "quartiles", "ratio", "hits", "wrong");
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
  out << '\n';
}

void writeCsv(const std::vector<SpeedRow>& rows, std::ostream& out) {
  out << "workload,boxes,question,mode,method,ns,ns_low,ns_high,ratio,ratio_low,ratio_high,asked,"
         "hits,"
         "wrong\n";
  for (const SpeedRow& row : rows) {
    const Timing& timing = row.timing;
    out << format("%s,%zu,\"%s\",%s,\"%s\",%.1f,%.1f,%.1f,%.3f,%.3f,%.3f,%zu,%zu,%zu\n",
                  row.workload.c_str(), row.boxes, nameOf(row.question), nameOf(row.mode),
                  row.method.c_str(), timing.ns.median, timing.ns.low, timing.ns.high,
                  timing.ratio.median, timing.ratio.low, timing.ratio.high, row.asked, row.hits,
                  row.wrong);
  }
}

}  // namespace box_query::benchmark
