// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/accuracy.h"
#include "benchmark/accuracy_bars.h"
#include "benchmark/report.h"

#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>

namespace {

using box_query::benchmark::Options;

constexpr const char* kUsage =
    R"(Run time against error: plain, padded, the paper's and this library's ways to intersect lines, rays and
segments with boxes, side by side in one run, their answers compared with the exact ones.

  --sample N       pairs compared with the exact answer for each table (100000); scenes take N / 20 rays
  --rounds N       turns of each method on the clock (31)
  --seed S         of all input (1)
  --csv FILE       write the table there too
  --bars           end with what the certified answers may cost, a line a bar
  --slow-pairs N   random pairs over which those are counted that plain double could not decide (20000000)
)";

/// The value of option `name` at argv[i], if that is there.
std::optional<std::string> valueOf(const char* name, int argc, char** argv, int& i) {
  if (std::strcmp(argv[i], name) != 0 || i + 1 >= argc) {
    return std::nullopt;
  }
  return argv[++i];
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  std::string csv;
  bool bars = false;
  std::uint64_t slow_pairs = 20000000;
  for (int i = 1; i < argc; ++i) {
    if (const auto sample = valueOf("--sample", argc, argv, i)) {
      options.pair_sample = std::stoul(*sample);
      options.scene_sample = options.pair_sample / 20;
    } else if (const auto rounds = valueOf("--rounds", argc, argv, i)) {
      options.rounds = std::stoi(*rounds);
    } else if (const auto seed = valueOf("--seed", argc, argv, i)) {
      options.seed = std::stoull(*seed);
    } else if (const auto file = valueOf("--csv", argc, argv, i)) {
      csv = *file;
    } else if (const auto pairs = valueOf("--slow-pairs", argc, argv, i)) {
      slow_pairs = std::stoull(*pairs);
    } else if (std::strcmp(argv[i], "--bars") == 0) {
      bars = true;
    } else {
      std::cerr << kUsage;
      return std::strcmp(argv[i], "--help") == 0 ? 0 : 2;
    }
  }
  std::vector<box_query::benchmark::Row> rows = measurePairs(options);
  for (auto& row : measureScenes(options)) {
    rows.push_back(std::move(row));
  }
  printTables(rows, std::cout);
  if (!csv.empty()) {
    std::ofstream file(csv);
    writeCsv(rows, file);
    if (!file.flush()) {
      std::cerr << "Cannot write " << csv << '\n';
      return 1;
    }
  }
  if (bars) {
    std::cout << '\n';
    printBars(measureBars(rows, options, slow_pairs), std::cout);
  }
  return 0;
}
