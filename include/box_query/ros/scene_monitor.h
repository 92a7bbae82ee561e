// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Boxes from topics, placed by tf, as a Scene: what a planner embeds and what the node puts its
/// services in front of.
#pragma once

#include <box_query/ros/parameters.h>
#include <box_query/scene.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>

namespace ros {
class NodeHandle;
}

namespace box_query {

/// Who a box is. Snapshots order their boxes by (topic, ns, id).
struct BoxName {
  std::string topic;  ///< resolved
  std::string ns;
  /// Of a CUBE, that of its marker. Box n of a CUBE_LIST has that of its marker + n * 2^32:
  /// distinct, and stable while the list keeps its order. Deleting the marker deletes all of them.
  std::int64_t id = 0;
  std::string label;  ///< not part of the identity; the text of a marker
};

/// What a snapshot knows of one of the topics.
struct TopicState {
  TopicParameters parameters;  ///< its topic is the resolved name
  bool heard = false;
  std::uint64_t messages = 0;  ///< that were understood, since start
  ros::Time last_message;      ///< ROS time at which the last one was received
  std::size_t rejected = 0;    ///< boxes of its last word that were rejected or never placed
  std::size_t waiting = 0;     ///< boxes that wait for their transform
  std::string
      problem;  ///< first of the rejections or missing transforms, as a sentence; unknown type

  /// Whether it was heard, and its last message came longer before `now` than its timeout.
  bool isStale(const ros::Time& now) const;
  /// What keeps the topic from being known at ROS time `now`, as sentences that say what to do;
  /// empty if nothing does.
  std::string missing(const ros::Time& now) const;
  /// [ns] of ROS time from when on it is, unless another message comes; the largest number: never.
  std::int64_t staleAt() const;
};

/// Whether answers from a snapshot may be trusted as a whole.
struct Completeness {
  bool complete = false;
  std::string reason;  ///< what is missing, and what to do; empty if complete
};

/// The boxes at one moment. Immutable; hold it as long as you need it.
struct Snapshot {
  std::uint64_t id = 0;  ///< grows from 1 with every change; 0 is never a snapshot
  /// Newest stamp among the messages of its boxes and deletions (a zero stamp counts as its time of
  /// receipt; what comes before a simulated clock has started is received when it starts).
  ros::Time stamp;
  std::string frame;               ///< fixed frame
  Scene scene;                     ///< box i of the scene ...
  std::vector<BoxName> names;      ///< ... has this name
  std::vector<ros::Time> stamps;   ///< ... and came with this stamp (of the message)
  std::vector<TopicState> topics;  ///< in the order of the parameter
  /// Boxes that are where they were, since the last word on them waits for its transform or was
  /// rejected; ascending.
  std::vector<std::size_t> outdated;
  /// Nobody publishes /clock any more: its time stands, and what grows stale cannot be told.
  bool clock_gone = false;

  /// At ROS time `now`: every required topic heard, none stale, no box waiting or rejected. At time
  /// 0, before a simulated clock has started, nothing is complete, nor once its publisher is gone.
  /// Where only some topics matter to a question, `matters` accepts their names: what the others
  /// lack does not count.
  Completeness completeness(
      const ros::Time& now,
      const std::function<bool(const std::string& topic)>& matters = nullptr) const;
  /// [s] from `stamp` to `now`; +inf if no message has been heard.
  double age(const ros::Time& now) const;
};

using SnapshotPtr = std::shared_ptr<const Snapshot>;

/// Counts since start. Nothing is dropped without one of them.
struct MonitorStatistics {
  std::uint64_t messages = 0;
  std::uint64_t malformed_messages = 0;  ///< lengths that do not fit, more boxes than allowed
  std::uint64_t unknown_type_messages = 0;
  std::uint64_t dropped_messages = 0;  ///< not among these: too many waited to be taken in
  std::uint64_t boxes = 0;             ///< boxes received (added or modified)
  std::uint64_t rejected_boxes =
      0;  ///< not finite, negative size, quaternion off unit length, empty frame
  std::map<std::string, std::uint64_t> rejections;  ///< the same, by reason
  std::uint64_t ignored_markers = 0;                ///< markers of a type that is no box
  std::uint64_t expired_boxes = 0;                  ///< lifetime over
  std::uint64_t dropped_boxes = 0;                  ///< their topic was stale, or was taken over
  std::uint64_t given_up_boxes = 0;                 ///< their transform never came
  std::uint64_t overflowed_boxes = 0;               ///< more waiting than allowed
  std::uint64_t builds = 0;                         ///< scenes built
  std::uint64_t refits = 0;                         ///< of these, with the nodes of the one before
  std::uint64_t avoided_builds = 0;                 ///< changes that no scene was built for
  std::uint64_t avoided_transforms = 0;             ///< boxes whose frame is the fixed frame
};

/// Subscribes to the topics of Parameters::box_topics and keeps a Scene of what they say.
///
/// Callbacks run on threads of its own: its owner needs not spin. All functions may be called from
/// any thread.
///
/// Boxes whose frame is the fixed frame are taken bit for bit; others are placed by tf at the stamp
/// of their message (0: the latest), those with frame_locked anew in every snapshot. One leading
/// slash of a frame is dropped, since tf2 refuses it. While what a topic says of a box is bad or
/// waits for its transform, the box stays where it was, and the scene is incomplete. What all
/// former publishers of a topic said is forgotten when new ones that took their place speak. If the
/// ROS clock goes back, all transforms are forgotten, and all boxes but those that have just come
/// with a stamp of the new time.
class SceneMonitor {
 public:
  /// Topics are resolved in the namespace of `nh`.
  SceneMonitor(const ros::NodeHandle& nh, const Parameters& parameters);
  ~SceneMonitor();
  SceneMonitor(const SceneMonitor&) = delete;
  SceneMonitor& operator=(const SceneMonitor&) = delete;

  /// The snapshot that was built last, never null: a few steps that take no lock, wait for nobody
  /// and build nothing, for a planner's own thread. Take one for all the questions of a plan, and
  /// keep it for as long as they are to fit together.
  ///
  /// As with currentScene(), boxes are built into new snapshots as they come for
  /// Parameters::build_ahead seconds after the last call. A call after a longer silence returns
  /// what there was before it.
  SnapshotPtr scene() const;

  /// The snapshot of all that has been received until now (lifetimes included), built first if need
  /// be.
  SnapshotPtr currentScene();

  /// The same for who must not wait for boxes, such as a service: while scenes are built ahead, a
  /// message that takes longer than 10 ms to take in and to build is not waited for, and the
  /// snapshot is one of before. After a longer silence it is currentScene().
  SnapshotPtr promptScene();

  /// The same as currentScene() for who only watches: no reason to build ahead, and not to be asked
  /// for by its id.
  SnapshotPtr watchedScene();

  /// One of the last snapshots that currentScene() or scene() handed out, as many as
  /// Parameters::kept_scenes and max_kept_boxes allow, or null.
  SnapshotPtr sceneById(std::uint64_t id) const;

  /// A topic's name in full, as snapshots have it, in the namespace and with the remappings of the
  /// node handle; one that is no name as it is.
  std::string resolveTopic(const std::string& topic) const;

  /// The snapshot that was the latest at ROS time `time`: of what had been received, and placed, by
  /// then. Its completeness() and age() at that time are what they were. Remembered are the last
  /// Parameters::history seconds, in at most max_past_scenes snapshots; none after the ROS clock
  /// went back. It is built first if need be; sceneById() has it from then on.
  /// @return an empty string, or a sentence that says which times there are.
  std::string sceneAt(const ros::Time& time, SnapshotPtr& scene);

  /// Pose of `source` in `target` at `stamp` (0: latest), waiting for it up to `timeout` seconds of
  /// wall time, whatever the ROS clock does. Equal frames need no tf.
  /// @return an empty string, or a sentence that says what was missing and what to do.
  std::string lookUpTransform(const std::string& target, const std::string& source,
                              const ros::Time& stamp, double timeout,
                              geometry_msgs::TransformStamped& transform) const;

  /// Calls `changed` from a thread of the monitor after the boxes have changed, at most once a
  /// change; it may call any other function of the monitor. Nothing is built ahead until it
  /// returns. Returns when a running call of the one before has ended, so that null takes leave
  /// safely.
  void setChangedCallback(std::function<void()> changed);

  MonitorStatistics statistics() const;
  const Parameters& parameters() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace box_query
