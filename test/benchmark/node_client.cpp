// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/node_client.h"

#include "ros/conversions.h"

namespace box_query::benchmark {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

MarkerArray markersOf(const std::vector<OrientedBox>& boxes) {
  MarkerArray array;
  for (const OrientedBox& box : boxes) {
    Marker marker;
    marker.header.frame_id = kFrame;
    marker.ns = "pallets";
    marker.id = static_cast<std::int32_t>(array.markers.size());
    marker.type = Marker::CUBE;
    marker.text = "pallet";
    marker.pose = toPose(box.center, box.orientation);
    marker.scale = toVector3(2.0 * box.half_extents);
    array.markers.push_back(marker);
  }
  return array;
}

void setStamps(const ros::Time& stamp, MarkerArray& array) {
  for (Marker& marker : array.markers) {
    marker.header.stamp = stamp;
  }
}

BoxesTopic::BoxesTopic(ros::NodeHandle& nh, const std::string& name)
    : publisher_(nh.advertise<RawMarkerArray>(name, 0)) {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(30.0);
  while (publisher_.getNumSubscribers() == 0) {
    if (ros::WallTime::now() > deadline) {
      throw std::runtime_error("nobody listens to " + name);
    }
    ros::WallDuration(0.01).sleep();
  }
}

void BoxesTopic::clear() const {
  Marker all;
  all.header.frame_id = kFrame;
  all.header.stamp = ros::Time::now();
  all.action = Marker::DELETEALL;
  MarkerArray array;
  array.markers.push_back(all);
  publish(RawMarkerArray::of(array));
}

}  // namespace box_query::benchmark
