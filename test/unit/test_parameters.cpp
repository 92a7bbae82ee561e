// SPDX-License-Identifier: BSD-3-Clause
#include <box_query/ros/parameters.h>

#include <cmath>
#include <limits>
#include <map>
#include <regex>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

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
  Parameters parameters = Parameters::fromValues(values, "/node", unknown);
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

using Member = std::variant<int Parameters::*, double Parameters::*>;
using P = Parameters;
const std::map<std::string, Member> kNumbers = {
    {"transform_timeout", &P::transform_timeout},
    {"waiting_timeout", &P::waiting_timeout},
    {"max_waiting_boxes", &P::max_waiting_boxes},
    {"transform_history", &P::transform_history},
    {"max_boxes_per_message", &P::max_boxes_per_message},
    {"max_backlog_memory", &P::max_backlog_memory},
    {"max_boxes_per_topic", &P::max_boxes_per_topic},
    {"max_namespaces", &P::max_namespaces},
    {"max_queries_per_call", &P::max_queries_per_call},
    {"max_coordinate", &P::max_coordinate},
    {"max_name_length", &P::max_name_length},
    {"max_filter_names", &P::max_filter_names},
    {"service_threads", &P::service_threads},
    {"batch_threads", &P::batch_threads},
    {"build_ahead", &P::build_ahead},
    {"kept_scenes", &P::kept_scenes},
    {"max_kept_boxes", &P::max_kept_boxes},
    {"history", &P::history},
    {"max_past_scenes", &P::max_past_scenes},
    {"max_history_memory", &P::max_history_memory},
    {"marker_rate", &P::marker_rate},
    {"marker_lifetime", &P::marker_lifetime},
    {"max_marker_queries", &P::max_marker_queries},
    {"max_marker_labels", &P::max_marker_labels},
};

/// What the documentation says of a number.
struct DocumentedNumber {
  std::string name;
  bool is_int;
  double usual;
  double min;
  double max;
};

std::vector<DocumentedNumber> documentedNumbers() {
  const std::string table = Parameters::documentation();
  const std::regex row(R"(\| `~(\w+)` \| (int|double) \| (\S+) \| (\S+) to (\S+) )");
  std::vector<DocumentedNumber> numbers;
  for (std::sregex_iterator at(table.begin(), table.end(), row), end; at != end; ++at) {
    const std::smatch& found = *at;
    numbers.push_back({found[1], found[2] == "int", std::stod(found[3]), std::stod(found[4]),
                       std::stod(found[5])});
  }
  return numbers;
}

XmlRpcValue valueOf(const DocumentedNumber& number, double value) {
  return number.is_int ? XmlRpcValue(static_cast<int>(value)) : XmlRpcValue(value);
}

double valueIn(const Parameters& parameters, const std::string& name) {
  return std::visit([&](auto member) { return static_cast<double>(parameters.*member); },
                    kNumbers.at(name));
}

TEST(NumbersAmongParameters, AreTakenWithinTheirRangesAndRefusedBeyond) {
  const std::vector<DocumentedNumber> numbers = documentedNumbers();
  ASSERT_EQ(numbers.size(), kNumbers.size());
  for (const DocumentedNumber& number : numbers) {
    SCOPED_TRACE(number.name);
    EXPECT_EQ(valueIn(Parameters(), number.name), number.usual);
    for (const double value : {number.min, number.usual, number.max}) {
      const Parameters read = readValues(structOf(number.name, valueOf(number, value)));
      EXPECT_EQ(valueIn(read, number.name), value);
    }
    const double step = number.is_int ? 1.0 : 1e-9 * number.max;
    std::vector<XmlRpcValue> refused = {valueOf(number, number.min - step),
                                        valueOf(number, number.max + step),
                                        XmlRpcValue(std::nan("")),
                                        XmlRpcValue(1e300),
                                        XmlRpcValue(std::numeric_limits<double>::infinity()),
                                        XmlRpcValue(std::numeric_limits<int>::min()),
                                        XmlRpcValue(std::numeric_limits<int>::max()),
                                        XmlRpcValue(true),
                                        XmlRpcValue("1"),
                                        XmlRpcValue(""),
                                        listOf({}),
                                        structOf("a", XmlRpcValue(1))};
    if (number.max >= std::numeric_limits<int>::max()) {
      refused.erase(refused.begin() + 6);  // within its range
    }
    for (const XmlRpcValue& value : refused) {
      EXPECT_EQ(refusal(number.name, value).find("parameter /node/" + number.name + " is "), 0U)
          << value.toXml();
    }
  }
}

TEST(NumbersAmongParameters, GoEachToItsOwnPlace) {
  XmlRpcValue values;
  std::map<std::string, double> expected;
  for (const DocumentedNumber& number : documentedNumbers()) {
    const double value = 2.0 + static_cast<double>(expected.size());
    values[number.name] = valueOf(number, value);
    expected[number.name] = value;
  }
  const Parameters read = readValues(values);
  for (const auto& [name, value] : expected) {
    EXPECT_EQ(valueIn(read, name), value) << name;
  }
}

}  // namespace
}  // namespace box_query
