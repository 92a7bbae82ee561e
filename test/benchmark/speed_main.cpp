// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/format.h"
#include "benchmark/speed.h"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <regex>

namespace {

using namespace box_query::benchmark;

constexpr const char* kUsage =
    R"(How fast scenes answer, beside what a user would pick instead: the same questions in turns in one run, one ray a
call, with the number of wrong answers beside every time.

  --quick        fewer sizes and turns
  --most N       boxes of the largest scene (100000)
  --only REGEX   only workloads whose "kind N" matches
  --rounds N     turns of each method on the clock (15)
  --csv FILE     write the table there too
The recorded scenes are those of the directory that BOX_QUERY_SHARED names.
)";

void print(const SpeedRow& row) {
  std::cout << format("%-9s %7zu  %-29s %-18s %9.1f  %9.1f %9.1f  %6.2f  %5.1f %% %6zu of %zu\n",
                      row.workload.c_str(), row.boxes, nameOf(row.question), row.method.c_str(),
                      row.timing.ns.median, row.timing.ns.low, row.timing.ns.high,
                      row.timing.ratio.median,
                      100.0 * static_cast<double>(row.hits) /
                          static_cast<double>(std::max<std::size_t>(1, row.asked)),
                      row.wrong, row.asked);
}

void write(const std::vector<SpeedRow>& rows, std::ostream& out) {
  out << "workload,boxes,question,method,ns,ns_low,ns_high,ratio,ratio_low,ratio_high,asked,hits,"
         "wrong\n";
  for (const SpeedRow& row : rows) {
    out << format("%s,%zu,\"%s\",\"%s\",%.1f,%.1f,%.1f,%.3f,%.3f,%.3f,%zu,%zu,%zu\n",
                  row.workload.c_str(), row.boxes, nameOf(row.question), row.method.c_str(),
                  row.timing.ns.median, row.timing.ns.low, row.timing.ns.high,
                  row.timing.ratio.median, row.timing.ratio.low, row.timing.ratio.high, row.asked,
                  row.hits, row.wrong);
  }
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  std::size_t most = 100000;
  int rounds = 15;
  std::string only = ".*";
  std::string csv;
  for (int i = 1; i < argc; ++i) {
    const auto is = [&](const char* name) {
      return std::strcmp(argv[i], name) == 0 && i + 1 < argc;
    };
    if (std::strcmp(argv[i], "--quick") == 0) {
      quick = true;
    } else if (is("--most")) {
      most = std::strtoull(argv[++i], nullptr, 10);
    } else if (is("--only")) {
      only = argv[++i];
    } else if (is("--rounds")) {
      rounds = std::atoi(argv[++i]);
    } else if (is("--csv")) {
      csv = argv[++i];
    } else {
      std::cerr << kUsage;
      return std::strcmp(argv[i], "--help") == 0 ? 0 : 2;
    }
  }
  std::vector<Workload> workloads;
  const std::regex wanted(only);
  const auto isWanted = [&](const std::string& kind, std::size_t boxes) {
    return std::regex_search(kind + " " + std::to_string(boxes), wanted);
  };
  std::cout << "Kernels: " << box_query::activeKernels() << '\n';
  for (const std::string& note : peerNotes()) {
    std::cout << note << '\n';
  }
  std::cout << "\nworkload    boxes  question                      method                    ns  "
               "       quartiles   ratio     hits  wrong\n";
  std::vector<SpeedRow> rows;
  const SpeedOptions options{quick ? 5 : rounds, quick ? 200U : 500U};
  const auto measure = [&](const Workload& workload) {
    for (const SpeedRow& row : measureSpeed(workload, options)) {
      print(row);
      rows.push_back(row);
    }
    std::cout.flush();
  };
  for (const std::string& kind : workloadKinds()) {
    for (const std::size_t boxes :
         {8U, 16U, 32U, 64U, 128U, 256U, 1000U, 10000U, 100000U, 1000000U}) {
      const bool sampled = boxes == 16 || boxes == 64 || boxes == 1000 || boxes == 10000;
      if (boxes <= most && (!quick || sampled) && isWanted(kind, boxes)) {
        measure(makeWorkload(kind, boxes, 2048, 7));
      }
    }
  }
  const char* shared = std::getenv("BOX_QUERY_SHARED");
  if (shared == nullptr) {
    std::cout << "recorded: not measured, since BOX_QUERY_SHARED is not set\n";
  } else if (isWanted("recorded", 0)) {
    measure(recordedScenes(shared, quick ? 100 : 40, 64));
  }
  if (!csv.empty()) {
    std::ofstream file(csv);
    write(rows, file);
    if (!file.flush()) {
      std::cerr << "Cannot write " << csv << '\n';
      return 1;
    }
  }
  return 0;
}
