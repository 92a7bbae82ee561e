// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <climits>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sys/wait.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>
#include <visualization_msgs/MarkerArray.h>

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

/// Collects messages of a topic until `done`, for at most 20 s.
template <typename Message, typename Done>
std::vector<Message> receive(const std::string& topic, Done done) {
  ros::NodeHandle nh;
  std::vector<Message> messages;
  const ros::Subscriber subscriber = nh.subscribe<Message>(
      topic, 100, [&](const boost::shared_ptr<const Message>& m) { messages.push_back(*m); });
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(20.0);
  while (ros::ok() && !done(messages) && ros::WallTime::now() < end) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
  }
  EXPECT_TRUE(done(messages)) << "not enough messages on " << topic;
  return messages;
}

std::vector<MarkerArray> receiveBoxes(const std::string& topic, std::size_t count) {
  return receive<MarkerArray>(
      topic, [&](const std::vector<MarkerArray>& messages) { return messages.size() >= count; });
}

/// "ns/id text" of a box that is there, "-ns/id" of one that is deleted.
std::vector<std::string> describe(const MarkerArray& message) {
  std::vector<std::string> lines;
  for (const Marker& marker : message.markers) {
    const std::string key = marker.ns + "/" + std::to_string(marker.id);
    lines.push_back(marker.action == Marker::DELETE ? "-" + key : key + " " + marker.text);
  }
  return lines;
}

using Lines = std::vector<std::string>;

TEST(PublishBoxes, AStillSceneIsLatchedInFullDoubles) {
  const auto messages = receiveBoxes("still_boxes", 1);
  ASSERT_EQ(messages.size(), 1U);
  ASSERT_EQ(describe(messages[0]), (Lines{"rack/0 shelf", "rack/1 post", "pallet/0 post"}));
  const Marker& shelf = messages[0].markers[0];
  EXPECT_EQ(shelf.header.frame_id, "camera");
  EXPECT_EQ(shelf.type, Marker::CUBE);
  EXPECT_EQ(shelf.action, Marker::ADD);
  EXPECT_EQ(shelf.pose.position.x, 0.1);
  EXPECT_EQ(shelf.pose.position.y, -2.0);
  EXPECT_EQ(shelf.pose.position.z, 1e-300);
  EXPECT_EQ(shelf.pose.orientation.z, 0.6);
  EXPECT_EQ(shelf.pose.orientation.w, 0.8);
  EXPECT_EQ(shelf.scale.x, 1.5);
  EXPECT_EQ(shelf.scale.y, 0.0);
  EXPECT_EQ(shelf.scale.z, 3.0);
  EXPECT_GT(shelf.color.a, 0.0F);
}

TEST(PublishBoxes, ForRvizTheSameIsPublishedWithoutLabels) {
  const auto labelled = receiveBoxes("still_boxes", 1);
  const auto markers = receiveBoxes("still/markers", 1);
  ASSERT_EQ(describe(markers[0]), (Lines{"rack/0 ", "rack/1 ", "pallet/0 "}));
  for (std::size_t i = 0; i < 3; ++i) {
    Marker marker = markers[0].markers[i];
    marker.text = labelled[0].markers[i].text;
    EXPECT_EQ(marker, labelled[0].markers[i]);
  }
}

TEST(PublishBoxes, ATransformToTheFrameOfTheBoxesIsPublished) {
  const auto messages = receive<tf2_msgs::TFMessage>(
      "/tf_static", [](const std::vector<tf2_msgs::TFMessage>& m) { return !m.empty(); });
  ASSERT_FALSE(messages.empty());
  ASSERT_EQ(messages[0].transforms.size(), 1U);
  const auto& transform = messages[0].transforms[0];
  EXPECT_EQ(transform.header.frame_id, "base");
  EXPECT_EQ(transform.child_frame_id, "camera");
  EXPECT_EQ(transform.transform.translation.z, 3.5);
  EXPECT_EQ(transform.transform.rotation.z, 0.6);
}

TEST(PublishBoxes, ASequenceLoopsKeepsItsIdsAndDeletesWhatVanishes) {
  const auto messages = receiveBoxes("moving_boxes", 8);
  // What follows each frame in the loop of three.
  const std::vector<Lines> frames = {{"vehicle/0 cart", "vehicle/1 van"},
                                     {"vehicle/1 van", "vehicle/2 bus", "-vehicle/0"},
                                     {"vehicle/0 cart", "-vehicle/1", "-vehicle/2"}};
  std::size_t frame = 0;
  while (frame < frames.size() && describe(messages[0]) != frames[frame]) {
    ++frame;
  }
  ASSERT_LT(frame, frames.size());
  for (const MarkerArray& message : messages) {
    EXPECT_EQ(describe(message), frames[frame]);
    frame = (frame + 1) % frames.size();
  }
}

TEST(PublishBoxes, WithoutLoopingTheLastFrameStays) {
  const auto messages = receive<MarkerArray>("once_boxes", [](const auto& received) {
    return !received.empty() && received.back().markers[0].pose.position.x == 2.0;
  });
  EXPECT_EQ(describe(messages.back()), (Lines{"vehicle/0 cart", "-vehicle/1", "-vehicle/2"}));
}

TEST(PublishBoxes, AStampChoosesOneFrame) {
  const auto messages = receiveBoxes("one_stamp_boxes", 1);
  EXPECT_EQ(describe(messages[0]), (Lines{"vehicle/0 van", "vehicle/1 bus"}));
}

/// Runs publish_boxes, which lies beside this program: what it prints, and its exit code.
std::pair<std::string, int> run(const std::string& arguments) {
  std::array<char, PATH_MAX> path{};
  EXPECT_GT(readlink("/proc/self/exe", path.data(), path.size() - 1), 0);
  const std::string self = path.data();
  const std::string command = "timeout 20 '" + self.substr(0, self.rfind('/')) +
                              "/publish_boxes' __name:=refused " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::string output;
  for (int c = fgetc(pipe); c != EOF; c = fgetc(pipe)) {
    output += static_cast<char>(c);
  }
  return {output, WEXITSTATUS(pclose(pipe))};
}

TEST(PublishBoxes, BadArgumentsAreRefusedWithASentence) {
  ros::NodeHandle nh;
  std::string file;
  ASSERT_TRUE(nh.getParam("/still/file", file));
  file = "'_file:=" + file + "' ";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "set parameter /refused/file to the path of a CSV file"},
      {"_file:=/no/such.csv", "/no/such.csv: the file cannot be opened"},
      {file, "has several scenes: set parameter /refused/scene to one of moving, still"},
      {file + "_scene:=b",
       "has no scene 'b': set parameter /refused/scene to one of moving, still"},
      {file + "_scene:=moving _stamp:=7", "has no stamp 7.000000 in scene 'moving'"},
      {file + "_scene:=moving _stamp:=soon", "parameter /refused/stamp must be a number"},
      {file + "_scene:=moving _rate:=0", "it must be 0.001 to 1000 [Hz]"},
      {file + "_scene:=still _tf_parent:=base",
       "parameter /refused/tf_pose must be 'x y z qx qy qz qw'"},
      {file + "_scene:=still _tf_parent:=base '_tf_pose:=0 0 0 0 0 0 0'", "a unit quaternion"},
      {file + "_scene:=still _tf_parent:=base '_tf_pose:=0 0 0 0 0 0 1 metres'",
       "/refused/tf_pose"},
      {file + "_scene:=still _tf_parent:=map '_tf_pose:=0 0 0 0 0 0 1'",
       "it needs boxes in one other frame, but they are in map"},
  };
  for (const auto& [arguments, sentence] : cases) {
    nh.deleteParam("/refused");
    const auto [output, code] = run(arguments);
    EXPECT_EQ(code, 1) << arguments;
    EXPECT_NE(output.find(sentence), std::string::npos) << arguments << "\n" << output;
  }
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "publish_boxes_tester");
  ros::NodeHandle nh;
  return RUN_ALL_TESTS();
}
