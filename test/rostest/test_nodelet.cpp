// SPDX-License-Identifier: BSD-3-Clause
// How the nodelet comes into a manager and leaves it. What it answers is tested by
// nodelet_server.test and nodelet_markers.test.
#include "rostest/long_batch.h"
#include "rostest/server_fixture.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <string>
#include <vector>

#include <nodelet/NodeletList.h>
#include <nodelet/NodeletLoad.h>
#include <nodelet/NodeletUnload.h>
#include <ros/init.h>
#include <ros/param.h>

namespace box_query::test {
namespace {

/// Calls a service of the manager. @return whether that answered, within 20 s.
template <class Service>
bool callManager(const std::string& name, Service& service) {
  auto answered = std::async(std::launch::async, [&] {
    ros::service::waitForService("/manager/" + name, ros::Duration(10));
    return ros::service::call("/manager/" + name, service);
  });
  if (answered.wait_for(std::chrono::seconds(20)) != std::future_status::ready) {
    ADD_FAILURE() << "the manager hangs";
    std::_Exit(1);  // what waits for it would hang too
  }
  return answered.get();
}

bool load(const std::string& name) {
  nodelet::NodeletLoad service;
  service.request.name = name;
  service.request.type = "box_query/BoxQuery";
  return callManager("load_nodelet", service) && service.response.success;
}

bool unload(const std::string& name) {
  nodelet::NodeletUnload service;
  service.request.name = name;
  return callManager("unload_nodelet", service) && service.response.success;
}

bool isLoaded(const std::string& name) {
  nodelet::NodeletList service;
  EXPECT_TRUE(callManager("list", service));
  const std::vector<std::string>& names = service.response.nodelets;
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Asks until it is told to stop; a call may fail, since the nodelet comes and goes.
class Client {
 public:
  explicit Client(std::size_t rays)
      : done_(std::async(std::launch::async, [this, rays] {
          CastRays service;
          service.request.header.frame_id = "map";
          service.request.allow_incomplete = true;
          service.request.origins.resize(1);
          service.request.directions.assign(rays, vector(1, 0, 0));
          while (!stop_) {
            if (ros::service::call("/box_query/cast_rays", service)) {
              answers_ += service.response.success;
              hits_ += service.response.success && service.response.hits[0];
            }
          }
        })) {}
  ~Client() {
    stop_ = true;
    done_.wait();
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  int answers() const { return answers_; }
  int hits() const { return hits_; }

 private:
  std::atomic<bool> stop_{false};
  std::atomic<int> answers_{0};
  std::atomic<int> hits_{0};
  std::future<void> done_;
};

TEST(Nodelet, IsLaunchedIntoAManager) {
  ASSERT_TRUE(eventually([] { return isLoaded("/launched"); }));
  GetScene scene;
  ASSERT_TRUE(ros::service::call("/launched/get_scene", scene) ||
              ros::service::call("/launched/get_scene", scene));
  EXPECT_EQ(scene.response.header.frame_id, "odom");
  EXPECT_NE(scene.response.reason.find("/carts"), std::string::npos) << scene.response.reason;
}

TEST(Nodelet, KnowsTopicsByTheirNamesInItsNamespace) {
  ArrayTalker talker("/robot/boxes");
  ASSERT_TRUE(talker.isHeard());
  talker.say(array({cube("map", 1, 5)}));
  CastRay service;
  service.request = ray("map", point(0, 0, 0), vector(1, 0, 0));
  service.request.topics = {"boxes"};
  ASSERT_TRUE(eventually([&] {
    return ros::service::call("/robot/box_query/cast_ray", service) && service.response.complete;
  }));
  EXPECT_TRUE(service.response.hit);
  EXPECT_EQ(service.response.box_topic, "/robot/boxes");
  EXPECT_EQ(service.response.message, "");
  service.request.topics.clear();
  service.request.ignore_topics = {"boxes"};
  ASSERT_TRUE(ros::service::call("/robot/box_query/cast_ray", service) ||
              ros::service::call("/robot/box_query/cast_ray", service));
  EXPECT_FALSE(service.response.hit);
}

TEST(Nodelet, LeavesWhileItIsAsked) {
  ArrayTalker talker("boxes");
  const Client few(1);
  const Client many(20000);
  for (int visit = 0; visit < 8; ++visit) {
    const int hits_few = few.hits();
    const int hits_many = many.hits();
    ASSERT_TRUE(load("/box_query"));
    ASSERT_TRUE(talker.isHeard());
    talker.say(randomBoxes(1));
    talker.say(array({cube("map", 100, 5)}));
    ASSERT_TRUE(eventually([&] {
      return few.hits() > hits_few + visit && many.hits() > hits_many;
    })) << "visit "
        << visit;
    ASSERT_TRUE(unload("/box_query")) << "visit " << visit;
    EXPECT_FALSE(isLoaded("/box_query"));
    EXPECT_FALSE(ros::service::exists("/box_query/cast_rays", false)) << "still registered";
  }
  EXPECT_GT(few.answers(), 8);
}

TEST(Nodelet, DoesNotFinishABatchOfMinutes) {
  ASSERT_TRUE(load("/box_query"));
  ArrayTalker talker("boxes");
  ASSERT_TRUE(talker.isHeard());
  const visualization_msgs::Marker boxes = boxesOfLongBatch();
  talker.say(array({boxes}));
  ASSERT_TRUE(nodeHas(boxes.points.size()));

  CastRays batch = longBatch();
  auto answered = std::async(std::launch::async,
                             [&] { return ros::service::call("/box_query/cast_rays", batch); });
  ASSERT_EQ(answered.wait_for(std::chrono::seconds(2)), std::future_status::timeout);
  EXPECT_TRUE(unload("/box_query"));
  ASSERT_EQ(answered.wait_for(std::chrono::seconds(10)), std::future_status::ready);
  EXPECT_FALSE(answered.get() && batch.response.success);
}

TEST(Nodelet, IsRefusedWithAWrongParameterAndTheManagerGoesOn) {
  ros::param::set("/wrong/marker_rate", 1000);
  EXPECT_FALSE(load("/wrong"));
  EXPECT_FALSE(isLoaded("/wrong"));
  EXPECT_TRUE(load("/right"));
  EXPECT_TRUE(ros::service::exists("/right/cast_ray", false));
  EXPECT_TRUE(unload("/right"));
}

}  // namespace
}  // namespace box_query::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_nodelet");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
