// SPDX-License-Identifier: BSD-3-Clause
// Bounds against misuse: what a topic may have at once, and what a message may carry.
#include "ros/box_tracker.h"
#include "ros/whole_set.h"
#include "unit/source_fixture.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tf2/buffer_core.h>
#include <visualization_msgs/Marker.h>

namespace box_query {
namespace {

const BoxSource kSource{"test/Changes", "", nullptr};
const char* const kTooMany = "too many others of its topic";

BoxChange boxesOf(const std::string& ns, std::int64_t id, std::size_t boxes) {
  BoxChange change;
  change.ns = ns;
  change.id = id;
  change.frame = "map";
  for (std::size_t n = 0; n < boxes; ++n) {
    change.add(static_cast<std::int64_t>(n), Vector3::Zero(), Quaternion::Identity(),
               Vector3::Ones());
  }
  return change;
}
BoxChange badBoxOf(const std::string& ns, std::int64_t id) {
  BoxChange change = boxesOf(ns, id, 0);
  change.reject(Rejection::kNotFinite, 1, "its size", id);
  return change;
}
BoxChange allGone() {
  BoxChange change;
  change.kind = BoxChange::Kind::kClear;
  return change;
}

/// A topic that may have 4 boxes in 2 namespaces.
class Bounds : public testing::Test {
 protected:
  Bounds() : tracker_(parameters(), tf_) {}

  static Parameters parameters() {
    Parameters parameters;
    parameters.max_boxes_per_topic = 4;
    parameters.max_namespaces = 2;
    return parameters;
  }
  void say(BoxChanges changes, bool whole = false) {
    DecodedMessage message;
    message.changes = std::move(changes);
    message.whole = whole;
    tracker_.receive(0, &kSource, std::move(message), ros::Time(100));
  }
  std::size_t boxes() { return tracker_.draft().boxes.size(); }
  std::string reason() { return tracker_.draft().snapshot.completeness(ros::Time(100)).reason; }
  std::uint64_t rejected() {
    const auto found = tracker_.counts().rejections.find(kTooMany);
    return found == tracker_.counts().rejections.end() ? 0 : found->second;
  }

  tf2::BufferCore tf_;
  BoxTracker tracker_;
};

TEST_F(Bounds, OfBoxesRejectWhatGoesBeyondAndSaySo) {
  say({boxesOf("a", 1, 3), boxesOf("a", 2, 1)});
  EXPECT_EQ(reason(), "");
  say({boxesOf("a", 3, 2)});
  EXPECT_EQ(boxes(), 4U);
  EXPECT_EQ(rejected(), 2U);
  EXPECT_EQ(tracker_.counts().boxes, 6U);
  EXPECT_EQ(tracker_.counts().rejected_boxes, 2U);
  EXPECT_EQ(reason(),
            "box 0 of namespace 'a' was rejected: topic boxes would have more than 4 boxes or 2 "
            "namespaces; publish fewer, or raise ~max_boxes_per_topic or ~max_namespaces, and "
            "delete all of the topic.");
}

TEST_F(Bounds, OfNamespacesRejectWhatGoesBeyondAndSaySo) {
  say({boxesOf("a", 1, 1), boxesOf("b", 1, 1)});
  EXPECT_EQ(reason(), "");
  say({boxesOf("c", 1, 1)});
  EXPECT_EQ(boxes(), 2U);
  EXPECT_EQ(rejected(), 1U);
  EXPECT_NE(reason().find("box 0 of namespace 'c' was rejected"), std::string::npos) << reason();
}

TEST_F(Bounds, LetBoxesBeReplaced) {
  say({boxesOf("a", 1, 3), boxesOf("b", 2, 1)});
  for (const std::size_t boxes : {2U, 3U, 1U, 3U}) {
    say({boxesOf("a", 1, boxes)});
    EXPECT_EQ(reason(), "") << boxes;
  }
  say({boxesOf("a", 1, 4)});
  EXPECT_EQ(rejected(), 4U);
  EXPECT_EQ(boxes(), 4U) << "those that were there stay";
}

TEST_F(Bounds, CountBoxesThatWereDeletedNoMore) {
  say({boxesOf("a", 1, 4)});
  BoxChange gone = boxesOf("a", 1, 0);
  gone.kind = BoxChange::Kind::kRemove;
  say({gone, boxesOf("b", 1, 2), boxesOf("c", 1, 2)});
  EXPECT_EQ(reason(), "");
  EXPECT_EQ(boxes(), 4U);
}

TEST_F(Bounds, CountWhatWasRejectedAndWhatIsEmpty) {
  for (std::int64_t id = 0; id < 4; ++id) {
    say({id % 2 == 0 ? badBoxOf("a", id) : boxesOf("a", id, 0)});
  }
  EXPECT_EQ(rejected(), 0U);
  say({badBoxOf("a", 4)});
  EXPECT_EQ(rejected(), 1U) << "names alone take memory too";
}

TEST_F(Bounds, CountBoxesThatStayWhileTheirLastWordIsBad) {
  say({boxesOf("a", 1, 3)});
  say({badBoxOf("a", 1)});
  say({boxesOf("a", 2, 2)});
  EXPECT_EQ(rejected(), 2U);
  EXPECT_EQ(boxes(), 3U);
}

TEST_F(Bounds, CountBoxesThatWait) {
  BoxChange elsewhere = boxesOf("a", 1, 4);
  elsewhere.frame = "robot";
  say({elsewhere});
  say({boxesOf("a", 2, 1)});
  EXPECT_EQ(rejected(), 1U);
}

TEST_F(Bounds, AreForgottenOnlyWhenTheTopicIsCleared) {
  say({boxesOf("a", 1, 4)});
  say({boxesOf("a", 2, 1)});
  say({boxesOf("a", 1, 1)});
  EXPECT_NE(reason(), "") << "what was rejected is still not known";
  say({allGone()});
  EXPECT_EQ(reason(), "");
  say({boxesOf("a", 1, 4)});
  say({boxesOf("a", 2, 1)});
  say({boxesOf("a", 1, 4)}, true);
  EXPECT_EQ(reason(), "") << "a whole set says all";
  EXPECT_EQ(boxes(), 4U);
  say({boxesOf("a", 2, 1)});
  EXPECT_NE(reason(), "");
  tracker_.forgetBefore(0, tracker_.lastWord());
  EXPECT_EQ(reason(), "") << "new publishers begin anew";
}

TEST_F(Bounds, OfWhatWaitsMakeTheSceneIncompleteUntilTheTopicIsCleared) {
  const ros::Time now(100);
  const auto lose_and_say = [&](BoxChanges changes, bool whole) {
    tracker_.lose(0, 2, now);
    say(std::move(changes), whole);
  };
  say({boxesOf("a", 1, 1)});
  tracker_.lose(0, 0, now);
  EXPECT_EQ(reason(), "");
  lose_and_say({boxesOf("a", 1, 1)}, false);
  say({boxesOf("a", 1, 1)});
  EXPECT_EQ(reason(),
            "Messages on topic boxes were dropped: they came faster than they could be taken in; "
            "publish less, or raise ~max_backlog_memory, and delete all of the topic.");
  EXPECT_EQ(tracker_.counts().dropped_messages, 2U);
  EXPECT_EQ(tracker_.counts().messages, 3U);
  say({allGone(), boxesOf("a", 1, 1)});
  EXPECT_EQ(reason(), "");
  EXPECT_EQ(boxes(), 1U);
  lose_and_say({boxesOf("a", 1, 1)}, true);
  EXPECT_EQ(reason(), "") << "a whole set says all";
  lose_and_say({allGone()}, false);
  EXPECT_EQ(reason(), "");
  lose_and_say({boxesOf("a", 1, 1)}, false);
  EXPECT_NE(reason(), "");
  tracker_.forgetBefore(0, tracker_.lastWord());
  EXPECT_EQ(reason(), "") << "new publishers begin anew";
  EXPECT_EQ(tracker_.counts().dropped_messages, 8U);
}

/// Whether a list of `boxes` boxes is taken: the sentence if not.
std::string refusal(const Parameters& parameters, std::size_t boxes, std::size_t name_length,
                    double size) {
  visualization_msgs::Marker list;
  list.header.frame_id = "map";
  list.ns = std::string(name_length, 'n');
  list.type = visualization_msgs::Marker::CUBE_LIST;
  list.pose.orientation.w = 1.0;
  list.scale.x = list.scale.y = list.scale.z = size;
  list.points.resize(boxes);
  const test::Bytes bytes = test::wire(list);
  const DecodedMessage message = decodeMessage(test::sourceNamed("visualization_msgs/Marker"),
                                               bytes.data(), bytes.size(), Limits(parameters));
  return message.problem.empty() ? message.changes.at(0).problem() : message.problem;
}

TEST(BoundsOfAMessage, AreThoseOfTheParameters) {
  Parameters parameters;
  parameters.max_boxes_per_message = 3;
  parameters.max_name_length = 4;
  parameters.max_coordinate = 5.0;
  EXPECT_EQ(refusal(parameters, 3, 4, 5.0), "");
  for (const auto& [refused, name] :
       {std::pair{refusal(parameters, 4, 4, 5.0),
                  "more than 3 boxes; publish fewer or raise max_boxes_per_message"},
        std::pair{refusal(parameters, 3, 5, 5.0), "raise ~max_name_length"},
        std::pair{refusal(parameters, 3, 4, 5.5), "raise ~max_coordinate"}}) {
    EXPECT_NE(refused.find(name), std::string::npos) << refused;
  }
}

TEST(NearPlaces, HaveNoNaN) {
  EXPECT_TRUE(isNear(1e7, {1e7, -1e7, 0.0}));
  EXPECT_FALSE(isNear(1e7, {0.0, std::nextafter(1e7, 2e7), 0.0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vector3& place : {Vector3(nan, 0, 0), Vector3(0, nan, 0), Vector3(0, 0, nan)}) {
    EXPECT_FALSE(isNear(1e7, place));
  }
}

TEST_F(Bounds, AreNotForgottenWithFormerPublishersWhereTheNewOneGoesBeyond) {
  say({boxesOf("a", 1, 4)});
  const std::uint64_t before = tracker_.lastWord();
  say({boxesOf("b", 1, 1)});
  EXPECT_EQ(rejected(), 1U);
  EXPECT_EQ(boxes(), 4U);
  tracker_.forgetBefore(0, before);
  EXPECT_EQ(boxes(), 0U);
  EXPECT_NE(reason(), "") << "what the new one said is not known";
  tracker_.forgetBefore(0, tracker_.lastWord());
  EXPECT_EQ(reason(), "");
}

TEST_F(Bounds, RefuseAWholeSetThatGoesBeyond) {
  say({boxesOf("a", 0, 4)}, true);
  say({boxesOf("b", 0, 2), boxesOf("c", 0, 2)}, true);
  EXPECT_EQ(reason(), "") << "the set before does not count";
  EXPECT_EQ(boxes(), 4U);
  say({boxesOf("b", 0, 3), boxesOf("c", 0, 2)}, true);
  EXPECT_EQ(tracker_.counts().malformed_messages, 1U);
  EXPECT_NE(reason().find("was refused: it has more than 4 boxes or 2 namespaces"),
            std::string::npos)
      << reason();
  EXPECT_EQ(boxes(), 4U);
  say({boxesOf("a", 0, 1), boxesOf("b", 0, 1), boxesOf("c", 0, 1)}, true);
  EXPECT_EQ(tracker_.counts().malformed_messages, 2U);
}

}  // namespace
}  // namespace box_query
