// SPDX-License-Identifier: BSD-3-Clause
// ~markers of the real node, as rviz would receive them.
#include "rostest/server_fixture.h"

#include <map>
#include <mutex>

#include <ros/init.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>

namespace box_query::test {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

/// Listens to ~markers, and knows the last marker of every namespace.
class Viewer {
 public:
  Viewer()
      : subscriber_(ros::NodeHandle().subscribe<MarkerArray>(
            "/box_query/markers", 100, [this](const MarkerArray::ConstPtr& m) { receive(*m); })) {}

  bool sees(const std::string& ns) {
    return eventually([&] {
      const std::lock_guard<std::mutex> lock(mutex_);
      return last_.count(ns) > 0 && last_[ns].action == Marker::ADD;
    });
  }
  bool seesDeleted(const std::string& ns) {
    return eventually([&] {
      const std::lock_guard<std::mutex> lock(mutex_);
      return last_.count(ns) > 0 && last_[ns].action == Marker::DELETE;
    });
  }
  bool hasSeen(const std::string& ns) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return last_.count(ns) > 0;
  }
  Marker last(const std::string& ns) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return last_[ns];
  }
  std::vector<ros::WallTime> times() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return times_;
  }

 private:
  void receive(const MarkerArray& array) {
    const std::lock_guard<std::mutex> lock(mutex_);
    times_.push_back(ros::WallTime::now());
    for (const Marker& marker : array.markers) {
      last_[marker.ns] = marker;
    }
  }

  std::mutex mutex_;
  std::map<std::string, Marker> last_;
  std::vector<ros::WallTime> times_;
  ros::Subscriber subscriber_;
};

class Markers : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(boxes_.isHeard() && walls_.isHeard());
    boxes_.say(array({cube("map", 1, 5), cube("map", 2, 8)}));
    walls_.say(array({cube("map", 1, 0, 20)}));
    ASSERT_TRUE(nodeHas(3));
  }
  void TearDown() override {
    boxes_.say(array({withAction(cube("map", 0, 0), Marker::DELETEALL)}));
    walls_.say(array({withAction(cube("map", 0, 0), Marker::DELETEALL)}));
    ASSERT_TRUE(nodeHas(0));
  }

  const CastRayRequest along_x_ = ray("map", point(0, 0, 0), vector(1, 0, 0));
  ArrayTalker boxes_{"boxes"};
  ArrayTalker walls_{"walls"};
};

TEST_F(Markers, OfQueriesAreDrawnOnlyWhileSomebodyLooks) {
  ASSERT_TRUE(cast(along_x_).hit);
  Viewer viewer;
  ASSERT_TRUE(viewer.sees("boxes//boxes")) << "a new subscriber gets the boxes at once";
  ASSERT_TRUE(viewer.sees("edges//walls"));
  EXPECT_EQ(viewer.last("boxes//boxes").points.size(), 2U * 36);
  EXPECT_EQ(viewer.last("boxes//boxes").header.frame_id, "map");
  // A segment is asked after the ray: if the ray had been kept, it would come not later.
  CheckSegmentRequest segment;
  segment.header.frame_id = "map";
  segment.end.y = 3;
  ASSERT_TRUE(eventually([&] {
    checkSegment(segment);
    return viewer.hasSeen("segments");
  }));
  EXPECT_FALSE(viewer.hasSeen("rays")) << "nobody looked when it was cast";
  EXPECT_TRUE(viewer.sees("closest_points"));

  ASSERT_TRUE(cast(along_x_).hit);
  ASSERT_TRUE(viewer.sees("rays"));
  const Marker rays = viewer.last("rays");
  ASSERT_EQ(rays.points.size(), 2U);
  EXPECT_EQ(rays.points[1], point(4.5, 0, 0));
  EXPECT_GT(rays.colors[0].r, rays.colors[0].g);
  EXPECT_EQ(rays.lifetime, ros::Duration(2.5));
  EXPECT_TRUE(viewer.hasSeen("hits") && viewer.hasSeen("normals"));
}

TEST_F(Markers, OfABatchAreBounded) {
  Viewer viewer;
  ASSERT_TRUE(viewer.sees("boxes//boxes"));
  CastRaysRequest request;
  request.header.frame_id = "map";
  request.origins.resize(1);
  request.directions.assign(500, vector(0, 0, 1));
  ASSERT_TRUE(eventually([&] {
    call<CastRays>("cast_rays", request);
    return viewer.hasSeen("rays");
  }));
  EXPECT_EQ(viewer.last("rays").points.size(), 2U * 10);
}

TEST_F(Markers, FollowTheBoxesAtMostAtTheirRate) {
  Viewer viewer;
  ASSERT_TRUE(viewer.sees("boxes//walls"));
  for (int i = 0; i < 100; ++i) {
    boxes_.say(array({cube("map", 1, 5 + 0.01 * i)}));
    ros::WallDuration(0.01).sleep();
  }
  walls_.say(array({withAction(cube("map", 0, 0), Marker::DELETEALL)}));
  ASSERT_TRUE(viewer.seesDeleted("boxes//walls"));
  ASSERT_TRUE(viewer.seesDeleted("edges//walls"));
  EXPECT_EQ(viewer.last("boxes//boxes").action, Marker::ADD);
  // The one for a new subscriber comes besides.
  const std::vector<ros::WallTime> times = viewer.times();
  const double span = (times.back() - times.front()).toSec();
  EXPECT_GE(times.size(), 4U);
  EXPECT_LE(static_cast<double>(times.size()), span * 5 + 3);
}

TEST_F(Markers, TellWhatWaitsAndWhatIsStale) {
  Viewer viewer;
  ASSERT_TRUE(viewer.sees("edges//boxes"));
  boxes_.say(array({cube("nowhere", 1, 6)}));
  ASSERT_TRUE(viewer.sees("waiting//boxes")) << "box 1, where it was";
  ASSERT_TRUE(viewer.sees("status"));
  EXPECT_EQ(viewer.last("status").text, "/boxes: 1 waiting for tf");
  ASSERT_TRUE(eventually([&] { return viewer.last("boxes//boxes").points.size() == 36; }));
  boxes_.say(array({cube("map", 1, 6)}));
  ASSERT_TRUE(viewer.seesDeleted("waiting//boxes"));
  ASSERT_TRUE(viewer.seesDeleted("status"));

  ArrayTalker fades("fades");
  ASSERT_TRUE(fades.isHeard());
  ASSERT_TRUE(eventually([&] {  // until it is seen: on a busy machine it may be stale before
    fades.say(array({cube("map", 1, 30)}));
    ros::WallDuration(0.1).sleep();
    return viewer.hasSeen("boxes//fades");
  }));
  ASSERT_TRUE(viewer.sees("stale//fades")) << "nothing has changed but the time";
  ASSERT_TRUE(viewer.seesDeleted("boxes//fades"));
  EXPECT_EQ(viewer.last("labels//fades").text, "test/1");
  fades.say(array({withAction(cube("map", 0, 0), Marker::DELETEALL)}));
  ASSERT_TRUE(viewer.seesDeleted("stale//fades"));
  ASSERT_TRUE(viewer.seesDeleted("labels//fades"));
}

TEST_F(Markers, AreSentAgainToAViewerThatComesBack) {
  for (int visit = 0; visit < 3; ++visit) {
    Viewer viewer;
    EXPECT_TRUE(viewer.sees("boxes//walls")) << visit;
  }
}

}  // namespace
}  // namespace box_query::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_markers");
  ros::AsyncSpinner spinner(1);
  const ros::NodeHandle keeps_ros_alive;
  spinner.start();
  return RUN_ALL_TESTS();
}
