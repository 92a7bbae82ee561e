// SPDX-License-Identifier: BSD-3-Clause
// What publishers do to a topic: they come late, fall silent, restart, send another type or bytes
// that are no message.
#include "rostest/monitor_fixture.h"
#include "rostest/raw_message.h"

#include <atomic>
#include <stdexcept>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <ros/init.h>
#include <ros/master.h>
#include <std_msgs/String.h>
#include <sys/socket.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace box_query {
namespace {

/// Calls the master in the name of another node, with its own name, a topic and so on.
void tellMaster(const std::string& method, const std::vector<std::string>& arguments) {
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue payload;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    request[static_cast<int>(i)] = arguments[i];
  }
  EXPECT_TRUE(ros::master::execute(method, request, response, payload, false)) << method;
}

/// Where something listens, so that it counts as a node that is there, and never answers.
class Address {
 public:
  Address() : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in any = {};
    any.sin_family = AF_INET;
    any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(any);
    auto* const address = reinterpret_cast<sockaddr*>(&any);
    EXPECT_EQ(bind(socket_, address, size), 0);
    EXPECT_EQ(listen(socket_, 5), 0);
    EXPECT_EQ(getsockname(socket_, address, &size), 0);
    name = "http://127.0.0.1:" + std::to_string(ntohs(any.sin_port)) + "/";
  }
  ~Address() { close(socket_); }
  Address(const Address&) = delete;
  Address& operator=(const Address&) = delete;

  std::string name;

 private:
  const int socket_;
};

TEST_F(MonitorOfOneTopic, NeedsNoWordIfItIsNotRequired) {
  parameters_.box_topics[0].required = false;
  listen();
  EXPECT_TRUE(completenessOf(*monitor_).complete);
}

TEST(SceneMonitor, RefusesToListenTwiceToATopic) {
  EXPECT_THROW(SceneMonitor(ros::NodeHandle(), listenTo({"twice", "/twice"})),
               std::invalid_argument);
}

TEST_F(MonitorOfOneTopic, GoesStaleAndRecovers) {
  parameters_.box_topics[0].timeout = 1.0;
  start();
  say({cube("map", 1, 1.0)});
  ASSERT_TRUE(becomes(true));
  ASSERT_TRUE(becomes(false));
  expectReason({topic_ + " is stale"});
  say({});
  EXPECT_TRUE(becomes(true)) << "an empty message is a sign of life";
  EXPECT_EQ(contents(*monitor_->currentScene()), "1:1 ");
}

TEST_F(MonitorOfOneTopic, HearsARestartedPublisher) {
  listen();
  for (const double x : {1.0, 2.0}) {
    ArrayTalker talker(topic_);
    ASSERT_TRUE(talker.isHeard());
    talker.say(array({cube("map", 1, x)}));
    ASSERT_TRUE(holds("1:" + std::to_string(std::lround(x)) + " "));
  }
}

TEST_F(MonitorOfOneTopic, HasTheBoxesOfTheFormerPublisherOrTheNewOne) {
  start();
  say({cube("map", 0, 1.0)});
  ASSERT_TRUE(holds("0:1 "));
  std::atomic<bool> done{false};
  std::atomic<int> empty{0};
  std::thread watcher([&] {
    while (!done) {
      empty += monitor_->watchedScene()->scene.size() == 0 ? 1 : 0;
    }
  });
  for (int id = 1; id <= 50; ++id) {
    talker_.reset();  // else it is the same publisher for roscpp
    talker_ = std::make_unique<ArrayTalker>(topic_);
    EXPECT_TRUE(talker_->isHeard());
    say({cube("map", id, 1.0)});
    EXPECT_TRUE(holds(std::to_string(id) + ":1 "));
  }
  done = true;
  watcher.join();
  EXPECT_EQ(empty, 0);
}

TEST_F(MonitorOfOneTopic, NamesATypeThatItDoesNotKnowAndHearsTheNextPublisher) {
  listen();
  {
    Talker<std_msgs::String> talker(topic_);
    ASSERT_TRUE(talker.isHeard());
    talker.say(std_msgs::String());
    ASSERT_TRUE(eventually([&] { return monitor_->statistics().unknown_type_messages == 1; }));
    expectReason({topic_, "std_msgs/String", "visualization_msgs/MarkerArray"});
  }
  ArrayTalker talker(topic_);
  ASSERT_TRUE(talker.isHeard()) << "the subscription must not stay pinned to the first type";
  talker.say(array({cube("map", 1, 1.0)}));
  EXPECT_TRUE(holds("1:1 "));
  EXPECT_TRUE(completenessOf(*monitor_).complete);
}

TEST_F(MonitorOfOneTopic, IsIncompleteWhileAPublisherOfAnotherTypeCannotBeHeard) {
  start();
  say({cube("map", 1, 1.0)});
  ASSERT_TRUE(becomes(true));
  // This process may not advertise a second type itself. The master tells only the type of whoever
  // came last, here that of the one that is heard.
  const Address second;
  const Address third;
  tellMaster("registerPublisher", {"/second", topic_, "std_msgs/String", second.name});
  ASSERT_TRUE(becomes(false));
  expectReason({"std_msgs/String"});
  tellMaster("registerPublisher", {"/third", topic_, "visualization_msgs/MarkerArray", third.name});
  EXPECT_TRUE(eventually([&] {
    return completenessOf(*monitor_).reason.find("2 of the publishers of topic " + topic_) == 0;
  })) << completenessOf(*monitor_).reason;
  tellMaster("unregisterPublisher", {"/second", topic_, second.name});
  tellMaster("unregisterPublisher", {"/third", topic_, third.name});
  EXPECT_TRUE(becomes(true));
  EXPECT_EQ(contents(*monitor_->currentScene()), "1:1 ") << "of the publisher that is heard";
}

TEST_F(MonitorOfOneTopic, RefusesMalformedMessagesWhole) {
  listen();
  Talker<RawMarkerArray> talker(topic_);
  ASSERT_TRUE(talker.isHeard());
  const std::vector<std::uint8_t> good = RawMarkerArray::of(array({cube("map", 1, 1.0)})).bytes;
  RawMarkerArray claims;
  claims.bytes = {0x00, 0x28, 0x6b, 0xee};  // 4,000,000,000 markers
  RawMarkerArray cut;
  cut.bytes.assign(good.begin(), good.end() - 1);
  RawMarkerArray empty;
  std::uint64_t refused = 0;
  for (const RawMarkerArray& bad : {claims, cut, empty}) {
    talker.say(bad);
    ++refused;
    ASSERT_TRUE(eventually([&] { return monitor_->statistics().malformed_messages == refused; }));
    expectReason({topic_ + " was refused"});
  }
  EXPECT_EQ(monitor_->statistics().boxes, 0U);
  talker.say(RawMarkerArray::of(array({cube("map", 1, 1.0)})));
  EXPECT_TRUE(holds("1:1 "));
  EXPECT_TRUE(completenessOf(*monitor_).complete);
}

TEST_F(MonitorOfOneTopic, RefusesMessagesWithTooManyBoxesWhole) {
  parameters_.max_boxes_per_message = 2;
  start();
  say({cube("map", 1, 1.0), cube("map", 2, 2.0)});
  ASSERT_TRUE(hasBoxes(*monitor_, 2));
  say({cube("map", 3, 1.0), cube("map", 4, 2.0), cube("map", 5, 3.0)});
  ASSERT_TRUE(becomes(false));
  EXPECT_EQ(contents(*monitor_->currentScene()), "1:1 2:2 ");
}

TEST(SceneMonitor, DiesAtAnyMoment) {
  ArrayTalker talker("dying");
  Talker<tf2_msgs::TFMessage> tf("/tf");
  std::atomic<bool> stop{false};
  std::thread chatter([&] {
    for (int n = 0; !stop; ++n) {
      talker.say(array({cube("map", n % 50, 1.0), cube("nowhere", 60 + n % 50, 1.0)}));
      tf.say(transform("map", "dying_frame", ros::Time(10 + n, 0), 1.0));
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
  });
  for (int round = 0; round < 12; ++round) {
    SceneMonitor monitor(ros::NodeHandle(), listenTo({"dying"}));
    monitor.setChangedCallback([&monitor] { monitor.currentScene(); });
    if (round % 3 != 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(7 * round));
    }
    if (round % 3 == 2) {
      EXPECT_TRUE(eventually([&] { return monitor.scene()->scene.size() > 0; }));
    }
  }
  stop = true;
  chatter.join();
}

}  // namespace
}  // namespace box_query

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_scene_monitor_publishers");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
