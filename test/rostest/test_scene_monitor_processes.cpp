// SPDX-License-Identifier: BSD-3-Clause
// Publishers in processes of their own: they end, by force too, and come again, beside one another,
// with other types. Each of them is this program with arguments.
#include "rostest/monitor_fixture.h"

#include <csignal>
#include <string>
#include <vector>

#include <ros/init.h>
#include <spawn.h>
#include <std_msgs/String.h>
#include <sys/wait.h>
#include <unistd.h>

namespace box_query {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

/// Publishes boxes with these ids, all at x, on a latched topic.
class Speaker {
 public:
  Speaker(const std::string& topic, const std::string& name, const std::string& type, int x,
          const std::vector<int>& ids) {
    std::vector<std::string> arguments = {"/proc/self/exe", "--speak", topic, type,
                                          std::to_string(x)};
    for (const int id : ids) {
      arguments.push_back(std::to_string(id));
    }
    arguments.push_back("__name:=" + name);
    std::vector<char*> argv;
    for (std::string& argument : arguments) {
      argv.push_back(argument.data());
    }
    argv.push_back(nullptr);
    EXPECT_EQ(posix_spawn(&pid_, "/proc/self/exe", nullptr, nullptr, argv.data(), environ), 0);
  }
  ~Speaker() { end(SIGKILL); }
  Speaker(const Speaker&) = delete;
  Speaker& operator=(const Speaker&) = delete;

  void end(int signal) {
    if (pid_ > 0) {
      kill(pid_, signal);
      waitpid(pid_, nullptr, 0);
      pid_ = 0;
    }
  }

 private:
  pid_t pid_ = 0;
};

MarkerArray boxes(const std::vector<std::string>& ids, double x) {
  MarkerArray message;
  for (const std::string& id : ids) {
    message.markers.push_back(cube("map", std::stoi(id), x));
  }
  return message;
}

template <class Message>
void speakUntilTheEnd(const std::string& topic, const Message& message) {
  ros::NodeHandle node;
  const ros::Publisher publisher = node.advertise<Message>(topic, 1, true);
  publisher.publish(message);
  ros::spin();
}

/// --speak TOPIC TYPE X ID...
int speak(const std::vector<std::string>& arguments) {
  const std::string& topic = arguments.at(2);
  const std::string& type = arguments.at(3);
  const MarkerArray message =
      boxes({arguments.begin() + 5, arguments.end()}, std::stod(arguments.at(4)));
  if (type == "MarkerArray") {
    speakUntilTheEnd(topic, message);
  } else if (type == "Marker") {
    speakUntilTheEnd(topic, message.markers.at(0));
  } else {
    speakUntilTheEnd(topic, std_msgs::String());
  }
  return 0;
}

TEST_F(MonitorOfOneTopic, ForgetsWhatAPublisherSaidBeforeItsRestart) {
  listen();
  for (const int signal : {SIGINT, SIGKILL}) {
    for (int round = 1; round <= 2; ++round) {
      const std::vector<int> ids = round == 1 ? std::vector<int>{1, 2} : std::vector<int>{2};
      Speaker speaker(topic_, "restarted", "MarkerArray", round, ids);
      ASSERT_TRUE(holds(round == 1 ? "1:1 2:1 " : "2:2 "))
          << "by signal " << signal << ": " << contents(*monitor_->currentScene());
      speaker.end(signal);
      EXPECT_EQ(monitor_->currentScene()->scene.size(), ids.size())
          << "boxes stay until somebody says more";
    }
  }
  EXPECT_EQ(monitor_->statistics().dropped_boxes, 2U);
}

TEST_F(MonitorOfOneTopic, ForgetsNothingWhileAnotherPublisherIsThere) {
  listen();
  Speaker stays(topic_, "stays", "MarkerArray", 1, {1});
  ASSERT_TRUE(holds("1:1 "));
  Speaker goes(topic_, "goes", "MarkerArray", 2, {2});
  ASSERT_TRUE(holds("1:1 2:2 "));
  goes.end(SIGINT);
  Speaker comes(topic_, "comes", "MarkerArray", 3, {3});
  ASSERT_TRUE(holds("1:1 2:2 3:3 "));
  EXPECT_EQ(monitor_->statistics().dropped_boxes, 0U);
}

TEST_F(MonitorOfOneTopic, HearsAPublisherThatComesBackWithAnotherType) {
  listen();
  for (const int signal : {SIGINT, SIGKILL}) {
    Speaker before(topic_, "changed", "MarkerArray", 1, {1, 2});
    ASSERT_TRUE(holds("1:1 2:1 ")) << "by signal " << signal;
    before.end(signal);
    Speaker after(topic_, "changed", "Marker", 2, {2});
    ASSERT_TRUE(holds("2:2 ")) << "by signal " << signal << ": "
                               << completenessOf(*monitor_).reason;
    EXPECT_TRUE(becomes(true)) << completenessOf(*monitor_).reason;
    after.end(signal);
  }
}

TEST_F(MonitorOfOneTopic, NamesBothTypesOfATopicAndHearsTheSecondOnceTheFirstIsGone) {
  listen();
  Speaker first(topic_, "first", "MarkerArray", 1, {1});
  ASSERT_TRUE(holds("1:1 "));
  ASSERT_TRUE(becomes(true));
  Speaker second(topic_, "second", "Marker", 2, {2});
  ASSERT_TRUE(becomes(false));
  EXPECT_EQ(completenessOf(*monitor_).reason,
            "Topic " + topic_ +
                " has publishers of two types, visualization_msgs/MarkerArray and "
                "visualization_msgs/Marker: the latter cannot be heard; give each type a topic of "
                "its own.");
  EXPECT_EQ(contents(*monitor_->currentScene()), "1:1 ");
  first.end(SIGINT);
  ASSERT_TRUE(holds("2:2 ")) << completenessOf(*monitor_).reason;
  EXPECT_TRUE(becomes(true)) << completenessOf(*monitor_).reason;
}

TEST_F(MonitorOfOneTopic, HearsBoxesOnceAPublisherOfAnUnknownTypeIsGone) {
  listen();
  Speaker stranger(topic_, "stranger", "String", 0, {});
  ASSERT_TRUE(eventually([&] { return monitor_->statistics().unknown_type_messages == 1; }));
  Speaker boxes(topic_, "boxes", "MarkerArray", 1, {1});
  expectReason({topic_, "std_msgs/String"});
  stranger.end(SIGINT);
  ASSERT_TRUE(holds("1:1 ")) << completenessOf(*monitor_).reason;
  EXPECT_TRUE(becomes(true)) << completenessOf(*monitor_).reason;
}

}  // namespace
}  // namespace box_query

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_scene_monitor_processes");
  if (argc > 1 && std::string(argv[1]) == "--speak") {
    return box_query::speak({argv, argv + argc});
  }
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
