// SPDX-License-Identifier: BSD-3-Clause
// The short form of test/run load, without its times: and that what checks would see what is wrong.
#include "load/check_exact.h"
#include "load/rebuilt_scene.h"
#include "load/run.h"
#include "ros/conversions.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include <gtest/gtest.h>
#include <ros/ros.h>

namespace box_query::load {
namespace {

constexpr double kSeconds = 3.0;
constexpr std::size_t kSome = 40;  ///< answers that are spoilt
constexpr std::size_t kCastRay = 0;
constexpr std::size_t kCheckSegment = 2;
constexpr std::size_t kFindIntersections = 4;

/// What all tests here look at.
const Measured& measured() {
  static const Measured result = askAndCheck(kSeconds, 20);
  return result;
}

TEST(Load, EveryAnswerIsTheExactOneForItsScene) {
  const Verdict& verdict = measured().verdict;
  EXPECT_EQ(verdict.wrong, std::vector<std::string>());
  EXPECT_EQ(measured().lost(), 0U);
  // A machine that is busy may be too late to ask what a scene was.
  EXPECT_LT(verdict.unknown_scenes, measured().answers.size() / 10);
  EXPECT_EQ(verdict.rights() + verdict.refused.size() + verdict.unknown_scenes,
            measured().answers.size());
}

TEST(Load, IsALoad) {
  const Verdict& verdict = measured().verdict;
  for (std::size_t service = 0; service + 1 < kServices; ++service) {
    EXPECT_GT(verdict.right[service], 10U) << services()[service].name;
  }
  EXPECT_GT(measured().scenes.size(), 2U);
  EXPECT_GT(verdict.complete, 20U);
  EXPECT_GT(verdict.moved, 20U);
  EXPECT_GT(verdict.by_oracle, 10U);
  EXPECT_GT(measured().early_memory, 1.0);
  std::set<std::uint64_t> clients;
  for (const Answer& answer : measured().answers) {
    clients.insert(answer.seed >> 32);
  }
  EXPECT_EQ(clients.size(), kClients);
}

Verdict checkAgain(const std::vector<Answer>& answers,
                   const std::map<std::uint64_t, SceneFacts>& scenes) {
  return check(answers, scenes, answers.size() + 1, 1);
}

/// Some right answers of all services, or of one.
std::vector<Answer> someAnswers(std::size_t service = kServices) {
  std::vector<Answer> some;
  for (const Answer& answer : measured().answers) {
    if (some.size() < kSome && readSaid(answer.response).success &&
        measured().scenes.count(answer.scene_id) > 0 &&
        (service == kServices || answer.service == service)) {
      some.push_back(answer);
    }
  }
  return some;
}

TEST(LoadChecks, SeeABitThatIsWrong) {
  const std::vector<Answer> right = someAnswers(kCastRay);
  ASSERT_EQ(right.size(), kSome);
  EXPECT_EQ(checkAgain(right, measured().scenes).rights(), kSome);
  std::vector<Answer> wrong = right;
  for (Answer& answer : wrong) {
    auto response = messageFrom<CastRayResponse>(answer.response);
    std::uint64_t bits = 0;
    std::memcpy(&bits, &response.range, sizeof bits);
    bits ^= 1U;
    std::memcpy(&response.range, &bits, sizeof bits);
    answer.response = bytesOf(response);
  }
  EXPECT_EQ(checkAgain(wrong, measured().scenes).wrong.size(), kSome);
  wrong = right;
  for (Answer& answer : wrong) {
    answer.response.data.pop_back();
  }
  EXPECT_EQ(checkAgain(wrong, measured().scenes).wrong.size(), kSome);
}

TEST(LoadChecks, SeeAnAnswerFromAnotherScene) {
  std::map<std::uint64_t, SceneFacts> scenes = measured().scenes;
  // Every scene is said to hold what the topics said a second before.
  for (auto& [id, facts] : scenes) {
    for (Tick& tick : facts.ticks) {
      tick -= kTicksPerSecond;
    }
  }
  const Verdict verdict = checkAgain(someAnswers(), scenes);
  EXPECT_GT(verdict.wrong.size(), 3U) << "many meet nothing in either";
  EXPECT_EQ(checkAgain(someAnswers(), {}).unknown_scenes, kSome);
}

/// What the oracle says of the first answer of a service that `spoil` has made wrong.
template <class Request, class Response, class Spoil>
std::string spoilt(std::size_t service, const Spoil& spoil) {
  for (const Answer& answer : measured().answers) {
    if (answer.service != service || !readSaid(answer.response).success ||
        measured().scenes.count(answer.scene_id) == 0) {
      continue;
    }
    const auto request = std::get<Request>(questionOf(answer.seed, answer.asked));
    auto response = messageFrom<Response>(answer.response);
    SceneRebuilder rebuilder;
    const Snapshot& snapshot =
        rebuilder.rebuild(answer.scene_id, measured().scenes.at(answer.scene_id));
    EXPECT_EQ(differenceFromExact(request, response, snapshot), "");
    if (spoil(response)) {
      return differenceFromExact(request, response, snapshot);
    }
  }
  return "no such answer";
}

TEST(LoadChecks, SeeByTheOracleWhatIsWrongInTheLastBit) {
  const auto ray = [](const auto& spoil) {
    return spoilt<CastRayRequest, CastRayResponse>(kCastRay, spoil);
  };
  EXPECT_EQ(ray([](CastRayResponse& response) {
              response.range = std::nextafter(response.range, kInf);
              return response.hit && !response.started_inside;
            }),
            "range");
  EXPECT_EQ(ray([](CastRayResponse& response) {
              ++response.box_id;
              return response.hit != 0;
            }),
            "box");
  EXPECT_EQ(ray([](CastRayResponse& response) {
              response.hit = 1;
              return response.range == kInf;
            }),
            "hit");
  const auto segment = [](const auto& spoil) {
    return spoilt<CheckSegmentRequest, CheckSegmentResponse>(kCheckSegment, spoil);
  };
  EXPECT_EQ(segment([](CheckSegmentResponse& response) {
              response.clearance = std::nextafter(response.clearance, 0.0);
              return response.clearance > 0.0 && response.clearance < kInf;
            }),
            "clearance");
  EXPECT_EQ(segment([](CheckSegmentResponse& response) {
              response.blocked_at += 1e-15 + response.blocked_at * 1e-15;
              return response.blocked != 0;
            }),
            "blocked_at");
  const auto all = [](const auto& spoil) {
    return spoilt<FindIntersectionsRequest, FindIntersectionsResponse>(kFindIntersections, spoil);
  };
  EXPECT_EQ(all([](FindIntersectionsResponse& response) {
              if (response.t_enter.empty()) {
                return false;
              }
              response.t_enter.back() = std::nextafter(response.t_enter.back(), -kInf);
              return true;
            }).substr(0, 12),
            "intersection");
  EXPECT_EQ(all([](FindIntersectionsResponse& response) {
              response.t_enter.push_back(1.0);
              return true;
            }),
            "number of boxes");
}

}  // namespace
}  // namespace box_query::load

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_load");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
