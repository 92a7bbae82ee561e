// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Publishes boxes of a CSV file as a visualization_msgs/MarkerArray on `boxes`, latched. README.md
/// describes its parameters.
#include "ros/box_csv.h"
#include "ros/conversions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <locale>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <visualization_msgs/MarkerArray.h>

namespace box_query {
namespace {

/// The parameter, or `otherwise` if it is not set.
template <typename T>
T parameter(const ros::NodeHandle& private_nh, const std::string& name, const std::string& type,
            T otherwise) {
  T value;
  if (private_nh.getParam(name, value)) {
    return value;
  }
  if (private_nh.hasParam(name)) {
    throw std::invalid_argument("parameter " + private_nh.resolveName(name) + " must be " + type);
  }
  return otherwise;
}

std::string join(const std::set<std::string>& names) {
  constexpr std::size_t kMost = 10;
  std::string list;
  for (auto name = names.begin(); name != std::next(names.begin(), std::min(kMost, names.size()));
       ++name) {
    list += (list.empty() ? "" : ", ") + *name;
  }
  return names.size() > kMost ? list + ", ..." : list;
}

/// The frames of the scene that the parameters choose, in the order of the file.
std::vector<CsvScene> chooseFrames(const ros::NodeHandle& private_nh) {
  const auto file = parameter<std::string>(private_nh, "file", "a path", "");
  if (file.empty()) {
    throw std::invalid_argument("no file: set parameter " + private_nh.resolveName("file") +
                                " to the path of a CSV file of boxes");
  }
  std::vector<CsvScene> frames = readBoxCsvFile(file);
  std::set<std::string> names;
  for (const CsvScene& frame : frames) {
    names.insert(frame.scene);
  }
  auto scene = parameter<std::string>(private_nh, "scene", "a string", "");
  if (scene.empty() && names.size() == 1) {
    scene = *names.begin();
  }
  if (names.empty()) {
    throw std::invalid_argument(file + " has no boxes");
  }
  if (names.count(scene) == 0) {
    throw std::invalid_argument(
        (scene.empty() ? file + " has several scenes" : file + " has no scene '" + scene + "'") +
        ": set parameter " + private_nh.resolveName("scene") + " to one of " + join(names));
  }
  const auto is_other = [&](const CsvScene& frame) { return frame.scene != scene; };
  frames.erase(std::remove_if(frames.begin(), frames.end(), is_other), frames.end());

  if (private_nh.hasParam("stamp")) {
    const auto stamp = parameter<double>(private_nh, "stamp", "a number", 0.0);
    const auto is_another = [&](const CsvScene& frame) { return frame.stamp != stamp; };
    frames.erase(std::remove_if(frames.begin(), frames.end(), is_another), frames.end());
    if (frames.empty()) {
      throw std::invalid_argument(file + " has no stamp " + std::to_string(stamp) + " in scene '" +
                                  scene + "': change parameter " + private_nh.resolveName("stamp"));
    }
  }
  const auto frame_id = parameter<std::string>(private_nh, "frame_id", "the name of a frame", "");
  if (!frame_id.empty()) {
    for (CsvScene& frame : frames) {
      for (CsvBox& box : frame.boxes) {
        box.frame_id = frame_id;
      }
    }
  }
  return frames;
}

/// Turns one frame after the other into a message of changes.
class MarkerWriter {
 public:
  visualization_msgs::MarkerArray next(const CsvScene& frame, const ros::Time& stamp) {
    visualization_msgs::MarkerArray message;
    std::map<Key, std::string> shown;
    for (const CsvBox& box : frame.boxes) {
      visualization_msgs::Marker marker = identified(box.box_class, idOf(box), box.frame_id, stamp);
      marker.action = visualization_msgs::Marker::ADD;
      marker.text = box.id;
      marker.pose = toPose(box.center, box.orientation);
      marker.scale = toVector3(box.size);
      marker.color = colorOf(box.box_class);
      message.markers.push_back(marker);
      shown.emplace(Key(marker.ns, marker.id), box.frame_id);
    }
    for (const auto& [key, frame_id] : shown_) {
      if (shown.count(key) == 0) {
        message.markers.push_back(identified(key.first, key.second, frame_id, stamp));
        message.markers.back().action = visualization_msgs::Marker::DELETE;
      }
    }
    shown_ = std::move(shown);
    return message;
  }

 private:
  using Key = std::pair<std::string, std::int32_t>;  ///< ns and id of a marker

  static visualization_msgs::Marker identified(const std::string& ns, std::int32_t id,
                                               const std::string& frame_id,
                                               const ros::Time& stamp) {
    visualization_msgs::Marker marker;
    marker.header.frame_id = frame_id;
    marker.header.stamp = stamp;
    marker.ns = ns;
    marker.id = id;
    marker.type = visualization_msgs::Marker::CUBE;
    marker.pose.orientation.w = 1.0;
    return marker;
  }

  /// Boxes of a class are numbered as they appear first, and keep their numbers.
  std::int32_t idOf(const CsvBox& box) {
    auto& ids = ids_[box.box_class];
    return ids.emplace(box.id, static_cast<std::int32_t>(ids.size())).first->second;
  }

  /// A color for each class, in the order of first appearance; after the last one the first again.
  std_msgs::ColorRGBA colorOf(const std::string& box_class) {
    static constexpr std::array<std::array<float, 3>, 8> kColors = {{{0.18F, 0.38F, 0.70F},
                                                                     {0.90F, 0.47F, 0.13F},
                                                                     {0.50F, 0.36F, 0.22F},
                                                                     {0.80F, 0.66F, 0.46F},
                                                                     {0.20F, 0.58F, 0.55F},
                                                                     {0.55F, 0.58F, 0.62F},
                                                                     {0.93F, 0.76F, 0.20F},
                                                                     {0.75F, 0.25F, 0.28F}}};
    const std::size_t index = colors_.emplace(box_class, colors_.size()).first->second;
    const auto& rgb = kColors[index % kColors.size()];
    std_msgs::ColorRGBA color;
    color.r = rgb[0];
    color.g = rgb[1];
    color.b = rgb[2];
    color.a = 1.0F;
    return color;
  }

  std::map<std::string, std::map<std::string, std::int32_t>> ids_;
  std::map<std::string, std::size_t> colors_;
  std::map<Key, std::string> shown_;  ///< with their frames, after the last message
};

/// The same for rviz, which puts a warning on a display of cubes with a text.
visualization_msgs::MarkerArray withoutLabels(visualization_msgs::MarkerArray message) {
  for (visualization_msgs::Marker& marker : message.markers) {
    marker.text.clear();
  }
  return message;
}

/// The transform of ~tf_parent and ~tf_pose to the one frame of all boxes, if they ask for one.
std::vector<geometry_msgs::TransformStamped> chooseTransform(const ros::NodeHandle& private_nh,
                                                             const std::vector<CsvScene>& frames) {
  const auto parent = parameter<std::string>(private_nh, "tf_parent", "the name of a frame", "");
  if (parent.empty()) {
    return {};
  }
  const std::string name = private_nh.resolveName("tf_pose");
  const std::string type = "'x y z qx qy qz qw': a position [m] and a unit quaternion";
  std::istringstream text(parameter<std::string>(private_nh, "tf_pose", type, ""));
  text.imbue(std::locale::classic());
  const std::vector<double> pose{std::istream_iterator<double>(text), {}};
  constexpr double kTolerance = 1e-2;
  if (pose.size() != 7 || !text.eof() ||
      !(std::abs(Eigen::Map<const Eigen::Vector4d>(&pose[3]).norm() - 1.0) <= kTolerance)) {
    throw std::invalid_argument("parameter " + name + " must be " + type);
  }
  std::set<std::string> children;
  for (const CsvScene& frame : frames) {
    for (const CsvBox& box : frame.boxes) {
      children.insert(box.frame_id);
    }
  }
  if (children.size() != 1 || *children.begin() == parent) {
    throw std::invalid_argument("parameter " + private_nh.resolveName("tf_parent") + " is " +
                                parent + ": it needs boxes in one other frame, but they are in " +
                                join(children));
  }
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time::now();
  transform.header.frame_id = parent;
  transform.child_frame_id = *children.begin();
  transform.transform.translation.x = pose[0];
  transform.transform.translation.y = pose[1];
  transform.transform.translation.z = pose[2];
  transform.transform.rotation.x = pose[3];
  transform.transform.rotation.y = pose[4];
  transform.transform.rotation.z = pose[5];
  transform.transform.rotation.w = pose[6];
  return {transform};
}

void publishBoxes() {
  ros::NodeHandle nh;
  ros::NodeHandle private_nh("~");
  const std::vector<CsvScene> frames = chooseFrames(private_nh);
  const auto transforms = chooseTransform(private_nh, frames);
  const bool loop = parameter<bool>(private_nh, "loop", "true or false", false);
  const auto hertz = parameter<double>(private_nh, "rate", "a number", 10.0);
  if (!(hertz >= 0.001 && hertz <= 1000.0)) {
    throw std::invalid_argument("parameter " + private_nh.resolveName("rate") + " is " +
                                std::to_string(hertz) + "; it must be 0.001 to 1000 [Hz]");
  }

  tf2_ros::StaticTransformBroadcaster broadcaster;
  if (!transforms.empty()) {
    broadcaster.sendTransform(transforms);
  }
  ros::Publisher publisher = nh.advertise<visualization_msgs::MarkerArray>("boxes", 10, true);
  ros::Publisher unlabelled =
      private_nh.advertise<visualization_msgs::MarkerArray>("markers", 10, true);
  MarkerWriter writer;
  ros::Rate rate(hertz);
  for (std::size_t i = 0; ros::ok() && i < frames.size();) {
    const visualization_msgs::MarkerArray message = writer.next(frames[i], ros::Time::now());
    publisher.publish(message);
    unlabelled.publish(withoutLabels(message));
    ++i;
    if (loop && frames.size() > 1) {
      i %= frames.size();
    }
    if (i < frames.size()) {
      ros::spinOnce();
      rate.sleep();
    }
  }
  ros::spin();  // the last frame stays, latched
}

}  // namespace
}  // namespace box_query

int main(int argc, char** argv) {
  ros::init(argc, argv, "publish_boxes");
  ros::NodeHandle nh;
  try {
    box_query::publishBoxes();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}
