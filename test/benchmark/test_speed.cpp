// SPDX-License-Identifier: BSD-3-Clause
// That the benchmark of speed compares methods on questions with both answers, and finds none of
// the library's wrong. No time is judged.
#include "benchmark/speed.h"

#include <gtest/gtest.h>

namespace box_query::benchmark {
namespace {

TEST(Speed, ComparesMethodsOnHitsAndMissesAndFindsNothingWrong) {
  for (const std::string& kind : workloadKinds()) {
    for (const std::size_t boxes : {40, 300}) {
      const std::vector<SpeedRow> rows = measureSpeed(makeWorkload(kind, boxes, 128, 5), 1, 128);
      EXPECT_GE(rows.size(), 6U + 5U);  // six questions, of which a plain scan answers five
      for (const SpeedRow& row : rows) {
        const std::string what = kind + ", " + nameOf(row.question) + ", " + row.method;
        EXPECT_EQ(128U, row.asked) << what;
        EXPECT_GT(row.hits, 0U) << what;
        EXPECT_TRUE(row.hits < row.asked || row.question == Question::kClearance) << what;
        EXPECT_GT(row.timing.ns.median, 0.0) << what;
        if (row.method == "box_query") {
          EXPECT_EQ(0U, row.wrong) << what;
          EXPECT_EQ(1.0, row.timing.ratio.median) << what;
        }
        if (row.method == "plain scan") {
          EXPECT_EQ(0U, row.wrong) << what;  // in double, on boxes that are not hostile
        }
      }
    }
  }
}

}  // namespace
}  // namespace box_query::benchmark
