// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// All parameters of the node, with their defaults and units. Nothing else states a default; the
/// allowed ranges are in one table in parameters.cpp, which documentation() prints.
#pragma once

#include <string>
#include <vector>

namespace XmlRpc {  // NOLINT(readability-identifier-naming): not ours
class XmlRpcValue;
}
namespace ros {
class NodeHandle;
}

namespace box_query {

/// One topic of boxes. In ~box_topics either a struct with these fields or just the name.
struct TopicParameters {
  std::string topic = "boxes";
  /// [s] of ROS time without a message after which the topic is stale and the scene incomplete; 0:
  /// never.
  double timeout = 0.0;
  /// Whether a scene without this topic is incomplete.
  bool required = true;
  /// Whether its boxes are dropped when it becomes stale, until they are sent again; else they
  /// stay.
  bool drop_stale = false;
};

struct Parameters {
  /// Frame in which boxes are placed and queries answered.
  std::string fixed_frame = "map";
  std::vector<TopicParameters> box_topics = {TopicParameters()};

  /// [s] of wall time that a request waits for its transform.
  double transform_timeout = 0.2;
  /// [s] of wall time that a box waits for its transform before it is given up.
  double waiting_timeout = 10.0;
  /// Boxes that may wait at once; a message that would exceed it is placed as far as it can be, the
  /// rest counted.
  int max_waiting_boxes = 100000;
  /// [s] of transforms that the tf buffer keeps.
  double transform_history = 10.0;

  /// Boxes a message may carry; a larger message is refused whole.
  int max_boxes_per_message = 1000000;
  /// [MB] that messages of one topic take together while they wait to be taken in. Of more, which
  /// come faster than that, the oldest are dropped, the latest stays, and the scene is incomplete
  /// until the topic is cleared: by DELETEALL, a whole set, or new publishers.
  int max_backlog_memory = 100;
  /// Boxes and namespaces that a topic may have at once. What goes beyond is rejected, and the
  /// scene incomplete until the topic is cleared: by DELETEALL, a whole set, or new publishers.
  /// While publishers change, it has the boxes of both for a moment.
  int max_boxes_per_topic = 2000000;
  int max_namespaces = 100000;
  /// Rays or segments a request may carry; a larger request is refused.
  int max_queries_per_call = 1000000;
  /// [m] Largest magnitude of a coordinate, a size or a radius in messages and requests. Beyond,
  /// boxes are rejected and requests refused: float numbers, with which most boxes are passed over,
  /// do not tell boxes apart that far away.
  double max_coordinate = 1e7;
  /// Bytes of a namespace, a label, an id, a frame or a topic; a message or a request with a longer
  /// one is refused, since every box has its own.
  int max_name_length = 255;
  /// Names in each of the filters of a request; a request with more is refused.
  int max_filter_names = 10000;
  /// Threads that answer services.
  int service_threads = 2;
  /// Threads that work on one batch of rays or segments, shared by all; 0: as many as there are
  /// cores.
  int batch_threads = 0;

  /// [s] after the last query during which new scenes are built as boxes come; later they are built
  /// when asked for.
  double build_ahead = 2.0;
  /// Past snapshots that ~get_scene can still return.
  int kept_scenes = 100;
  /// Boxes in all of them together, some 300 bytes each; the oldest go first, the latest stays.
  int max_kept_boxes = 1000000;
  /// [s] of ROS time that past scenes are remembered for requests with a `scene_time`; 0: none are.
  double history = 0.0;
  /// Scenes that are remembered so, one a change; the oldest go first.
  int max_past_scenes = 1000;
  /// [MB] that they take together, about; the oldest go first, the latest stays.
  int max_history_memory = 1000;

  /// [Hz] at most at which ~markers is published.
  double marker_rate = 10.0;
  /// [s] that the markers of a query stay.
  double marker_lifetime = 5.0;
  /// Queries that are drawn at once, the latest ones.
  int max_marker_queries = 200;
  /// Boxes whose labels are drawn; 0: none.
  int max_marker_labels = 0;

  /// Reads every parameter that is set in the namespace of `private_nh`; the others keep their
  /// defaults. Warns of parameters that it does not know.
  /// @throws std::invalid_argument with the parameter's full name, its value and what is allowed.
  static Parameters fromRos(const ros::NodeHandle& private_nh);

  /// The same from `values`, which is what is set in the namespace `ns`: a struct, or invalid if
  /// there is nothing. Names that it does not know are appended to `unknown`.
  static Parameters fromValues(const XmlRpc::XmlRpcValue& values, const std::string& ns,
                               std::vector<std::string>& unknown);

  /// A table in Markdown: name, type, default, range with unit, and meaning of every parameter.
  static std::string documentation();
};

}  // namespace box_query
