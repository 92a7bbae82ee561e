// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/report.h"

#include "benchmark/format.h"

#include <cmath>

namespace box_query::benchmark {
namespace {

double perMillion(std::size_t count, const Errors& errors) {
  return 1e6 * static_cast<double>(count) / static_cast<double>(errors.asked);
}

double hitShare(const Errors& errors) {
  return static_cast<double>(errors.hits) / static_cast<double>(errors.asked);
}

/// Few digits: 0, 0.31, 2.5, 140, 3.2e+07; nothing where there is no t.
std::string ulps(double x) {
  return std::isnan(x) ? "-" : format(x < 10.0 ? "%.2g" : x < 1e4 ? "%.0f" : "%.1e", x);
}

std::string title(const Row& row) {
  const std::string what =
      row.table == "any" || row.table == "closest"
          ? "ray against 64 boxes, " + row.table
          : row.table + " against one box, " +
                (row.prepared == "box" ? "prepared before the clock runs" : "nothing prepared");
  return what + ", " + row.input +
         format(" (hits %.1f %% of %zu)", 100.0 * hitShare(row.errors), row.errors.asked);
}

}  // namespace

void printTables(const std::vector<Row>& rows, std::ostream& out) {
  const Row* last = nullptr;
  for (const Row& row : rows) {
    if (last == nullptr || last->table != row.table || last->input != row.input ||
        last->prepared != row.prepared) {
      out << '\n'
          << title(row) << '\n'
          << format("  %-36s %9s %17s %7s   %-19s %-23s %s\n", "method", "ns", "quartiles", "ratio",
                    "wrong per million", "ulps: median 99% worst", "sum of answers");
    }
    last = &row;
    const Errors& errors = row.errors;
    const std::string wrong =
        errors.wrong_boxes == 0
            ? format("%.0f", perMillion(errors.wrong(), errors))
            : format("%.0f, box %.0f", perMillion(errors.wrong() - errors.wrong_boxes, errors),
                     perMillion(errors.wrong_boxes, errors));
    out << format("  %-36s %9.2f %8.2f %8.2f %7.2f   %-19s %7s %7s %7s   %016llx\n",
                  row.method.c_str(), row.timing.ns.median, row.timing.ns.low, row.timing.ns.high,
                  row.timing.ratio.median, wrong.c_str(), ulps(quantile(errors.ulps, 0.5)).c_str(),
                  ulps(quantile(errors.ulps, 0.99)).c_str(),
                  ulps(quantile(errors.ulps, 1.0)).c_str(),
                  static_cast<unsigned long long>(row.timing.sum));
  }
}

void writeCsv(const std::vector<Row>& rows, std::ostream& out) {
  out << "table,input,prepared,method,ns,ns_low,ns_high,ratio,ratio_low,ratio_high,hit_share,asked,"
         "wrong_per_million,false_hits_per_million,false_misses_per_million,wrong_boxes_per_"
         "million,"
         "ulps_median,ulps_99,ulps_worst,sum_of_answers\n";
  for (const Row& row : rows) {
    const Errors& errors = row.errors;
    const Timing& timing = row.timing;
    out << row.table << ',' << row.input << ',' << row.prepared << ",\"" << row.method << "\","
        << format("%.3f,%.3f,%.3f,%.4f,%.4f,%.4f,%.4f,%zu,", timing.ns.median, timing.ns.low,
                  timing.ns.high, timing.ratio.median, timing.ratio.low, timing.ratio.high,
                  hitShare(errors), errors.asked)
        << format("%.1f,%.1f,%.1f,%.1f,", perMillion(errors.wrong(), errors),
                  perMillion(errors.false_hits, errors), perMillion(errors.false_misses, errors),
                  perMillion(errors.wrong_boxes, errors))
        << format("%.4g,%.4g,%.4g,%016llx\n", quantile(errors.ulps, 0.5),
                  quantile(errors.ulps, 0.99), quantile(errors.ulps, 1.0),
                  static_cast<unsigned long long>(timing.sum));
  }
}

}  // namespace box_query::benchmark
