// SPDX-License-Identifier: BSD-3-Clause
#include <box_query/ros/parameters.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <variant>

#include <ros/console.h>
#include <ros/names.h>
#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace box_query {
namespace {

using XmlRpc::XmlRpcValue;

/// What a number may be.
struct Range {
  double min;
  double max;
  const char* unit;
};

/// A number among the parameters.
struct Entry {
  const char* name;
  std::variant<int Parameters::*, double Parameters::*> member;
  Range range;
  const char* meaning;
};

using P = Parameters;
// clang-format off
const Entry kNumbers[] = {
    {"transform_timeout", &P::transform_timeout, {0, 60, "s"}, "wall time that a request waits for its transform"},
    {"waiting_timeout", &P::waiting_timeout, {0, 3600, "s"}, "wall time that a box waits for its transform before it is given up"},
    {"max_waiting_boxes", &P::max_waiting_boxes, {0, 1e8, ""}, "boxes that may wait for their transforms at once; more are counted and given up"},
    {"transform_history", &P::transform_history, {1, 3600, "s"}, "transforms that the tf buffer keeps"},
    {"max_boxes_per_message", &P::max_boxes_per_message, {1, 1e8, ""}, "a message with more boxes is refused whole"},
    {"max_backlog_memory", &P::max_backlog_memory, {1, 1e5, "MB"}, "messages of a topic that wait to be taken in; the oldest go first, the latest stays, and the scene is incomplete until the topic is cleared"},
    {"max_boxes_per_topic", &P::max_boxes_per_topic, {1, 1e8, ""}, "boxes that a topic may have at once; what goes beyond is rejected until the topic is cleared"},
    {"max_namespaces", &P::max_namespaces, {1, 1e6, ""}, "the same of namespaces"},
    {"max_queries_per_call", &P::max_queries_per_call, {1, 1e8, ""}, "a request with more rays or segments is refused"},
    {"max_coordinate", &P::max_coordinate, {1, 1e15, "m"}, "a box with a larger coordinate or size is rejected, a request with one refused"},
    {"max_name_length", &P::max_name_length, {1, 1e6, "bytes"}, "a message or a request with a longer namespace, label, id, frame or topic is refused"},
    {"max_filter_names", &P::max_filter_names, {1, 1e6, ""}, "a request with more names in one of its filters is refused"},
    {"service_threads", &P::service_threads, {1, 64, ""}, "threads that answer services"},
    {"batch_threads", &P::batch_threads, {0, 256, ""}, "threads that work on a batch of rays or segments; 0: as many as there are cores"},
    {"build_ahead", &P::build_ahead, {0, 3600, "s"}, "after a query, scenes are built as boxes come for so long; later when asked for"},
    {"kept_scenes", &P::kept_scenes, {1, 10000, ""}, "past scenes that `~get_scene` can still return"},
    {"max_kept_boxes", &P::max_kept_boxes, {0, 1e8, ""}, "boxes in all of these together; the oldest go first, the latest stays"},
    {"history", &P::history, {0, 3600, "s"}, "ROS time that past scenes are remembered for `scene_time`; 0: none are"},
    {"max_past_scenes", &P::max_past_scenes, {1, 1e6, ""}, "scenes that are remembered so, one a change; the oldest go first"},
    {"max_history_memory", &P::max_history_memory, {1, 1e6, "MB"}, "what they take together, about; the oldest go first, the latest stays"},
    {"marker_rate", &P::marker_rate, {0.1, 100, "Hz"}, "`~markers` is published at most so often"},
    {"marker_lifetime", &P::marker_lifetime, {0.1, 3600, "s"}, "how long the markers of a query stay"},
    {"max_marker_queries", &P::max_marker_queries, {0, 10000, ""}, "queries that are drawn at once, the latest ones"},
    {"max_marker_labels", &P::max_marker_labels, {0, 10000, ""}, "boxes whose labels are drawn, the first ones"},
};
// clang-format on
const Range kTopicTimeout = {0, 1e9, "s"};

std::string print(const Range& range) {
  std::ostringstream out;
  out.precision(10);
  out << range.min << " to " << range.max;
  if (*range.unit != '\0') {
    out << " [" << range.unit << "]";
  }
  return out.str();
}

std::string print(const XmlRpcValue& value) {
  std::ostringstream out;
  switch (value.getType()) {
    case XmlRpcValue::TypeString:
      out << "the string \"" << static_cast<const std::string&>(value) << '"';
      break;
    case XmlRpcValue::TypeBoolean:
      out << (static_cast<bool>(value) ? "true" : "false");
      break;
    case XmlRpcValue::TypeDouble:  // 2.0 must not look like the integer
      out << "the double " << static_cast<const double&>(value);
      break;
    default:
      value.write(out);
  }
  return out.str();
}

[[noreturn]] void refuse(const std::string& name, const XmlRpcValue& value,
                         const std::string& allowed) {
  throw std::invalid_argument("parameter " + name + " is " + print(value) + "; it must be " +
                              allowed);
}

void read(const std::string& name, const XmlRpcValue& value, const Range& range, double& number) {
  const bool is_int = value.getType() == XmlRpcValue::TypeInt;
  const double given = is_int ? static_cast<const int&>(value)
                       : value.getType() == XmlRpcValue::TypeDouble
                           ? static_cast<const double&>(value)
                           : std::numeric_limits<double>::quiet_NaN();
  if (!(given >= range.min && given <= range.max)) {
    refuse(name, value, "a number from " + print(range));
  }
  number = given;
}

void read(const std::string& name, const XmlRpcValue& value, const Range& range, int& number) {
  double given = 0;
  if (value.getType() == XmlRpcValue::TypeInt) {
    given = static_cast<const int&>(value);
  }
  if (value.getType() != XmlRpcValue::TypeInt || given < range.min || given > range.max) {
    refuse(name, value, "an integer from " + print(range));
  }
  number = static_cast<const int&>(value);
}

void read(const std::string& name, const XmlRpcValue& value, bool& yes) {
  if (value.getType() != XmlRpcValue::TypeBoolean) {
    refuse(name, value, "true or false");
  }
  yes = static_cast<const bool&>(value);
}

void readFrame(const std::string& name, const XmlRpcValue& value, std::string& frame) {
  const char* allowed = "the name of a tf frame, not empty and without a leading slash";
  if (value.getType() != XmlRpcValue::TypeString) {
    refuse(name, value, allowed);
  }
  frame = static_cast<const std::string&>(value);
  if (frame.empty() || frame.front() == '/') {
    refuse(name, value, allowed);
  }
}

void readTopicName(const std::string& name, const XmlRpcValue& value, std::string& topic) {
  const char* allowed = "the name of a topic, relative (boxes) or absolute (/ns/boxes)";
  if (value.getType() != XmlRpcValue::TypeString) {
    refuse(name, value, allowed);
  }
  topic = static_cast<const std::string&>(value);
  std::string error;
  if (topic.empty() || topic.front() == '~' || !ros::names::validate(topic, error)) {
    refuse(name, value, allowed);
  }
}

TopicParameters readTopic(const std::string& name, const XmlRpcValue& value) {
  TopicParameters topic;
  if (value.getType() != XmlRpcValue::TypeStruct) {
    readTopicName(name, value, topic.topic);
    return topic;
  }
  if (!value.hasMember("topic")) {
    refuse(name, value, "the name of a topic, or a struct with at least the key topic");
  }
  for (const auto& [key, member] : value) {
    const std::string member_name = name + "/" + key;
    if (key == "topic") {
      readTopicName(member_name, member, topic.topic);
    } else if (key == "timeout") {
      read(member_name, member, kTopicTimeout, topic.timeout);
    } else if (key == "required") {
      read(member_name, member, topic.required);
    } else if (key == "drop_stale") {
      read(member_name, member, topic.drop_stale);
    } else {
      refuse(member_name, member,
             "left out: a topic has the keys topic, timeout, required and drop_stale");
    }
  }
  return topic;
}

std::vector<TopicParameters> readTopics(const std::string& name, const XmlRpcValue& value) {
  if (value.getType() != XmlRpcValue::TypeArray || value.size() == 0) {
    std::string allowed =
        "a list of at least one topic, each a name or a struct: "
        "[boxes, {topic: walls, timeout: 1.5, required: false}]";
    if (value.getType() == XmlRpcValue::TypeString) {
      allowed +=
          "; a node's command line sets only strings and numbers, box_query.launch also lists";
    }
    refuse(name, value, allowed);
  }
  std::vector<TopicParameters> topics;
  std::vector<std::string> resolved;
  for (int i = 0; i < value.size(); ++i) {
    const std::string item = name + "[" + std::to_string(i) + "]";
    topics.push_back(readTopic(item, value[i]));
    const std::string topic = ros::names::resolve(topics.back().topic);
    if (std::find(resolved.begin(), resolved.end(), topic) != resolved.end()) {
      refuse(item, value[i], "another topic: " + topic + " is in the list already");
    }
    resolved.push_back(topic);
  }
  return topics;
}

}  // namespace

Parameters Parameters::fromValues(const XmlRpcValue& values, const std::string& ns,
                                  std::vector<std::string>& unknown) {
  Parameters parameters;
  if (!values.valid()) {
    return parameters;
  }
  if (values.getType() != XmlRpcValue::TypeStruct) {
    refuse(ns, values, "a namespace: it holds the parameters of the node");
  }
  for (const auto& [key, value] : values) {
    const std::string name = ns + "/" + key;
    const auto number =
        std::find_if(std::begin(kNumbers), std::end(kNumbers),
                     [&key = key](const Entry& entry) { return key == entry.name; });
    if (number != std::end(kNumbers)) {
      std::visit([&, &value = value](
                     auto member) { read(name, value, number->range, parameters.*member); },
                 number->member);
    } else if (key == "fixed_frame") {
      readFrame(name, value, parameters.fixed_frame);
    } else if (key == "box_topics") {
      parameters.box_topics = readTopics(name, value);
    } else {
      unknown.push_back(name);
    }
  }
  return parameters;
}

Parameters Parameters::fromRos(const ros::NodeHandle& private_nh) {
  XmlRpcValue values;
  private_nh.getParam(private_nh.getNamespace(), values);
  std::vector<std::string> unknown;
  Parameters parameters = fromValues(values, private_nh.getNamespace(), unknown);
  for (const std::string& name : unknown) {
    ROS_WARN_STREAM("parameter " << name
                                 << " is not known, and ignored: see box_query_node --help");
  }
  return parameters;
}

std::string Parameters::documentation() {
  const Parameters defaults;
  const TopicParameters topic;
  std::ostringstream out;
  out << std::boolalpha
      << "| parameter | type | default | range | meaning |\n|---|---|---|---|---|\n"
      << "| `~fixed_frame` | string | " << defaults.fixed_frame
      << " | | frame in which boxes are placed and queries answered |\n"
      << "| `~box_topics` | list | [" << defaults.box_topics.front().topic
      << "] | | topics of boxes: names, or structs of the four below |\n"
      << "| `topic` | string | | | name, relative or absolute |\n"
      << "| `timeout` | double | " << topic.timeout << " | " << print(kTopicTimeout)
      << " | ROS time without a message after which the topic is stale; 0: never |\n"
      << "| `required` | bool | " << topic.required
      << " | | whether a scene without this topic is incomplete |\n"
      << "| `drop_stale` | bool | " << topic.drop_stale
      << " | | whether the boxes of a stale topic are dropped, until sent again; else they stay "
         "|\n";
  for (const Entry& entry : kNumbers) {
    const bool is_int = std::holds_alternative<int Parameters::*>(entry.member);
    out << "| `~" << entry.name << "` | " << (is_int ? "int" : "double") << " | ";
    std::visit([&](auto member) { out << defaults.*member; }, entry.member);
    out << " | " << print(entry.range) << " | " << entry.meaning << " |\n";
  }
  return out.str();
}

}  // namespace box_query
