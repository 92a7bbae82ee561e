// SPDX-License-Identifier: BSD-3-Clause
// /diagnostics of the real node.
#include "rostest/server_fixture.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <string>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/init.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>

namespace box_query::test {
namespace {

using diagnostic_msgs::DiagnosticArray;
using diagnostic_msgs::DiagnosticStatus;

struct Status {
  int level = -1;  // -1: none has come
  std::string message;
  std::map<std::string, std::string> values;

  double number(const std::string& key) const {
    const auto found = values.find(key);
    return found == values.end() ? -1.0 : std::stod(found->second);
  }
};

class Reader {
 public:
  Reader()
      : subscriber_(ros::NodeHandle().subscribe<DiagnosticArray>(
            "/diagnostics", 100, [this](const DiagnosticArray::ConstPtr& m) { read(*m); })) {}

  /// The last one of the node that is called so.
  Status status(const std::string& name) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return last_["box_query: " + name];
  }
  /// Whether a status comes to have a level, and words in its message.
  bool becomes(const std::string& name, int level, const std::string& words) {
    return eventually([&] {
      const Status now = status(name);
      return now.level == level && now.message.find(words) != std::string::npos;
    });
  }
  bool counts(const std::string& name, const std::string& key, double value) {
    return eventually([&] { return status(name).number(key) == value; });
  }
  std::vector<ros::Time> stamps() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return stamps_;
  }

 private:
  void read(const DiagnosticArray& array) {
    const std::lock_guard<std::mutex> lock(mutex_);
    stamps_.push_back(array.header.stamp);
    for (const DiagnosticStatus& given : array.status) {
      Status status{given.level, given.message, {}};
      for (const diagnostic_msgs::KeyValue& value : given.values) {
        status.values[value.key] = value.value;
      }
      last_[given.name] = status;
    }
  }

  std::mutex mutex_;
  std::map<std::string, Status> last_;
  std::vector<ros::Time> stamps_;
  ros::Subscriber subscriber_;
};

// Tests run in this order, against one node.
TEST(Diagnostics, CostNothingWhileNobodyLooks) {
  ArrayTalker boxes("boxes");
  ASSERT_TRUE(boxes.isHeard());
  for (int n = 0; n < 60; ++n) {
    boxes.say(array({cube("map", 1, n)}));
    ros::WallDuration(1.0 / 30).sleep();
  }
  Reader reader;
  ASSERT_TRUE(reader.counts("work", "messages", 60));
  const double looks = static_cast<double>(reader.stamps().size());
  EXPECT_LE(reader.status("work").number("scenes built"), looks)
      << "nobody asked and nobody looked before";
  EXPECT_GE(reader.status("work").number("scenes not built"), 58);
  for (int n = 0; n < 60; ++n) {
    boxes.say(array({cube("map", 1, n)}));
    ros::WallDuration(1.0 / 30).sleep();
  }
  ASSERT_TRUE(reader.counts("work", "messages", 120));
  EXPECT_LE(reader.status("work").number("scenes built"),
            static_cast<double>(reader.stamps().size()))
      << "looking is no reason to build ahead";
  EXPECT_TRUE(reader.counts("scene", "boxes", 1));
}

TEST(Diagnostics, WarnForTheReasonThatAnswersGive) {
  Reader reader;
  ASSERT_TRUE(reader.becomes("scene", DiagnosticStatus::OK, "complete"));
  ASSERT_TRUE(reader.becomes("topic /walls", DiagnosticStatus::OK, "complete")) << "not required";

  ArrayTalker boxes("boxes");
  ArrayTalker walls("walls");
  ASSERT_TRUE(boxes.isHeard() && walls.isHeard());
  visualization_msgs::Marker bad = cube("map", 2, 0);
  bad.scale.x = -1;
  boxes.say(array({bad, cube("map", 3, 5)}));
  walls.say(array({cube("nowhere", 1, 5), cube("nowhere", 2, 5)}));
  ASSERT_TRUE(reader.becomes("scene", DiagnosticStatus::WARN, "a negative size"));
  ASSERT_TRUE(reader.becomes("scene", DiagnosticStatus::WARN, "nowhere"));
  EXPECT_EQ(reader.status("scene").message, scene().reason);
  EXPECT_EQ(reader.status("scene").number("boxes"), 2);
  EXPECT_EQ(reader.status("scene").number("boxes that wait for their transform"), 2);
  EXPECT_GE(reader.status("scene").number("age [s]"), 0);
  ASSERT_TRUE(reader.becomes("topic /boxes", DiagnosticStatus::WARN, "a negative size"));
  EXPECT_EQ(reader.status("topic /boxes").message.find("nowhere"), std::string::npos);
  EXPECT_EQ(reader.status("topic /boxes").number("boxes"), 2);
  EXPECT_EQ(reader.status("topic /boxes").number("boxes of its last word that were rejected"), 1);
  EXPECT_GE(reader.status("topic /boxes").number("age of its last message [s]"), 0);
  EXPECT_EQ(reader.status("topic /walls").number("boxes that wait for their transform"), 2);
  EXPECT_TRUE(reader.counts("work", "boxes rejected: a negative size", 1));

  boxes.say(array({withAction(cube("map", 0, 0), visualization_msgs::Marker::DELETEALL)}));
  walls.say(array({withAction(cube("map", 0, 0), visualization_msgs::Marker::DELETEALL)}));
  EXPECT_TRUE(reader.becomes("scene", DiagnosticStatus::OK, "complete"));
  EXPECT_TRUE(reader.counts("scene", "boxes", 0));
}

TEST(Diagnostics, CountWhatQueriesHadToDo) {
  Reader reader;
  ArrayTalker boxes("boxes");
  ASSERT_TRUE(boxes.isHeard());
  boxes.say(array({cube("map", 1, 5)}));
  ASSERT_TRUE(eventually([] { return scene().box_ids.size() == 1; }));
  ASSERT_TRUE(reader.becomes("work", DiagnosticStatus::OK, ""));
  const char* const what = "boxes compared in double";
  const double before = reader.status("work").number(what);
  CastRaysRequest batch;
  batch.header.frame_id = "map";
  batch.origins = {point(0, 0, 0)};
  batch.directions.assign(1000, vector(1, 0, 0));
  const auto response = call<CastRays>("cast_rays", batch);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(std::count(response.hits.begin(), response.hits.end(), 1), 1000);
  EXPECT_TRUE(eventually([&] { return reader.status("work").number(what) >= before + 1000; }));
  EXPECT_LE(reader.status("work").number(what), before + 1020) << "a few are cast again, to draw";
  EXPECT_EQ(reader.status("work").number("boxes rotated for, of these"), 0) << "none is turned";
  EXPECT_EQ(reader.status("work").number("decisions made exactly"), 0);
}

TEST(Diagnostics, SayHowOftenBoxesComeAndQueriesAreAsked) {
  Reader reader;
  ArrayTalker boxes("boxes");
  ASSERT_TRUE(boxes.isHeard());
  const double answered = scene().success ? reader.status("work").number("requests answered") : 0;
  CastRayRequest without_frame;
  EXPECT_TRUE(eventually([&] {
    boxes.say(array({cube("map", 1, 5), cube("map", 2, 5)}));
    cast(ray("map", point(0, 0, 0), vector(1, 0, 0)));
    cast(without_frame);
    const Status work = reader.status("work");
    return reader.stamps().size() > 2 &&
           reader.status("topic /boxes").number("messages [1/s]") > 0 &&
           work.number("boxes received [1/s]") > 0 && work.number("requests answered [1/s]") > 0 &&
           work.number("requests answered") > answered && work.number("requests refused") > 0 &&
           reader.status("topic /boxes").number("boxes") == 2;
  }));
  const std::vector<ros::Time> stamps = reader.stamps();
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    EXPECT_GE((stamps[i] - stamps[i - 1]).toSec(), 0.9);
  }
}

}  // namespace
}  // namespace box_query::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_diagnostics");
  ros::AsyncSpinner spinner(1);
  const ros::NodeHandle keeps_ros_alive;
  spinner.start();
  return RUN_ALL_TESTS();
}
