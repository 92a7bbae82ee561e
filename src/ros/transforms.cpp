// SPDX-License-Identifier: BSD-3-Clause
#include "ros/transforms.h"

#include "ros/box_source.h"

#include <algorithm>
#include <chrono>
#include <sstream>

#include <ros/init.h>
#include <tf2/exceptions.h>

namespace box_query {
namespace {

std::string missing(const std::string& target, const std::string& source, const ros::Time& stamp,
                    double timeout, const std::string& error) {
  std::ostringstream text;
  text << "No transform from frame '" << source << "' to '" << target << "' ";
  if (stamp.isZero()) {
    text << "came";
  } else {
    text << "at time " << stamp << " came";
  }
  text << " within " << timeout << " s";
  if (!error.empty()) {
    text << " (" << error << ")";
  }
  text << ": publish it on /tf or /tf_static, or correct the frame or the stamp.";
  return text.str();
}

}  // namespace

Transforms::Transforms(const ros::NodeHandle& nh, const ros::Duration& history,
                       std::function<void()> changed)
    : buffer_(history), listener_(buffer_, nh) {
  buffer_._addTransformsChangedListener([this, changed = std::move(changed)] {
    bell_.ring();
    changed();
  });
}

std::string Transforms::lookUp(const std::string& target_frame, const std::string& source_frame,
                               const ros::Time& stamp, double timeout,
                               geometry_msgs::TransformStamped& transform) {
  const std::string target(stripSlash(target_frame));
  const std::string source(stripSlash(source_frame));
  for (const std::string& frame : {target, source}) {
    if (frame.empty() || frame.front() == '/') {
      return "'" + frame + "' is no frame: name the frame in header.frame_id.";
    }
  }
  transform = geometry_msgs::TransformStamped();
  if (target == source) {  // tf2 would say the same, even of a frame that nobody knows
    transform.header.frame_id = target;
    transform.header.stamp = stamp;
    transform.child_frame_id = source;
    transform.transform.rotation.w = 1.0;
    return "";
  }
  // Paused and simulated clocks make tf2_ros' own waiting hang.
  using Clock = Bell::Clock;
  const Clock::time_point deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(std::min(std::max(timeout, 0.0), 3600.0)));
  for (;;) {
    const std::uint64_t rings = bell_.rings();
    std::string error;
    if (buffer_.canTransform(target, source, stamp, &error)) {
      try {
        transform = buffer_.lookupTransform(target, source, stamp);
        return "";
      } catch (const tf2::TransformException& gone) {
        error = gone.what();
      }
    }
    const Clock::time_point now = Clock::now();
    if (now >= deadline || !ros::ok()) {
      return missing(target, source, stamp, timeout, error);
    }
    bell_.waitPast(rings, std::min(deadline, now + std::chrono::milliseconds(100)));
  }
}

}  // namespace box_query
