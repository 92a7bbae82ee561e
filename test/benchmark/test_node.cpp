// SPDX-License-Identifier: BSD-3-Clause
// The benchmark of the node, in small: no time is judged.
#include "benchmark/node_client.h"
#include "benchmark/node_processes.h"
#include "benchmark/node_questions.h"
#include "benchmark/node_report.h"
#include "benchmark/node_server.h"
#include "benchmark/speed.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <ros/init.h>

namespace box_query::benchmark {
namespace {

/// A client of the server that main() starts.
class NodeBenchmark : public testing::Test {
 protected:
  NodeClient client_;
};

TEST_F(NodeBenchmark, TimesRightAnswersOfEveryQuestion) {
  CallOptions options;
  options.boxes = {20, 200};
  options.queries = {1, 300};
  options.connections = 2;
  options.rounds = 4;
  std::vector<CallRow> rows;
  measureCalls(client_, options, [&](const CallRow& row) { rows.push_back(row); });
  ASSERT_EQ(rows.size(), 2 * 2 * 6U);
  std::set<std::string> questions;
  for (const CallRow& row : rows) {
    questions.insert(row.service + ", " + row.asks);
    EXPECT_EQ(row.wrong, 0U) << row.service << ", " << row.asks;
    EXPECT_GT(row.asked, 2 * row.queries);
    EXPECT_GT(row.bytes, 48 * row.queries);
    EXPECT_GT(row.node.median, 0.0);
    EXPECT_GT(row.empty.median, 0.0);
    EXPECT_GT(row.library.median, 0.0);
    EXPECT_GT(row.ratio.median, 0.0);
  }
  EXPECT_EQ(questions.size(), 6U);
}

TEST_F(NodeBenchmark, TimesBoxesToRightAnswers) {
  BoxesOptions options;
  options.boxes = {50};
  options.rates = {50.0};
  options.seconds = 0.4;
  std::vector<BoxesRow> rows;
  measureBoxes(client_, options, [&](const BoxesRow& row) { rows.push_back(row); });
  ASSERT_EQ(rows.size(), 1U);
  const BoxesRow& row = rows[0];
  EXPECT_EQ(row.messages, 20U);
  EXPECT_EQ(row.wrong, 0U);
  EXPECT_GE(row.asked, 2 * row.messages);
  EXPECT_GT(row.node.median, 0.0);
  EXPECT_GE(row.node.most, row.node.median);
  EXPECT_GE(row.node.worst, row.node.most);
  EXPECT_GE(row.plain.most, row.plain.median);
  EXPECT_GE(row.plain.worst, row.plain.most);
  EXPECT_GT(row.decode, 0.0);
  EXPECT_GT(row.build, 0.0);
}

/// What the library would answer, as the node sends it, but for what is asked.
CastRaysResponse answerOf(const std::vector<Hit>& hits) {
  CastRaysResponse response;
  for (const Hit& hit : hits) {
    response.hits.push_back(hit.hit);
    response.ranges.push_back(hit.range);
  }
  return response;
}

TEST(NodeQuestions, SeeOneWrongAnswerOfMany) {
  const SpeedScene known = makeWorkload("dense", 50, 200, 7).scenes.front();
  const Scene scene({known.boxes.begin(), known.boxes.end()});
  std::vector<Hit> hits(known.rays.size());
  scene.cast(known.rays.data(), hits.size(), hits.data());
  const auto hit = std::find_if(hits.begin(), hits.end(), [](const Hit& h) { return h.hit; });
  ASSERT_NE(hit, hits.end());
  const auto closest = rayQuestions(scene, known.rays, 1).at(0);
  CastRaysResponse response = answerOf(hits);
  EXPECT_EQ(closest.wrong(response), 0U);
  double& range = response.ranges[static_cast<std::size_t>(hit - hits.begin())];
  range = std::nextafter(range, 0.0);
  EXPECT_EQ(closest.wrong(response), 1U);
  response.hits.back() = response.hits.back() == 0;
  EXPECT_EQ(closest.wrong(response), 2U);
  response.ranges.pop_back();
  EXPECT_EQ(closest.wrong(response), known.rays.size());
  const auto everything = rayQuestions(scene, known.rays, 1).at(2);
  EXPECT_EQ(everything.wrong(answerOf(hits)), known.rays.size());

  const auto states = segmentQuestions(scene, known.rays, 1).at(0);
  CheckSegmentsResponse checked;
  checked.states.resize(known.rays.size(), CheckSegmentsResponse::CLEAR);
  const std::size_t blocked = states.wrong(checked);
  EXPECT_GT(blocked, 0U);
  EXPECT_LT(blocked, known.rays.size());
  EXPECT_EQ(segmentQuestions(scene, known.rays, 1).at(1).wrong(checked), known.rays.size());
}

CallRow rowOf(std::size_t queries, double empty, double library, double ratio) {
  CallRow row;
  row.service = "cast_rays";
  row.asks = "closest";
  row.boxes = 1000;
  row.queries = queries;
  row.empty.median = empty;
  row.library.median = library;
  row.ratio.median = ratio;
  return row;
}

TEST(NodeBars, AreTheWorstOfEachKind) {
  BoxesRow boxes;
  boxes.boxes = 100;
  boxes.rate = 10.0;
  boxes.node = {14.0, 18.0, 32.0};
  boxes.plain = {10.0, 12.0, 20.0};
  const std::vector<Bar> bars =
      nodeBars({rowOf(1, 100, 1, 9.0), rowOf(100, 100, 20, 1.1), rowOf(100, 100, 20, 1.2),
                rowOf(10000, 400, 2000, 1.16), rowOf(10000, 400, 1999, 1.29)},
               {boxes});
  ASSERT_EQ(bars.size(), 6U);
  EXPECT_EQ(bars[0].figure, 1.2);
  EXPECT_FALSE(bars[0].holds());
  EXPECT_EQ(bars[1].figure, 1.16);
  EXPECT_FALSE(bars[1].holds());
  EXPECT_EQ(bars[2].figure, 1.29);
  EXPECT_TRUE(bars[2].holds());
  EXPECT_EQ(bars[3].figure, 1.4);
  EXPECT_TRUE(bars[3].holds());
  EXPECT_EQ(bars[4].figure, 1.5);
  EXPECT_TRUE(bars[4].holds());
  EXPECT_EQ(bars[5].figure, 1.6);
  EXPECT_FALSE(bars[5].holds());
  EXPECT_TRUE(nodeBars({rowOf(1, 100, 1, 9.0)}, {}).empty());
}

TEST(NodeReport, HasALineARowAndAsManyFieldsInEach) {
  std::ostringstream csv;
  writeCsv({rowOf(100, 100, 20, 1.1)}, {BoxesRow()}, csv);
  std::istringstream lines(csv.str());
  std::string line;
  int count = 0;
  for (; std::getline(lines, line); ++count) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 19) << line;
  }
  EXPECT_EQ(count, 3);
}

}  // namespace
}  // namespace box_query::benchmark

int main(int argc, char** argv) {
  using namespace box_query::benchmark;
  if (argc > 1 && std::strcmp(argv[1], kServerArgument) == 0) {
    return serve(argc, argv);
  }
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_benchmark_node");
  const Process server({"/proc/self/exe", kServerArgument});
  return RUN_ALL_TESTS();
}
