// SPDX-License-Identifier: BSD-3-Clause
// That the benchmark of speed compares methods on questions with both answers, and finds none of
// the library's wrong. No time is judged.
#include "benchmark/speed.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace box_query::benchmark {
namespace {

std::size_t count(const std::vector<SpeedRow>& rows, Question question, const std::string& method) {
  return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [&](const SpeedRow& row) {
    return row.question == question && row.method == method;
  }));
}

void expectComparison(const SpeedRow& row) {
  EXPECT_EQ(128U, row.asked);
  EXPECT_GT(row.hits, 0U);
  EXPECT_TRUE(row.hits < row.asked || row.question == Question::kClearance);
  if (row.method == "box_query" || row.method == "plain scan") {
    EXPECT_EQ(0U, row.wrong);  // The scan is in double, and boxes are not hostile.
  }
  // Peers have their own idea of a box: of a ray that starts in one (Bullet), of contact.
  EXPECT_LT(row.wrong, row.asked / 4);
}

TEST(Speed, ComparesMethodsOnHitsAndMissesAndFindsNothingWrong) {
  for (const std::string& kind : workloadKinds()) {
    for (const std::size_t boxes : {40, 300}) {
      const Workload workload = makeWorkload(kind, boxes, 128, 5);
      const std::vector<SpeedRow> rows = measureSpeed(workload, {1, 128});
      for (const SpeedRow& row : rows) {
        SCOPED_TRACE(kind + ", " + nameOf(row.question) + ", " + row.method);
        EXPECT_EQ(boxes, row.boxes);
        EXPECT_GT(row.timing.ns.median, 0.0);
        if (row.method == "box_query") {
          EXPECT_EQ(1.0, row.timing.ratio.median);
        }
        if (row.question != Question::kBuild) {
          expectComparison(row);
        }
      }
      for (const SpeedMethodKind& method : speedMethods()) {
        for (const Question question : kQuestions) {
          const bool expected = question == Question::kBuild
                                    ? method.is_built
                                    : method.make(workload.scenes[0].boxes)->canAnswer(question);
          EXPECT_EQ(expected ? 1U : 0U, count(rows, question, method.name))
              << nameOf(question) << ", " << method.name;
        }
      }
    }
  }
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
