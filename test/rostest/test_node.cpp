// SPDX-License-Identifier: BSD-3-Clause
// How the node starts and stops. BQ_NODE is its path.
#include "rostest/long_batch.h"
#include "scene/parallel.h"

#include <box_query/CastRays.h>
#include <box_query/GetScene.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/duration.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/param.h>
#include <ros/service.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <visualization_msgs/Marker.h>

namespace {

struct Ending {
  int exit_code = -1;  // -1: ended by a signal
  std::string output;
};

/// A node process whose output is read, with a bound on how long it may take to end.
class Process {
 public:
  explicit Process(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), BQ_NODE);
    std::vector<char*> argv;
    for (std::string& argument : arguments) {
      argv.push_back(argument.data());
    }
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, fileno(output_), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(output_), STDERR_FILENO);
    EXPECT_EQ(posix_spawn(&pid_, BQ_NODE, &actions, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
  }
  ~Process() {
    if (!ended_) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    std::fclose(output_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const { kill(pid_, number); }

  /// [s] of processor time that it has used.
  double processorTime() const {
    std::ifstream stat("/proc/" + std::to_string(pid_) + "/stat");
    std::string field;
    double ticks = 0;
    for (int i = 1; i <= 15 && stat >> field; ++i) {  // 14: in user mode, 15: in the system
      ticks += i >= 14 ? std::stod(field) : 0;
    }
    return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
  }

  /// Threads that it has, once none has come or gone for 0.2 s.
  std::ptrdiff_t threads() const {
    std::ptrdiff_t threads = 0;
    for (int unchanged = 0; unchanged < 10; ++unchanged) {
      const std::filesystem::directory_iterator tasks("/proc/" + std::to_string(pid_) + "/task");
      const std::ptrdiff_t now = std::distance(begin(tasks), end(tasks));
      unchanged = now == threads ? unchanged : 0;
      threads = now;
      ros::WallDuration(0.02).sleep();
    }
    return threads;
  }

  Ending wait() {
    Ending ending;
    int status = 0;
    for (int i = 0; i < 1000 && !ended_; ++i) {
      ended_ = waitpid(pid_, &status, WNOHANG) == pid_;
      if (!ended_) {
        ros::WallDuration(0.01).sleep();
      }
    }
    EXPECT_TRUE(ended_) << "still runs after 10 s";
    ending.exit_code = ended_ && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    std::rewind(output_);
    for (int c = std::fgetc(output_); c != EOF; c = std::fgetc(output_)) {
      ending.output.push_back(static_cast<char>(c));
    }
    return ending;
  }

 private:
  pid_t pid_ = 0;
  std::FILE* output_ = std::tmpfile();
  bool ended_ = false;
};

TEST(Node, StopsAtAWrongParameterAndSaysWhichAndWhy) {
  const Ending ending = Process({"__name:=wrong_rate", "_marker_rate:=1000"}).wait();
  EXPECT_EQ(ending.exit_code, 1);
  EXPECT_NE(
      ending.output.find("parameter /wrong_rate/marker_rate is 1000; it must be a number from "
                         "0.1 to 100 [Hz]"),
      std::string::npos)
      << ending.output;
}

TEST(Node, StopsAtAWrongTopicInAList) {
  ros::param::set("/wrong_topic/box_topics", std::vector<std::string>{"boxes", "/boxes"});
  const Ending ending = Process({"__name:=wrong_topic"}).wait();
  EXPECT_EQ(ending.exit_code, 1);
  EXPECT_NE(ending.output.find("/wrong_topic/box_topics[1]"), std::string::npos) << ending.output;
}

TEST(Node, WarnsOfAParameterThatItDoesNotKnowAndEndsCleanly) {
  for (const int number : {SIGINT, SIGTERM}) {
    const std::string name = "ends_by_" + std::to_string(number);
    Process process({"__name:=" + name, "_fixed_fram:=odom"});
    ASSERT_TRUE(ros::service::waitForService("/" + name + "/get_scene", ros::Duration(10)));
    process.signal(number);
    const Ending ending = process.wait();
    EXPECT_EQ(ending.exit_code, 0) << ending.output;
    EXPECT_NE(ending.output.find("/fixed_fram is not known"), std::string::npos) << ending.output;
    EXPECT_NE(ending.output.find("boxes of /boxes in frame map"), std::string::npos)
        << ending.output;
    EXPECT_NE(ending.output.find("/" + name + "/cast_ray"), std::string::npos) << ending.output;
    EXPECT_FALSE(ros::service::exists("/" + name + "/get_scene", false)) << "still registered";
  }
}

TEST(Node, EndsInTheMiddleOfABatch) {
  Process process({"__name:=busy", "boxes:=many_boxes"});
  ros::NodeHandle nh;
  ros::Publisher publisher = nh.advertise<visualization_msgs::Marker>("many_boxes", 1, true);
  const visualization_msgs::Marker boxes = box_query::test::boxesOfLongBatch();
  publisher.publish(boxes);
  ASSERT_TRUE(ros::service::waitForService("/busy/cast_rays", ros::Duration(10)));

  box_query::CastRays batch = box_query::test::longBatch();
  box_query::GetScene scene;
  for (int i = 0; i < 1000 && scene.response.poses.empty(); ++i) {
    ros::service::call("/busy/get_scene", scene);
    ros::WallDuration(0.01).sleep();
  }
  ASSERT_EQ(scene.response.poses.size(), boxes.points.size());
  const double before = process.processorTime();
  auto answered =
      std::async(std::launch::async, [&] { return ros::service::call("/busy/cast_rays", batch); });
  for (int i = 0; i < 1000 && process.processorTime() < before + 1.0; ++i) {
    ros::WallDuration(0.01).sleep();
  }
  ASSERT_GE(process.processorTime(), before + 1.0) << "the batch does not run";
  ASSERT_EQ(answered.wait_for(std::chrono::seconds(0)), std::future_status::timeout);
  process.signal(SIGINT);
  EXPECT_EQ(process.wait().exit_code, 0);
  // roscpp may close the connection before the answer is out.
  if (answered.get()) {
    EXPECT_FALSE(batch.response.success);
    EXPECT_EQ(batch.response.message, "the node shuts down: ask again when it is back");
  }
}

/// Threads that a node has before and after a batch.
struct Threads {
  std::ptrdiff_t before = 0;
  std::ptrdiff_t after = 0;
};

Threads threadsOf(const std::string& name, int service_threads, int batch_threads) {
  const Process process({"__name:=" + name, "_service_threads:=" + std::to_string(service_threads),
                         "_batch_threads:=" + std::to_string(batch_threads)});
  EXPECT_TRUE(ros::service::waitForService("/" + name + "/cast_rays", ros::Duration(10)));
  box_query::CastRays few = box_query::test::longBatch();
  few.request.directions.resize(1);
  box_query::CastRays many = box_query::test::longBatch();
  Threads threads;
  EXPECT_TRUE(ros::service::call("/" + name + "/cast_rays", few));
  threads.before = process.threads();
  EXPECT_TRUE(ros::service::call("/" + name + "/cast_rays", many));
  threads.after = process.threads();
  return threads;
}

TEST(Node, HasTheThreadsThatItIsTold) {
  const Threads one = threadsOf("one_thread", 1, 1);
  EXPECT_EQ(one.after, one.before) << "a batch needs no other";
  const Threads more = threadsOf("more_threads", 4, 2);
  EXPECT_EQ(more.before, one.before + 3);
  if (box_query::defaultThreads() > 1) {  // cores that this process may use, and so the node's
    EXPECT_GT(more.after, more.before) << "a batch has two";
  }
}

TEST(Node, IsLaunchedWithWhatIsGivenAndNothingElse) {
  box_query::GetScene scene;
  ASSERT_TRUE(ros::service::waitForService("/launched/get_scene", ros::Duration(20)));
  bool answered = false;
  for (int attempt = 0; attempt < 5 && !answered; ++attempt) {
    answered = ros::service::call("/launched/get_scene", scene);
  }
  ASSERT_TRUE(answered);
  EXPECT_EQ(scene.response.header.frame_id, "odom");
  EXPECT_NE(scene.response.reason.find("/boxes"), std::string::npos) << scene.response.reason;
  EXPECT_NE(scene.response.reason.find("/carts"), std::string::npos) << scene.response.reason;
  std::vector<std::string> names;
  ASSERT_TRUE(ros::param::getParamNames(names));
  std::set<std::string> set;
  for (const std::string& name : names) {
    if (name.rfind("/launched/", 0) == 0) {
      set.insert(name);
    }
  }
  EXPECT_EQ(set, (std::set<std::string>{"/launched/box_topics", "/launched/fixed_frame"}));
}

TEST(Node, PrintsItsParameters) {
  const Ending ending = Process({"--help"}).wait();
  EXPECT_EQ(ending.exit_code, 0);
  EXPECT_NE(ending.output.find("`~marker_rate`"), std::string::npos) << ending.output;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_node");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
