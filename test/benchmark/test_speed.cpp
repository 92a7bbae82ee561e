// SPDX-License-Identifier: BSD-3-Clause
// That the benchmark of speed compares methods on questions with both answers, and finds none of
// the library's wrong. No time is judged.
#include "benchmark/speed.h"
#include "benchmark/speed_bars.h"
#include "benchmark/speed_report.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

namespace box_query::benchmark {
namespace {

std::size_t count(const std::vector<SpeedRow>& rows, Question question, Mode mode,
                  const std::string& method) {
  return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [&](const SpeedRow& row) {
    return row.question == question && row.mode == mode && row.method == method;
  }));
}

/// That there is a line for every method and every question that it can be asked.
void expectAllRows(const std::vector<SpeedRow>& rows, const Workload& workload,
                   const std::vector<SpeedMethodKind>& methods) {
  for (const SpeedMethodKind& method : methods) {
    for (const Question question : kQuestions) {
      const auto made = method.make(workload.scenes[0].boxes);
      const bool expected = question == Question::kBuild    ? method.is_built
                            : question == Question::kUpdate ? made->canUpdate()
                                                            : made->canAnswer(question);
      EXPECT_EQ(expected ? 1U : 0U, count(rows, question, Mode::kSingle, method.name))
          << nameOf(question) << ", " << method.name;
    }
  }
}

/// The same of batches, on one thread and on two.
void expectAllBatches(const std::vector<SpeedRow>& rows, const Workload& workload) {
  for (const Question question : kBatchQuestions) {
    EXPECT_EQ(1U, count(rows, question, Mode::kBatch, "box_query"));
    for (const SpeedMethodKind& method : speedMethods()) {
      const bool is_ours = method.name == "box_query";
      for (const std::string& way : method.make(workload.scenes[0].boxes)->batchWays(question)) {
        EXPECT_EQ(is_ours ? 0U : 1U, count(rows, question, Mode::kBatch, method.name + ", " + way));
      }
    }
  }
  for (const Question question : kThreadQuestions) {
    EXPECT_EQ(1U, count(rows, question, Mode::kThreads, "box_query, 1 thread"));
    EXPECT_EQ(1U, count(rows, question, Mode::kThreads, "box_query, 2 threads"));
  }
}

void expectNothingWrong(const std::vector<SpeedRow>& rows) {
  for (const SpeedRow& row : rows) {
    SCOPED_TRACE(row.workload + ", " + nameOf(row.question) + ", " + row.method);
    EXPECT_GT(row.timing.ns.median, 0.0);
    EXPECT_TRUE(row.method != "box_query" || row.timing.ratio.median == 1.0);
    if (row.question == Question::kBuild || row.question == Question::kUpdate) {
      EXPECT_EQ(0U, row.asked);
      continue;
    }
    EXPECT_EQ(row.method == "box_query" && row.mode == Mode::kSingle, row.work.nodes > 0);
    EXPECT_EQ(128U, row.asked);
    // (What is no nearer than five metres is not within a third of one of two.)
    EXPECT_TRUE(row.hits > 0U || (row.question == Question::kWithin && row.boxes == 16));
    const bool is_ours = row.method.rfind("box_query", 0) == 0;
    const bool is_plain = row.method.rfind("double slab", 0) == 0 || row.method == "plain scan";
    if (is_ours || is_plain) {
      EXPECT_EQ(0U, row.wrong);  // Plain ones are in double, and boxes are not hostile.
    }
    // Peers have their own idea of a box: of a ray that starts in one (Bullet), of contact.
    EXPECT_LT(row.wrong, row.asked / 4);
  }
}

TEST(Speed, ComparesMethodsOnHitsAndMissesAndFindsNothingWrong) {
  for (const std::string& kind : workloadKinds()) {
    for (const std::size_t boxes : {40, 300}) {
      const Workload workload = makeWorkload(kind, boxes, 300, 5);
      const std::vector<SpeedRow> rows = measureSpeed(workload, {1, 128}, speedMethods());
      expectAllRows(rows, workload, speedMethods());
      expectAllBatches(rows, workload);
      expectNothingWrong(rows);
      for (const SpeedRow& row : rows) {
        EXPECT_EQ(boxes, row.boxes);
        EXPECT_TRUE(row.asked == 0 || row.hits < row.asked || row.question == Question::kClearance)
            << kind;
      }
    }
  }
}

TEST(Speed, ComparesPairsWithPlainSlabsAndThePaper) {
  for (const bool apart : {false, true}) {
    const Workload workload = pairWorkload(apart, 256, 5);
    const std::vector<SpeedRow> rows = measureSpeed(workload, {1, 128}, pairMethods());
    expectAllRows(rows, workload, pairMethods());
    expectNothingWrong(rows);
    for (const SpeedRow& row : rows) {
      EXPECT_EQ(16U, row.boxes);
    }
  }
}

SpeedRow rowOf(const std::string& workload, std::size_t boxes, Question question,
               const std::string& method, double ns, double ratio) {
  SpeedRow row{workload, boxes, question, Mode::kSingle, method, {}};
  row.timing.ns.median = ns;
  row.timing.ratio.median = ratio;
  return row;
}

TEST(SpeedBars, TakeTheBestOfAPeersWaysInTheWorstOfTheScenes) {
  const std::vector<Bar> bars = speedBars(
      {rowOf("sparse", 8, Question::kClosest30, "box_query", 20, 1.0),
       rowOf("sparse", 8, Question::kClosest30, "Embree, boxes", 40, 2.0),
       rowOf("sparse", 8, Question::kClosest30, "Embree, triangles", 36, 1.8),
       rowOf("dense", 16, Question::kClosest30, "Embree, boxes", 34, 1.7),
       rowOf("dense", 16, Question::kClosest, "Embree, boxes", 20, 1.0),  // another question
       rowOf("dense", 64, Question::kClosest30, "Embree, boxes", 26, 1.3),
       rowOf("sparse", 10000, Question::kBuild, "box_query", 500, 1.0),
       rowOf("dense", 10000, Question::kBuild, "box_query", 800, 1.0),
       rowOf("dense", 10000, Question::kUpdate, "box_query", 100, 1.0)});
  ASSERT_EQ(4U, bars.size());
  EXPECT_EQ(1.7, bars[0].figure);
  EXPECT_EQ(1.5, bars[0].limit);
  EXPECT_TRUE(bars[0].holds());
  EXPECT_EQ(1.3, bars[1].figure);
  EXPECT_EQ(1.4, bars[1].limit);
  EXPECT_FALSE(bars[1].holds());
  EXPECT_EQ(1.25, bars[2].figure);  // million boxes a second
  EXPECT_FALSE(bars[2].holds());
  EXPECT_EQ(10.0, bars[3].figure);
  EXPECT_TRUE(bars[3].holds());
}

TEST(SpeedBars, AreALineEachThatEndsInHoldsOrFallsShort) {
  std::ostringstream out;
  printBars({{"a", 1.25, Bar::kAtLeast, 1.2, "", "more"},
             {"b", 1.25, Bar::kAtMost, 1.2, " ns", "more"},
             {"c", std::nan(""), Bar::kAtLeast, 1.2, "", "more"}},
            out);
  EXPECT_EQ(
      "a: 1.25, bar at least 1.2, holds  (more)\n"
      "b: 1.25 ns, bar at most 1.2 ns, falls short  (more)\n"
      "c: nan, bar at least 1.2, falls short  (more)\n",
      out.str());
}

TEST(SpeedReport, IsALineARow) {
  SpeedRow row = rowOf("dense", 16, Question::kAny30, "Embree, boxes", 34, 1.7);
  row.asked = 4;
  row.work.nodes = 8;
  row.work.exact_decisions = 1;
  std::ostringstream csv;
  writeCsv({row, row}, csv);
  const std::string text = csv.str();
  EXPECT_EQ(3, std::count(text.begin(), text.end(), '\n'));
  EXPECT_NE(std::string::npos, text.find("dense,16,\"any, 30 m\",single,\"Embree, boxes\",34.0,"))
      << text;
  EXPECT_NE(std::string::npos, text.find(",2.00,0.000,0.000,0.25,0.25,0\n")) << text;
  std::ostringstream table;
  print(row, table);
  EXPECT_NE(std::string::npos, table.str().find("; 2.0 nodes, 0.00 boxes, 0.25 left open\n"));
}

TEST(Speed, SaysOfEveryPeerWhetherItWasFound) {
  const std::vector<std::string> notes = peerNotes();
  for (const char* name : {"Embree", "Bullet", "FCL", "ODE"}) {
    EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [&](const std::string& note) {
      return note.find(name) == 0;
    })) << name;
  }
}

}  // namespace
}  // namespace box_query::benchmark
