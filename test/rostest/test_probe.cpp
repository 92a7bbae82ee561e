// SPDX-License-Identifier: BSD-3-Clause
// The probe, dragged as rviz drags: through the feedback topic of its handles.
#include "rostest/server_fixture.h"

#include <map>
#include <mutex>
#include <string>

#include <ros/init.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>
#include <visualization_msgs/InteractiveMarkerFeedback.h>
#include <visualization_msgs/InteractiveMarkerUpdate.h>

namespace box_query::test {
namespace {

using visualization_msgs::InteractiveMarkerFeedback;
using visualization_msgs::InteractiveMarkerUpdate;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

class ProbeViewer {
 public:
  ProbeViewer() {
    answers_ = node_.subscribe<MarkerArray>("/box_query_probe/answers", 100,
                                            [this](const MarkerArray::ConstPtr& array) {
                                              const std::lock_guard<std::mutex> lock(mutex_);
                                              for (const Marker& marker : array->markers) {
                                                last_[marker.ns] = marker;
                                              }
                                            });
    updates_ = node_.subscribe<InteractiveMarkerUpdate>(
        "/box_query_probe/update", 100, [this](const InteractiveMarkerUpdate::ConstPtr& update) {
          const std::lock_guard<std::mutex> lock(mutex_);
          for (const auto& pose : update->poses) {
            handles_[pose.name] = pose.pose.position;
          }
        });
    feedback_ = node_.advertise<InteractiveMarkerFeedback>("/box_query_probe/feedback", 100);
  }

  bool isHeard() {
    return eventually([this] {
      return feedback_.getNumSubscribers() > 0 && answers_.getNumPublishers() > 0 &&
             updates_.getNumPublishers() > 0;
    });
  }

  void drag(const std::string& handle, const geometry_msgs::Point& to) {
    InteractiveMarkerFeedback feedback;
    feedback.header.frame_id = "map";
    feedback.client_id = "test";
    feedback.marker_name = handle;
    feedback.control_name = "ball";
    feedback.event_type = InteractiveMarkerFeedback::POSE_UPDATE;
    feedback.pose.position = to;
    feedback.pose.orientation.w = 1;
    feedback_.publish(feedback);
  }

  /// The last marker of a namespace.
  Marker last(const std::string& ns) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return last_[ns];
  }
  bool shows(const std::string& ns, const std::vector<geometry_msgs::Point>& points) {
    return eventually([&] {
      const Marker marker = last(ns);
      return marker.action == Marker::ADD && marker.points == points;
    });
  }
  bool says(const std::string& ns, const std::string& words) {
    return eventually([&] { return last(ns).text == words; });
  }
  bool hides(const std::string& ns) {
    return eventually([&] { return last(ns).action == Marker::DELETE; });
  }
  geometry_msgs::Point handle(const std::string& name) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return handles_[name];
  }

 private:
  ros::NodeHandle node_;
  std::mutex mutex_;
  std::map<std::string, Marker> last_;
  std::map<std::string, geometry_msgs::Point> handles_;
  ros::Subscriber answers_;
  ros::Subscriber updates_;
  ros::Publisher feedback_;
};

class Probe : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(boxes_.isHeard() && viewer_.isHeard());
    visualization_msgs::Marker crate = cube("map", 1, 5);
    crate.text = "a crate";
    boxes_.say(array({crate, cube("map", 2, 0, 8)}));
    ASSERT_TRUE(nodeHas(2));
  }

  ArrayTalker boxes_{"boxes"};
  ProbeViewer viewer_;
};

TEST_F(Probe, ShowsWhereADraggedRayHits) {
  viewer_.drag("ray_origin", point(1, 0, 0.25));
  viewer_.drag("ray_target", point(2, 0, 0.25));
  ASSERT_TRUE(viewer_.shows("rays", {point(1, 0, 0.25), point(4.5, 0, 0.25)}));
  EXPECT_TRUE(viewer_.shows("hits", {point(4.5, 0, 0.25)}));
  EXPECT_TRUE(viewer_.shows("normals", {point(4.5, 0, 0.25), point(4.5 - 0.3, 0, 0.25)}));
  EXPECT_TRUE(viewer_.says("ray_text", "range 3.500 m, a crate"));
  EXPECT_EQ(viewer_.handle("ray_target"), point(2, 0, 0.25)) << "other viewers see it move";

  viewer_.drag("ray_target", point(1, 4, 0.25));
  ASSERT_TRUE(viewer_.shows("rays", {point(1, 0, 0.25), point(1, 30, 0.25)}));
  EXPECT_TRUE(viewer_.hides("hits"));
  EXPECT_TRUE(viewer_.hides("normals"));
  EXPECT_TRUE(viewer_.says("ray_text", "hits nothing"));
}

TEST_F(Probe, ShowsHowClearADraggedSegmentIs) {
  viewer_.drag("segment_start", point(-1, 6, 0));
  viewer_.drag("segment_end", point(0.25, 6, 0));
  ASSERT_TRUE(viewer_.shows("segments", {point(-1, 6, 0), point(0.25, 6, 0)}));
  ASSERT_TRUE(eventually([&] { return viewer_.last("closest_points").points.size() == 2; }));
  EXPECT_EQ(viewer_.last("closest_points").points[0].y, 6);
  EXPECT_EQ(viewer_.last("closest_points").points[1].y, 7.5);
  EXPECT_TRUE(viewer_.says("segment_text", "clearance 1.500 m, test/2"));
  Marker segment = viewer_.last("segments");
  EXPECT_GT(segment.colors.at(0).g, segment.colors.at(0).r) << "clear";

  viewer_.drag("segment_end", point(0, 7.3, 0));
  ASSERT_TRUE(viewer_.shows("segments", {point(-1, 6, 0), point(0, 7.3, 0)}));
  segment = viewer_.last("segments");
  EXPECT_GT(segment.colors.at(0).r, segment.colors.at(0).g) << "within the radius of 0.25";
  EXPECT_TRUE(viewer_.says("segment_text", "clearance 0.200 m, test/2"));
}

TEST_F(Probe, FollowsBoxesThatMove) {
  viewer_.drag("ray_origin", point(1, 0, 0.25));
  viewer_.drag("ray_target", point(2, 0, 0.25));
  ASSERT_TRUE(viewer_.shows("hits", {point(4.5, 0, 0.25)}));
  boxes_.say(array({cube("map", 1, 7)}));
  EXPECT_TRUE(viewer_.shows("hits", {point(6.5, 0, 0.25)}));
}

TEST_F(Probe, SaysWhyThereIsNoAnswer) {
  viewer_.drag("ray_origin", point(1, 0, 0));
  viewer_.drag("ray_target", point(1, 0, 0));
  ASSERT_TRUE(eventually(
      [&] { return viewer_.last("problem").text.find("direction") != std::string::npos; }));
  EXPECT_TRUE(viewer_.hides("ray_text"));
  viewer_.drag("ray_target", point(2, 0, 0));
  EXPECT_TRUE(viewer_.hides("problem"));
}

}  // namespace
}  // namespace box_query::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_probe");
  ros::AsyncSpinner spinner(1);
  const ros::NodeHandle keeps_ros_alive;
  spinner.start();
  return RUN_ALL_TESTS();
}
