// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/node_report.h"

#include "benchmark/format.h"

#include <algorithm>
#include <functional>

namespace box_query::benchmark {
namespace {

std::string wrongOf(std::size_t wrong, std::size_t asked) {
  return format("%zu of %zu", wrong, asked);
}

std::string threadsOf(const CallRow& row) {
  return row.threads == 0 ? "all" : std::to_string(row.threads);
}

double medianRatio(const BoxesRow& row) {
  return row.node.median / row.plain.median;
}
double mostRatio(const BoxesRow& row) {
  return row.node.most / row.plain.most;
}
double worstRatio(const BoxesRow& row) {
  return row.node.worst / row.plain.worst;
}

/// A measured ratio and where it was measured.
struct Cell {
  std::string name;
  double figure;
};

void addBar(const char* name, double limit, std::vector<Cell> cells, std::vector<Bar>& bars) {
  if (cells.empty()) {
    return;
  }
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return a.figure > b.figure; });
  constexpr std::size_t kShown = 6;
  std::string beside;
  for (std::size_t i = 0; i < std::min(kShown, cells.size()); ++i) {
    beside += format("%s%s: %.2f", i == 0 ? "" : ", ", cells[i].name.c_str(), cells[i].figure);
  }
  if (cells.size() > kShown) {
    beside += format(", %zu more down to %.2f", cells.size() - kShown, cells.back().figure);
  }
  bars.push_back({name, cells.front().figure, Bar::kAtMost, limit, "", beside});
}

/// Beside a library that takes so many times as long as the transport, the node may not be seen.
bool isLibraryLong(const CallRow& row) {
  return row.library.median >= 5.0 * row.empty.median;
}

std::vector<Cell> callCells(const std::vector<CallRow>& rows,
                            const std::function<bool(const CallRow&)>& belongs) {
  std::vector<Cell> cells;
  for (const CallRow& row : rows) {
    if (belongs(row)) {
      cells.push_back({format("%s %s, %zu boxes, %s", row.service.c_str(), row.asks.c_str(),
                              row.boxes, row.threads == 1 ? "1 thread" : "all threads"),
                       row.ratio.median});
    }
  }
  return cells;
}

std::vector<Cell> boxesCells(const std::vector<BoxesRow>& rows,
                             const std::function<double(const BoxesRow&)>& figure) {
  std::vector<Cell> cells;
  for (const BoxesRow& row : rows) {
    cells.push_back({format("%zu at %.0f Hz", row.boxes, row.rate), figure(row)});
  }
  return cells;
}

}  // namespace

void printCallHeader(std::ostream& out) {
  out << format("%-14s %-11s %6s %7s %7s %9s %9s %9s %9s %6s %-15s %s\n", "service", "asks",
                "boxes", "queries", "threads", "bytes", "node us", "empty us", "library", "ratio",
                "(quartiles)", "wrong");
}

void print(const CallRow& row, std::ostream& out) {
  out << format("%-14s %-11s %6zu %7zu %7s %9zu %9.1f %9.1f %9.1f %6.2f (%.2f to %.2f)  ",
                row.service.c_str(), row.asks.c_str(), row.boxes, row.queries,
                threadsOf(row).c_str(), row.bytes, row.node.median, row.empty.median,
                row.library.median, row.ratio.median, row.ratio.low, row.ratio.high)
      << wrongOf(row.wrong, row.asked) << std::endl;
}

void printBoxesHeader(std::ostream& out) {
  out << format("%6s %4s %9s %9s %9s %9s %9s %9s %6s %6s %6s %9s %9s %5s  %s\n", "boxes", "Hz",
                "node us", "95 %", "worst", "plain us", "95 %", "worst", "ratio", "95 %", "worst",
                "decode us", "build us", "late", "wrong");
}

void print(const BoxesRow& row, std::ostream& out) {
  out << format(
             "%6zu %4.0f %9.1f %9.1f %9.1f %9.1f %9.1f %9.1f %6.2f %6.2f %6.2f %9.1f %9.1f %5zu  ",
             row.boxes, row.rate, row.node.median, row.node.most, row.node.worst, row.plain.median,
             row.plain.most, row.plain.worst, medianRatio(row), mostRatio(row), worstRatio(row),
             row.decode, row.build, row.late)
      << wrongOf(row.wrong, row.asked) << std::endl;
}

void writeCsv(const std::vector<CallRow>& calls, const std::vector<BoxesRow>& boxes,
              std::ostream& out) {
  out << "what,asks,boxes,queries,threads,hz,node_us,node_95_us,node_worst_us,beside_us,"
         "beside_95_us,beside_worst_us,library_us,decode_us,build_us,ratio,ratio_low,ratio_high,"
         "asked,wrong\n";
  for (const CallRow& row : calls) {
    out << row.service << ',' << row.asks
        << format(",%zu,%zu,%s,,%.1f,,,%.1f,,,%.1f,,,%.4f,%.4f,%.4f,%zu,%zu\n", row.boxes,
                  row.queries, threadsOf(row).c_str(), row.node.median, row.empty.median,
                  row.library.median, row.ratio.median, row.ratio.low, row.ratio.high, row.asked,
                  row.wrong);
  }
  for (const BoxesRow& row : boxes) {
    out << format("boxes,,%zu,,,%g,%.1f,%.1f,%.1f,%.1f,%.1f,%.1f,,%.1f,%.1f,%.4f,,,%zu,%zu\n",
                  row.boxes, row.rate, row.node.median, row.node.most, row.node.worst,
                  row.plain.median, row.plain.most, row.plain.worst, row.decode, row.build,
                  medianRatio(row), row.asked, row.wrong);
  }
}

std::vector<Bar> nodeBars(const std::vector<CallRow>& calls, const std::vector<BoxesRow>& boxes) {
  std::vector<Bar> bars;
  addBar("100 queries, over an empty service and the library", 1.15,
         callCells(calls, [](const CallRow& row) { return row.queries == 100; }), bars);
  addBar("10,000 queries that are most of the time, over the same", 1.15,
         callCells(calls,
                   [](const CallRow& row) { return row.queries == 10000 && isLibraryLong(row); }),
         bars);
  addBar("10,000 queries that are not, over the same", 1.3,
         callCells(calls,
                   [](const CallRow& row) { return row.queries == 10000 && !isLibraryLong(row); }),
         bars);
  addBar("boxes to an answer, over roscpp's decoding and a new scene, median", 1.5,
         boxesCells(boxes, medianRatio), bars);
  addBar("the same, what 95 of 100 do not exceed", 1.5, boxesCells(boxes, mostRatio), bars);
  addBar("the same, the worst of each", 1.5, boxesCells(boxes, worstRatio), bars);
  return bars;
}

}  // namespace box_query::benchmark
