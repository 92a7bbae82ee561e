// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Uses the core, the SceneMonitor and a service of box_query.
#include <box_query/CastRay.h>
#include <box_query/distance.h>
#include <box_query/intersection.h>
#include <box_query/ros/scene_monitor.h>
#include <box_query/scene.h>

#include <iostream>

#include <ros/ros.h>

int main(int argc, char** argv) {
  const box_query::Scene scene({box_query::AlignedBox{{1, -1, -1}, {2, 1, 1}}});
  const double range = scene.cast(box_query::Ray{{0, 0, 0}, {2, 0, 0}}).range;

  ros::init(argc, argv, "box_query_user");
  const ros::NodeHandle nh;
  const box_query::SceneMonitor monitor(nh, box_query::Parameters());
  const bool complete = monitor.scene()->completeness(ros::Time::now()).complete;

  const box_query::CastRay::Request request;
  std::cout << range << " " << complete << " " << request.max_range << "\n";
  return range == 1.0 && !complete ? 0 : 1;
}
