// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Random and hostile queries against the exact oracle. Prints a table by family; returns 1 if any
/// answer is wrong, and shows the first wrong ones so that they can be repeated.
#include "stress/families.h"
#include "stress/run_families.h"
#include "stress/scene_families.h"

#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

namespace box_query::stress {
namespace {

const char kHelp[] =
    "stress [--per-family N] [--scenes N] [--seed S] [--family NAME] [--threads N]\n"
    "  --per-family N  samples of every family of pairs: a box with a line, a ray and a segment, "
    "of\n"
    "                  which all intersection and distance queries are checked (100000)\n"
    "  --scenes N      scenes of many boxes, over all families of scenes (10000)\n"
    "  --seed S        another seed, other samples (1)\n"
    "  --family NAME   only this family, or all whose names begin so\n"
    "  --threads N     threads (all of the machine's)\n"
    "The last columns but one say how often, per query, the stages in double-double and in exact\n"
    "integers had to decide or to round. A query of a pair is three calls, or more; of a scene "
    "one\n"
    "for every box.\n";

struct Options {
  std::uint64_t per_family = 100000;
  std::uint64_t scenes = 10000;
  std::uint64_t seed = 1;
  std::string family;
  int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
};

[[noreturn]] void exitWithHelp(int status) {
  std::fputs(kHelp, status == 0 ? stdout : stderr);
  std::exit(status);
}

std::uint64_t parseCount(const char* text) {
  char* end = nullptr;
  const std::uint64_t count = std::strtoull(text, &end, 10);
  if (end == text || *end != '\0' || *text == '-') {
    exitWithHelp(2);
  }
  return count;
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--help" || name == "-h") {
      exitWithHelp(0);
    }
    if (i + 1 == argc) {
      exitWithHelp(2);
    }
    const char* value = argv[i + 1];
    if (name == "--per-family") {
      options.per_family = parseCount(value);
    } else if (name == "--scenes") {
      options.scenes = parseCount(value);
    } else if (name == "--seed") {
      options.seed = parseCount(value);
    } else if (name == "--family") {
      options.family = value;
    } else if (name == "--threads") {
      options.threads = static_cast<int>(std::clamp<std::uint64_t>(parseCount(value), 1, 1024));
    } else {
      exitWithHelp(2);
    }
  }
  return options;
}

void printHeader() {
  std::printf("%-29s%10s%7s%7s%10s%10s%10s%8s%7s%9s%8s%8s%7s\n", "", "", "", "", "worst ulp", "",
              "", "", "early", "certified", "exact", "exact", "");
  std::printf("%-29s%10s%7s%7s%10s%10s%10s%8s%7s%9s%8s%8s%7s\n", "family", "queries", "hits",
              "wrong", "t", "range", "distance", "point", "by", "decided", "decided", "rounded",
              "s");
}

void printRow(const std::string& name, const Tally& tally, double seconds) {
  const auto per_query = [&tally](std::uint64_t count) {
    return static_cast<double>(count) /
           static_cast<double>(std::max<std::uint64_t>(tally.queries, 1));
  };
  std::printf("%-29s%10" PRIu64 "%6.1f%%%7" PRIu64
              "%10.6f%10.6f%10.6f%8.2f%7d%9.4f%8.4f%8.4f%7.1f\n",
              name.c_str(), tally.queries, 100.0 * per_query(tally.hits), tally.wrong,
              tally.worst_t, tally.worst_range, tally.worst_distance, tally.worst_point,
              tally.worst_blocked, per_query(tally.certified_decisions),
              per_query(tally.exact_decisions), per_query(tally.exact_roundings), seconds);
  for (const std::string& failure : tally.failures) {
    std::printf("  WRONG %s\n", failure.c_str());
  }
  std::fflush(stdout);
}

class Report {
 public:
  explicit Report(const Options& options) : options_(options) {}

  /// @param count count(family): how many samples or scenes of it
  template <typename Count, typename Run>
  void add(const char* prefix, const std::vector<std::string>& names, const Count& count,
           const Run& run) {
    for (std::size_t family = 0; family < names.size(); ++family) {
      if (count(family) == 0 ||
          names[family].compare(0, options_.family.size(), options_.family) != 0) {
        continue;
      }
      const auto start = std::chrono::steady_clock::now();
      const Tally tally = run(family, options_.seed, count(family), options_.threads);
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      printRow(prefix + names[family], tally, seconds.count());
      sum_.merge(tally);
      seconds_ += seconds.count();
    }
  }

  int finish() {
    sum_.failures.clear();
    printRow("all", sum_, seconds_);
    std::printf("%" PRIu64 " queries, %" PRIu64 " wrong answers\n", sum_.queries, sum_.wrong);
    if (sum_.queries == 0) {
      std::fprintf(stderr, "no family is named %s, or no samples were asked for\n",
                   options_.family.c_str());
      return 2;
    }
    return sum_.wrong == 0 ? 0 : 1;
  }

 private:
  const Options& options_;
  Tally sum_;
  double seconds_ = 0.0;
};

int run(const Options& options) {
  Report report(options);
  printHeader();
  const auto per_family = [&](std::size_t) { return options.per_family; };
  report.add("", familyNames(), per_family, runIntersections);
  report.add("distance ", familyNames(), per_family, runDistances);
  const auto scenes = [&](std::size_t family) { return sceneCount(family, options.scenes); };
  report.add("", sceneFamilyNames(), scenes, runScenes);
  return report.finish();
}

}  // namespace
}  // namespace box_query::stress

int main(int argc, char** argv) {
  return box_query::stress::run(box_query::stress::parse(argc, argv));
}
