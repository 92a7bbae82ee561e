// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/speed.h"
#include "benchmark/speed_bars.h"
#include "benchmark/speed_report.h"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <regex>

namespace {

using namespace box_query::benchmark;

constexpr const char* kUsage =
    R"(How fast scenes answer, beside what a user would pick instead: the same questions in turns in one run, one ray a
call and many, with the number of wrong answers beside every time.

  --quick        fewer sizes and turns: some minutes
  --most N       boxes of the largest scene (1000000)
  --only REGEX   only workloads whose "kind N" matches
  --rounds N     turns of each method on the clock (15; 7 if quick)
  --csv FILE     write the table there too
  --bars         end with how much faster than others the library is to be, a line a bar
The recorded scenes are those of the directory that BOX_QUERY_SHARED names.
)";

struct Arguments {
  bool quick = false;
  bool bars = false;
  std::size_t most = 1000000;
  int rounds = 0;
  std::regex only{".*"};
  std::string csv;
};

/// @return false after an argument that it does not know
bool parse(int argc, char** argv, Arguments& arguments) {
  for (int i = 1; i < argc; ++i) {
    const auto is = [&](const char* name) { return std::strcmp(argv[i], name) == 0; };
    const auto has = [&](const char* name) { return is(name) && i + 1 < argc; };
    if (is("--quick")) {
      arguments.quick = true;
    } else if (is("--bars")) {
      arguments.bars = true;
    } else if (has("--most")) {
      arguments.most = std::strtoull(argv[++i], nullptr, 10);
    } else if (has("--only")) {
      arguments.only = std::regex(argv[++i]);
    } else if (has("--rounds")) {
      arguments.rounds = std::atoi(argv[++i]);
    } else if (has("--csv")) {
      arguments.csv = argv[++i];
    } else {
      return false;
    }
  }
  return true;
}

/// Sizes of the scenes of a kind.
std::vector<std::size_t> sizesOf(const std::string& kind, bool quick) {
  if (quick) {
    return kind == "sparse"  ? std::vector<std::size_t>{8, 16, 32, 64, 128, 1000, 10000, 100000}
           : kind == "dense" ? std::vector<std::size_t>{8, 32, 128, 1000, 10000}
                             : std::vector<std::size_t>{1000, 10000};
  }
  std::vector<std::size_t> sizes = {8, 16, 32, 64, 128, 256, 1000, 10000, 100000};
  if (kind != "needles" && kind != "shelves") {
    sizes.push_back(1000000);
  }
  return sizes;
}

/// Measures what is asked for, and prints as it goes.
class Run {
 public:
  explicit Run(const Arguments& arguments) : arguments_(arguments) {
    options_.rounds = arguments.rounds > 0 ? arguments.rounds : arguments.quick ? 7 : 15;
    options_.sample = arguments.quick ? 200 : 500;
  }

  void measureAll() {
    for (const bool apart : {false, true}) {
      if (isWanted(apart ? "pairs apart" : "pairs", 16)) {
        measure(pairWorkload(apart, 2048, 7), pairMethods());
      }
    }
    for (const std::string& kind : workloadKinds()) {
      for (const std::size_t boxes : sizesOf(kind, arguments_.quick)) {
        if (isWanted(kind, boxes)) {
          measure(makeWorkload(kind, boxes, 8192, 7), speedMethods());
        }
      }
    }
    const char* shared = std::getenv("BOX_QUERY_SHARED");
    if (shared == nullptr) {
      std::cout << "recorded: not measured, since BOX_QUERY_SHARED is not set\n";
      return;
    }
    if (isWanted("recorded", 0)) {
      measure(recordedScenes(shared, arguments_.quick ? 100 : 40, 64), speedMethods());
    }
    if (isWanted("merged", 130)) {
      measure(mergedScenes(shared, arguments_.quick ? 20 : 4, 64), speedMethods());
    }
  }

  const std::vector<SpeedRow>& rows() const { return rows_; }

 private:
  bool isWanted(const std::string& kind, std::size_t boxes) const {
    return boxes <= arguments_.most &&
           std::regex_search(kind + " " + std::to_string(boxes), arguments_.only);
  }
  void measure(const Workload& workload, const std::vector<SpeedMethodKind>& methods) {
    options_.threads = haveTwoCores();
    if (!options_.threads) {
      std::cout << "Two threads are not measured here, since other programs keep the cores busy.\n";
    }
    for (const SpeedRow& row : measureSpeed(workload, options_, methods)) {
      print(row, std::cout);
      rows_.push_back(row);
    }
    std::cout.flush();
  }

  const Arguments& arguments_;
  SpeedOptions options_;
  std::vector<SpeedRow> rows_;
};

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  if (!parse(argc, argv, arguments)) {
    std::cerr << kUsage;
    return std::strcmp(argv[argc - 1], "--help") == 0 ? 0 : 2;
  }
  std::cout << "Kernels: " << box_query::activeKernels() << '\n';
  for (const std::string& note : peerNotes()) {
    std::cout << note << '\n';
  }
  std::cout << '\n';
  printHeader(std::cout);
  Run run(arguments);
  run.measureAll();
  if (!arguments.csv.empty()) {
    std::ofstream file(arguments.csv);
    writeCsv(run.rows(), file);
    if (!file.flush()) {
      std::cerr << "Cannot write " << arguments.csv << '\n';
      return 1;
    }
  }
  if (arguments.bars) {
    std::cout << '\n';
    printBars(speedBars(run.rows()), std::cout);
  }
  return 0;
}
