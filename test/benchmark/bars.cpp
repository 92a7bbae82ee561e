// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/bars.h"

#include "benchmark/format.h"

namespace box_query::benchmark {

void printBars(const std::vector<Bar>& bars, std::ostream& out) {
  for (const Bar& bar : bars) {
    out << bar.name
        << format(": %.3g%s, bar %s %.3g%s, %s", bar.figure, bar.unit.c_str(),
                  bar.side == Bar::kAtMost ? "at most" : "at least", bar.limit, bar.unit.c_str(),
                  bar.holds() ? "holds" : "falls short")
        << "  (" << bar.beside << ")\n";
  }
}

}  // namespace box_query::benchmark
