// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_filter.h"
#include "unit/answer_fixture.h"

#include <algorithm>
#include <tuple>

#include <gtest/gtest.h>

namespace box_query::test {
namespace {

template <class Request>
class FilterOf : public testing::Test {};

using Requests = testing::Types<CastRayRequest, CastRaysRequest, CheckSegmentRequest,
                                CheckSegmentsRequest, FindIntersectionsRequest, GetSceneRequest>;
TYPED_TEST_SUITE(FilterOf, Requests);

TYPED_TEST(FilterOf, EveryRequestMakesAMaskOnlyWhereItIsUsed) {
  const Snapshot snapshot = smallSnapshot();
  const auto isUsed = [&](const TypeParam& request) {
    return maskOf(BoxFilter(request), snapshot).has_value();
  };
  TypeParam request;
  EXPECT_FALSE(isUsed(request));
  EXPECT_EQ(unknownNames(BoxFilter(request), snapshot), "");
  request.topics = {"/a"};
  EXPECT_TRUE(isUsed(request));
  request = TypeParam();
  request.namespaces = {""};
  EXPECT_TRUE(isUsed(request));
  request = TypeParam();
  request.labels = {""};
  EXPECT_TRUE(isUsed(request));
  request = TypeParam();
  request.ignore_topics = {"/b"};
  EXPECT_TRUE(isUsed(request));
  request = TypeParam();
  request.ignore_namespaces = {"rack"};
  EXPECT_TRUE(isUsed(request));
}

/// Which boxes pass, one character a box; all of them without a mask.
std::string passing(const CastRayRequest& request, const Snapshot& snapshot = smallSnapshot()) {
  const auto mask = maskOf(BoxFilter(request), snapshot);
  std::string text;
  for (std::size_t i = 0; i < snapshot.names.size(); ++i) {
    text += !mask || (*mask)[i] ? 'x' : '-';
  }
  return text;
}

TEST(BoxFilter, ChoosesByTopicNamespaceAndLabel) {
  CastRayRequest request;
  EXPECT_EQ(passing(request), "xxxx");
  request.topics = {"/b"};
  EXPECT_EQ(passing(request), "---x");
  request.topics = {"b", "/nothing"};
  EXPECT_EQ(passing(request), "---x") << "topics are resolved as the node's own";
  request.topics = {"/a"};
  request.namespaces = {"rack"};
  EXPECT_EQ(passing(request), "xx--");
  request.labels = {"first", "other"};
  EXPECT_EQ(passing(request), "x---");
  request.topics.clear();
  EXPECT_EQ(passing(request), "x--x");
  request.namespaces.clear();
  request.labels = {""};
  EXPECT_EQ(passing(request), "-xx-") << "those without a label";
  request.labels.clear();
  request.namespaces = {"nobody", "robot"};
  EXPECT_EQ(passing(request), "--x-");
  request.namespaces = {"nobody"};
  EXPECT_EQ(passing(request), "----");
  request.namespaces = {"rac"};
  EXPECT_EQ(passing(request), "----") << "whole names count";
}

TEST(BoxFilter, IgnoresBoxesByAsMuchOfTheirNamesAsIsGiven) {
  CastRayRequest request;
  request.ignore_namespaces = {"rack", "rack"};
  request.ignore_ids = {1, 2};
  EXPECT_EQ(passing(request), "--x-") << "without topics, every topic's box is ignored";
  request.ignore_topics = {"/a", "a"};
  EXPECT_EQ(passing(request), "--xx");
  request.ignore_ids = {17, 18};
  EXPECT_EQ(passing(request), "xxxx") << "boxes that are not there are no error";
  request.ignore_ids.clear();
  EXPECT_EQ(passing(request), "--xx") << "without ids, the namespace";
  request.ignore_topics.clear();
  EXPECT_EQ(passing(request), "--x-");
  request.namespaces = {"rack"};
  EXPECT_EQ(passing(request), "----");
  request = CastRayRequest();
  request.ignore_topics = {"/a"};
  EXPECT_EQ(passing(request), "---x") << "without namespaces, the topic";
}

TEST(BoxFilter, IgnoresSeveralBoxesOfOneNameTogether) {
  Snapshot snapshot = smallSnapshot();
  snapshot.names[1].id = 1;
  CastRayRequest request;
  request.ignore_namespaces = {"rack"};
  request.ignore_ids = {1};
  EXPECT_EQ(passing(request, snapshot), "--x-");
}

/// The definition, box by box.
bool passes(const CastRayRequest& request, const BoxName& box) {
  const auto chooses = [](const std::vector<std::string>& choice, const std::string& name) {
    return choice.empty() || std::find(choice.begin(), choice.end(), name) != choice.end();
  };
  bool ignored = false;
  const std::size_t names =
      std::max(request.ignore_topics.size(), request.ignore_namespaces.size());
  for (std::size_t i = 0; i < names; ++i) {
    ignored =
        ignored || ((request.ignore_topics.empty() || request.ignore_topics[i] == box.topic) &&
                    (request.ignore_namespaces.empty() || request.ignore_namespaces[i] == box.ns) &&
                    (request.ignore_ids.empty() || request.ignore_ids[i] == box.id));
  }
  return !ignored && chooses(request.topics, box.topic) && chooses(request.namespaces, box.ns) &&
         chooses(request.labels, box.label);
}

TEST(BoxFilter, PassesWhatItsDefinitionSays) {
  std::mt19937 random(3);
  const auto upTo = [&random](int most) {
    return std::uniform_int_distribution<int>(0, most)(random);
  };
  const std::vector<std::string> words = {"", "/a", "/aa", "/b", "/b/a"};
  const auto word = [&] { return words[std::size_t(upTo(4))]; };
  const auto topic = [&] { return words[1 + std::size_t(upTo(3))]; };
  const auto oftenNone = [&](std::size_t count, const auto& name) {
    std::vector<std::string> names(upTo(1) == 0 ? count : 0);
    std::generate(names.begin(), names.end(), name);
    return names;
  };
  std::size_t part = 0;  // some boxes pass, others do not
  for (int round = 0; round < 2000; ++round) {
    Snapshot snapshot;
    for (int i = upTo(150); i > 0; --i) {
      snapshot.names.push_back({topic(), word(), upTo(3) - 1, word()});
    }
    std::sort(snapshot.names.begin(), snapshot.names.end(), [](const auto& a, const auto& b) {
      return std::tie(a.topic, a.ns, a.id) < std::tie(b.topic, b.ns, b.id);
    });
    CastRayRequest request;
    request.topics = oftenNone(std::size_t(upTo(3)), word);
    request.namespaces = oftenNone(std::size_t(upTo(3)), word);
    request.labels = oftenNone(std::size_t(upTo(3)), word);
    const auto ignored = std::size_t(upTo(4));
    request.ignore_topics = oftenNone(ignored, topic);
    request.ignore_namespaces = oftenNone(ignored, word);
    if (upTo(1) == 0) {
      for (std::size_t i = 0; i < request.ignore_namespaces.size(); ++i) {
        request.ignore_ids.push_back(upTo(3) - 1);
      }
    }
    ASSERT_NO_THROW(check(BoxFilter(request), Limits()));
    std::string expected;
    for (const BoxName& name : snapshot.names) {
      expected += passes(request, name) ? 'x' : '-';
    }
    ASSERT_EQ(passing(request, snapshot), expected) << "round " << round;
    part += expected.find('x') != std::string::npos && expected.find('-') != std::string::npos;
  }
  EXPECT_GT(part, 500U);
}

TEST(BoxFilter, IsRefusedWhereIgnoredNamesDoNotFitTogether) {
  const auto with = [](auto change) {
    CastRayRequest request;
    request.header.frame_id = "map";
    request.direction = vector(1, 0, 0);
    change(request);
    return refusal(request);
  };
  EXPECT_EQ(with([](auto& r) { r.ignore_ids = {1}; }),
            "ignore_namespaces has 0 elements and ignore_ids 1: name every ignored box by its "
            "namespace and its id");
  EXPECT_EQ(with([](auto& r) {
              r.ignore_topics = {"a"};
              r.ignore_ids = {1};
            }).find("ignore_namespaces has 0 elements"),
            0U);
  EXPECT_EQ(with([](auto& r) {
              r.ignore_topics = {"a"};
              r.ignore_namespaces = {"b", "c"};
            }),
            "ignore_topics has 1 elements and ignore_namespaces 2: leave it empty (any topic), or "
            "give one topic a namespace");
  EXPECT_EQ(with([](auto& r) { r.ignore_topics = {"a"}; }), "");
}

std::string unknown(const CastRayRequest& request, const Snapshot& snapshot = smallSnapshot()) {
  return unknownNames(BoxFilter(request), snapshot);
}
std::string unknownNamespaces(const std::vector<std::string>& namespaces,
                              const Snapshot& snapshot) {
  CastRayRequest request;
  request.namespaces = namespaces;
  return unknown(request, snapshot);
}

TEST(BoxFilter, NamesTheNamespaceThatNoBoxHas) {
  Snapshot snapshot = smallSnapshot();
  EXPECT_EQ(unknownNamespaces({"robot", "rack"}, snapshot), "");
  EXPECT_EQ(
      unknownNamespaces({"rack", "robt"}, snapshot),
      "No box has the namespace 'robt': there are 'rack', 'robot'. Correct it, unless none is "
      "meant to be there now.");
  EXPECT_NE(unknownNamespaces({""}, snapshot), "");
  snapshot.names.insert(snapshot.names.begin(), BoxName{"/a", "", 1, ""});
  EXPECT_EQ(unknownNamespaces({""}, snapshot), "");
  EXPECT_EQ(unknownNamespaces({"rac"}, snapshot).find("No box has the namespace 'rac':"), 0U);
}

TEST(BoxFilter, NamesTheOtherNamesThatNothingHas) {
  CastRayRequest request;
  request.topics = {"a", "/b", "/bb", "c"};
  EXPECT_EQ(unknown(request),
            "The node does not listen to the topic '/bb': there are '/a', '/b'. Correct it.");
  request.topics = {"b"};
  request.labels = {"other", "frist", "last"};
  EXPECT_EQ(unknown(request),
            "No box has the label 'frist': there are '', 'first', 'other'. Correct it, unless none "
            "is meant to be there now.");
  request.labels = {"", "first"};
  request.ignore_namespaces = {"rack", "rack", "robot"};
  request.ignore_ids = {1, 3, 3};
  EXPECT_EQ(unknown(request), "There is no box to ignore of namespace 'rack', id 3.");
  request.ignore_ids.clear();
  EXPECT_EQ(unknown(request), "");
  request.ignore_topics = {"/a", "b", "b"};
  EXPECT_EQ(unknown(request), "There is no box to ignore of topic 'b', namespace 'robot'.");
  request.labels = {"?"};
  request.topics = {""};
  const std::string three = unknown(request);
  EXPECT_NE(three.find("topic '': there"), std::string::npos) << three;
  EXPECT_NE(three.find(". No box has the label '?'"), std::string::npos) << three;
  EXPECT_NE(three.find(". There is no box to ignore"), std::string::npos) << three;
}

TEST(BoxFilter, ListsAFewOfManyNames) {
  Snapshot snapshot;
  EXPECT_EQ(unknownNamespaces({"rack"}, snapshot),
            "No box has the namespace 'rack': there are no boxes.");
  for (int i = 34; i >= 10; --i) {
    snapshot.names.push_back({"/" + std::to_string(50 - i), std::to_string(i), 1, ""});
  }
  const std::string sentence = unknownNamespaces({"rack"}, snapshot);
  EXPECT_NE(sentence.find("there are '10', '11'"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("'19' and more."), std::string::npos) << sentence;
  snapshot.names.erase(snapshot.names.begin(), snapshot.names.begin() + 15);
  const std::string ten = unknownNamespaces({"rack"}, snapshot);
  EXPECT_NE(ten.find("'18', '19'. Correct"), std::string::npos) << ten;
}

TEST(BoxFilter, LeavesOutWhatOtherTopicsLack) {
  Snapshot snapshot = smallSnapshot();
  snapshot.topics[1].problem = "One box of topic /b waits.";
  CheckSegmentRequest request;
  const auto reason = [&] {
    const CheckSegmentResponse response = ask(request, snapshot);
    EXPECT_EQ(response.complete, response.reason.empty());
    EXPECT_EQ(response.clear, response.complete);
    return response.reason;
  };
  EXPECT_EQ(reason(), "One box of topic /b waits.");
  request.topics = {"a"};
  EXPECT_EQ(reason(), "") << "nothing of /b can be in the way";
  request.topics = {"a", "b"};
  EXPECT_EQ(reason(), "One box of topic /b waits.");
  request.topics.clear();
  request.ignore_topics = {"/c", "/b"};
  EXPECT_EQ(reason(), "");
  request.ignore_topics = {"/b"};
  request.ignore_namespaces = {"rack"};
  EXPECT_EQ(reason(), "One box of topic /b waits.") << "it may be of another namespace";
  request.topics = {"/a"};
  EXPECT_EQ(reason(), "");
  request = CheckSegmentRequest();
  request.namespaces = {"robot"};
  EXPECT_EQ(reason(), "One box of topic /b waits.");
  request.topics = {"/a", "/nothing"};
  EXPECT_EQ(reason(),
            "The node does not listen to the topic '/nothing': there are '/a', '/b'. Correct it.");
}

TEST(BoxFilter, DecidesWhatIsAnswered) {
  CastRayRequest request;
  request.direction = vector(1, 0, 0);
  request.labels = {"other"};
  EXPECT_EQ(ask(request, smallSnapshot()).range, 7.5);
  request.ignore_topics = {"/b"};
  EXPECT_FALSE(ask(request, smallSnapshot()).hit);
}

}  // namespace
}  // namespace box_query::test
