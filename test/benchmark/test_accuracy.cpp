// SPDX-License-Identifier: BSD-3-Clause
// The benchmark on a small input, so that it cannot rot. No time is judged here.
#include "benchmark/accuracy.h"
#include "benchmark/report.h"

#include <algorithm>
#include <sstream>

#include <gtest/gtest.h>

namespace box_query::benchmark {
namespace {

Options fewQueries() {
  Options options;
  options.pair_sample = 3000;
  options.scene_sample = 256;
  options.timed_pairs = 64;
  options.timed_rays = 4;
  options.rounds = 1;
  return options;
}

bool isExact(const Row& row) {
  return row.method.rfind("box_query", 0) == 0 || row.method.find("always") != std::string::npos;
}

void checkRows(const std::vector<Row>& rows) {
  std::size_t exact_rows = 0;
  for (const Row& row : rows) {
    SCOPED_TRACE(row.table + ", " + row.input + ", " + row.prepared + ", " + row.method);
    EXPECT_GT(row.errors.hits, row.errors.asked / 10);
    EXPECT_GT(row.timing.ns.median, 0.0);
    if (isExact(row)) {
      ++exact_rows;
      EXPECT_EQ(row.errors.wrong(), 0U);
    } else if (row.input == "hostile") {
      EXPECT_GT(row.errors.wrong(), 0U) << "a hostile input that fools nobody shows nothing";
    }
    if (row.method.find("rounded") != std::string::npos) {
      EXPECT_LE(quantile(row.errors.ulps, 1.0), 0.5);
      EXPECT_FALSE(row.errors.ulps.empty());
    }
  }
  EXPECT_GE(exact_rows, 6U);
}

TEST(BenchmarkAccuracy, OnPairsTheLibraryIsRightAndPlainArithmeticIsNot) {
  checkRows(measurePairs(fewQueries()));
}

TEST(BenchmarkAccuracy, OnScenesTheLibraryIsRightAndPlainArithmeticIsNot) {
  checkRows(measureScenes(fewQueries()));
}

TEST(BenchmarkAccuracy, WritesOneLineOfTheTableARow) {
  std::vector<Row> rows(2);
  rows[0].method = "a slab, say";
  rows[0].errors.asked = rows[1].errors.asked = 4;
  rows[1].errors.false_hits = 1;
  std::ostringstream csv;
  writeCsv(rows, csv);
  const std::string text = csv.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  EXPECT_NE(text.find("\"a slab, say\""), std::string::npos);
  EXPECT_NE(text.find("250000.0,250000.0,0.0,0.0"), std::string::npos) << text;
}

TEST(BenchmarkAccuracy, QuantilesCountFromTheSmallest) {
  const std::vector<double> values = {4, 1, 3, 2, 5};
  EXPECT_EQ(quantile(values, 0.0), 1.0);
  EXPECT_EQ(quantile(values, 0.5), 3.0);
  EXPECT_EQ(quantile(values, 1.0), 5.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

}  // namespace
}  // namespace box_query::benchmark
