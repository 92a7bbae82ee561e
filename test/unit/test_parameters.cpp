// SPDX-License-Identifier: BSD-3-Clause
#include <box_query/ros/parameters.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace box_query {
namespace {

using XmlRpc::XmlRpcValue;

XmlRpcValue structOf(const std::string& key, const XmlRpcValue& value) {
  XmlRpcValue values;
  values[key] = value;
  return values;
}

XmlRpcValue listOf(const std::vector<XmlRpcValue>& items) {
  XmlRpcValue list;
  list.setSize(static_cast<int>(items.size()));
  for (std::size_t i = 0; i < items.size(); ++i) {
    list[static_cast<int>(i)] = items[i];
  }
  return list;
}

Parameters readValues(const XmlRpcValue& values) {
  std::vector<std::string> unknown;
  const Parameters parameters = Parameters::fromValues(values, "/node", unknown);
  EXPECT_TRUE(unknown.empty()) << unknown.front();
  return parameters;
}

/// The sentence with which a value is refused; empty if it is not.
std::string refusal(const std::string& key, const XmlRpcValue& value) {
  try {
    readValues(structOf(key, value));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Parameters, KeepTheirDefaultsWhereNothingIsSet) {
  const Parameters read = readValues(XmlRpcValue());
  const Parameters defaults;
  EXPECT_EQ(read.fixed_frame, defaults.fixed_frame);
  EXPECT_EQ(read.transform_timeout, defaults.transform_timeout);
  EXPECT_EQ(read.max_queries_per_call, defaults.max_queries_per_call);
  ASSERT_EQ(read.box_topics.size(), 1U);
  EXPECT_EQ(read.box_topics[0].topic, "boxes");
}

TEST(Parameters, AreReadAndAnIntegerDoesForADouble) {
  XmlRpcValue values;
  values["fixed_frame"] = "odom";
  values["transform_timeout"] = 1;
  values["marker_rate"] = 2.5;
  values["service_threads"] = 64;
  const Parameters read = readValues(values);
  EXPECT_EQ(read.fixed_frame, "odom");
  EXPECT_EQ(read.transform_timeout, 1.0);
  EXPECT_EQ(read.marker_rate, 2.5);
  EXPECT_EQ(read.service_threads, 64);
}

TEST(Parameters, TakeTopicsAsNamesOrStructs) {
  XmlRpcValue walls;
  walls["topic"] = "/static/walls";
  walls["timeout"] = 2;
  walls["required"] = false;
  walls["drop_stale"] = true;
  const Parameters read = readValues(structOf("box_topics", listOf({XmlRpcValue("boxes"), walls})));
  ASSERT_EQ(read.box_topics.size(), 2U);
  EXPECT_EQ(read.box_topics[0].topic, "boxes");
  EXPECT_EQ(read.box_topics[0].timeout, 0.0);
  EXPECT_TRUE(read.box_topics[0].required);
  EXPECT_EQ(read.box_topics[1].topic, "/static/walls");
  EXPECT_EQ(read.box_topics[1].timeout, 2.0);
  EXPECT_FALSE(read.box_topics[1].required);
  EXPECT_FALSE(read.box_topics[0].drop_stale);
  EXPECT_TRUE(read.box_topics[1].drop_stale);
}

TEST(Parameters, RefusalsNameTheParameterItsValueAndWhatIsAllowed) {
  const XmlRpcValue no_topic = structOf("timeout", XmlRpcValue(1.0));
  XmlRpcValue typo = structOf("topic", XmlRpcValue("a"));
  typo["time_out"] = 1.0;
  XmlRpcValue late = structOf("topic", XmlRpcValue("a"));
  late["timeout"] = -1.0;
  XmlRpcValue maybe = structOf("topic", XmlRpcValue("a"));
  maybe["required"] = 1;
  const struct {
    const char* key;
    XmlRpcValue value;
    const char* name;
    const char* given;
    const char* allowed;
  } cases[] = {
      {"fixed_frame", XmlRpcValue(""), "/node/fixed_frame", "\"\"", "not empty"},
      {"fixed_frame", XmlRpcValue("/map"), "/node/fixed_frame", "\"/map\"", "leading slash"},
      {"fixed_frame", XmlRpcValue(3), "/node/fixed_frame", "3", "frame"},
      {"marker_rate", XmlRpcValue(1000), "/node/marker_rate", "1000", "0.1 to 100 [Hz]"},
      {"marker_rate", XmlRpcValue("fast"), "/node/marker_rate", "the string \"fast\"", "number"},
      {"transform_timeout", XmlRpcValue(-0.1), "/node/transform_timeout", "-0.1", "0 to 60 [s]"},
      {"transform_timeout", XmlRpcValue(std::nan("")), "/node/transform_timeout", "nan", "0 to 60"},
      {"build_ahead", XmlRpcValue(std::numeric_limits<double>::infinity()), "/node/build_ahead",
       "inf", "0 to 3600 [s]"},
      {"service_threads", XmlRpcValue(2.0), "/node/service_threads", "the double 2;",
       "an integer from 1 to 64"},
      {"service_threads", XmlRpcValue(0), "/node/service_threads", "0", "1 to 64"},
      {"service_threads", XmlRpcValue(true), "/node/service_threads", "true", "an integer"},
      {"box_topics", XmlRpcValue("boxes"), "/node/box_topics", "\"boxes\"", "box_query.launch"},
      {"box_topics", listOf({}), "/node/box_topics", "", "at least one"},
      {"box_topics", listOf({XmlRpcValue("a"), XmlRpcValue(7)}), "/node/box_topics[1]", "7",
       "name"},
      {"box_topics", listOf({XmlRpcValue("a b")}), "/node/box_topics[0]", "\"a b\"", "name"},
      {"box_topics", listOf({XmlRpcValue("~a")}), "/node/box_topics[0]", "\"~a\"", "relative"},
      {"box_topics", listOf({no_topic}), "/node/box_topics[0]", "timeout", "topic"},
      {"box_topics", listOf({typo}), "/node/box_topics[0]/time_out", "1",
       "timeout, required and drop_stale"},
      {"box_topics", listOf({late}), "/node/box_topics[0]/timeout", "-1", "0 to 1000000000 [s]"},
      {"box_topics", listOf({maybe}), "/node/box_topics[0]/required", "1", "true or false"},
      {"box_topics", listOf({XmlRpcValue("a"), XmlRpcValue("/a")}), "/node/box_topics[1]", "\"/a\"",
       "another topic"},
  };
  for (const auto& c : cases) {
    const std::string sentence = refusal(c.key, c.value);
    EXPECT_TRUE(contains(sentence, std::string("parameter ") + c.name + " is ")) << sentence;
    EXPECT_TRUE(contains(sentence, c.given)) << sentence;
    EXPECT_TRUE(contains(sentence, c.allowed)) << sentence << " lacks " << c.allowed;
  }
}

TEST(Parameters, ThatAreUnknownAreReported) {
  std::vector<std::string> unknown;
  XmlRpcValue values = structOf("fixed_fram", XmlRpcValue("odom"));
  values["marker_rate"] = 1.0;
  EXPECT_EQ(Parameters::fromValues(values, "/node", unknown).marker_rate, 1.0);
  EXPECT_EQ(unknown, std::vector<std::string>{"/node/fixed_fram"});
}

TEST(Parameters, AreAllDocumentedWithinTheirRanges) {
  const std::string table = Parameters::documentation();
  EXPECT_TRUE(contains(table, "| `~marker_rate` | double | 10 | 0.1 to 100 [Hz] |")) << table;
  EXPECT_TRUE(contains(table, "| `~kept_scenes` | int | 100 | 1 to 10000 |")) << table;
  EXPECT_TRUE(contains(table, "| `~fixed_frame` | string | map |")) << table;
}

}  // namespace
}  // namespace box_query
