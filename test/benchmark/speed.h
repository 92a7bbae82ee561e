// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How fast scenes answer, beside what a user would pick instead: the same questions in turns in
/// one run, wrong answers counted beside every time.
#pragma once

#include "benchmark/timing.h"

#include <box_query/counters.h>
#include <box_query/scene.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace box_query::benchmark {

/// Boxes, and rays to ask about them. Directions are of unit length.
struct SpeedScene {
  std::vector<OrientedBox> boxes;
  std::vector<Ray> rays;
};

/// Scenes of one kind that are timed together.
struct Workload {
  std::string name;
  std::vector<SpeedScene> scenes;
};

/// "sparse", "dense": boxes with half extents from 0.1 to 1.5 m, anyhow turned, in a cube of side
/// 10 or 4 cbrt(N) m. "clusters": in heaps. "needles": ten times as long as wide. "shelves":
/// upright ones on a grid, turned about z only.
Workload makeWorkload(const std::string& kind, std::size_t boxes, std::size_t rays,
                      std::uint64_t seed);
const std::vector<std::string>& workloadKinds();
/// Blocks of sixteen boxes that stay in cache. "pairs": each ray meets about half of them; "pairs
/// apart": rays that start outside go anywhere.
Workload pairWorkload(bool apart, std::size_t rays, std::uint64_t seed);
/// Every n-th of the recorded scenes in `directory`; empty if there are none.
Workload recordedScenes(const std::string& directory, std::size_t every, std::size_t rays);
/// The same, scenes of one file together until they have 130 boxes.
Workload mergedScenes(const std::string& directory, std::size_t every, std::size_t rays);

/// A question about a scene and a ray; kBuild: how long the scene takes to be made; kUpdate: to be
/// made from one where all boxes were a little elsewhere.
enum class Question {
  kClosest30,
  kClosest,
  kRounded30,
  kAny30,
  kAll30,
  kSegment,
  kWithin,
  kClearance,
  kBuild,
  kUpdate
};
constexpr Question kQuestions[] = {Question::kClosest30, Question::kClosest,   Question::kRounded30,
                                   Question::kAny30,     Question::kAll30,     Question::kSegment,
                                   Question::kWithin,    Question::kClearance, Question::kBuild,
                                   Question::kUpdate};
const char* nameOf(Question question);

/// How a question is asked: a ray a call; many rays a call on one thread; the same on one and on
/// two threads, by the clock on the wall.
enum class Mode { kSingle, kBatch, kThreads };
const char* nameOf(Mode mode);
constexpr Question kBatchQuestions[] = {Question::kClosest30, Question::kRounded30,
                                        Question::kAny30,     Question::kSegment,
                                        Question::kWithin,    Question::kClearance};
constexpr Question kThreadQuestions[] = {Question::kClosest30, Question::kClearance};

/// How far closest, any and all queries look [m], and the lengths of segments.
constexpr double kRange = 30.0;
constexpr double kSegmentLength = 10.0;
constexpr double kPathLength = 2.0;
/// How near a box may not be to a path [m].
constexpr double kPathRadius = 0.3;

inline Segment segmentAlong(const Ray& ray, double length) {
  return {ray.origin, ray.origin + length * ray.direction};
}

/// The box that a method finds, kNoBox for none; any box stands for a yes.
struct SpeedAnswer {
  std::size_t box = kNoBox;
  double value = 0.0;  ///< The range, the clearance or how many boxes, where it is asked for.
};

inline SpeedAnswer allOf(std::size_t count) {
  return {count > 0 ? 0 : kNoBox, static_cast<double>(count)};
}
inline std::uint64_t hashOf(const SpeedAnswer& answer) {
  return answer.box + static_cast<std::uint64_t>(answer.value * 1e6);
}

/// The way of those that have no call for many rays.
constexpr const char* kOneByOne = "one by one";

/// A method over the boxes of one scene. What it cannot be asked it says by canAnswer().
class SpeedMethod {
 public:
  virtual ~SpeedMethod() = default;
  virtual bool canAnswer(Question question) const = 0;
  virtual SpeedAnswer ask(Question question, const Ray& ray) const = 0;
  /// Asks about all rays, so that what is timed is one call, and returns a sum of the answers.
  virtual std::uint64_t pass(Question question, const std::vector<Ray>& rays) const = 0;

  virtual bool canUpdate() const { return false; }
  /// Takes the same boxes elsewhere, and forgets about it. Returns a sum.
  virtual std::uint64_t update(const std::vector<OrientedBox>& /*moved*/) const { return 0; }

  /// Ways to ask about many rays in one call that are worth a comparison.
  virtual std::vector<std::string> batchWays(Question /*question*/) const { return {}; }
  /// @param answers as many as rays
  virtual void askEach(Question question, const std::vector<Ray>& rays, std::size_t /*way*/,
                       std::vector<SpeedAnswer>& answers) const {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      answers[i] = ask(question, rays[i]);
    }
  }
};

/// The loop of pass(), for each method compiled with its own ask().
template <typename Method>
std::uint64_t passOf(const Method& method, Question question, const std::vector<Ray>& rays) {
  std::uint64_t sum = 0;
  for (const Ray& ray : rays) {
    sum = 31 * sum + hashOf(method.Method::ask(question, ray));
  }
  return sum;
}

struct SpeedMethodKind {
  std::string name;
  std::function<std::unique_ptr<SpeedMethod>(const std::vector<OrientedBox>&)> make;
  bool is_built = true;  ///< Whether there is something to build.
  /// Of a scene: with more it takes so long that it tells nothing that it did not tell before.
  std::size_t most_boxes = std::numeric_limits<std::size_t>::max();
};

/// box_query first, then a plain scan, then the peers that were found.
std::vector<SpeedMethodKind> speedMethods();
/// box_query first, then what goes from box to box.
std::vector<SpeedMethodKind> pairMethods();
/// Of the peers, those that were not found and what is known of those that were, a line each.
std::vector<std::string> peerNotes();

/// One line of the table.
struct SpeedRow {
  std::string workload;
  std::size_t boxes;  ///< in the mean
  Question question;
  Mode mode;
  std::string method;
  Timing
      timing;  ///< Ratios: to box_query, of kThreads on two threads. Of kBuild and kUpdate, a box.
  /// Answers that were compared with exact ones.
  std::size_t asked = 0;
  std::size_t hits = 0;
  /// Those that are wrong even for boxes that differ by a nanometre; of box_query wrong ones at
  /// all.
  std::size_t wrong = 0;
  /// Of box_query, one ray a call: what these answers took.
  QueryCounters work = {};
};

struct SpeedOptions {
  int rounds = 15;           ///< Turns of each method on the clock.
  std::size_t sample = 500;  ///< Rays whose answers are compared, fewer where boxes are very many.
  bool threads = true;       ///< Whether to measure Mode::kThreads.
};

std::vector<SpeedRow> measureSpeed(const Workload& workload, const SpeedOptions& options,
                                   const std::vector<SpeedMethodKind>& methods = speedMethods());

}  // namespace box_query::benchmark
