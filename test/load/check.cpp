// SPDX-License-Identifier: BSD-3-Clause
#include "load/check.h"

#include "load/check_exact.h"
#include "load/rebuilt_scene.h"
#include "ros/answers.h"
#include "ros/box_filter.h"

#include <algorithm>
#include <numeric>
#include <thread>
#include <type_traits>

namespace box_query::load {
namespace {

/// [s] by which two readings of the clock, as doubles, may seem to be in the wrong order.
constexpr double kClockStep = 1e-6;

template <class Request>
struct ResponseOf;
template <>
struct ResponseOf<CastRayRequest> {
  using type = CastRayResponse;
};
template <>
struct ResponseOf<CastRaysRequest> {
  using type = CastRaysResponse;
};
template <>
struct ResponseOf<CheckSegmentRequest> {
  using type = CheckSegmentResponse;
};
template <>
struct ResponseOf<CheckSegmentsRequest> {
  using type = CheckSegmentsResponse;
};
template <>
struct ResponseOf<FindIntersectionsRequest> {
  using type = FindIntersectionsResponse;
};
template <>
struct ResponseOf<GetSceneRequest> {
  using type = GetSceneResponse;
};
template <class Request>
using ResponseTo = typename ResponseOf<Request>::type;

/// What tf says of the frame of a request.
FrameChange frameOf(const std_msgs::Header& header) {
  if (header.frame_id == kFixedFrame) {
    return FrameChange();
  }
  const Pose pose = poseAt(header.frame_id, tickAt(header.stamp));
  geometry_msgs::Transform transform;
  transform.translation = toVector3(pose.translation);
  transform.rotation = toQuaternion(pose.quaternion);
  return FrameChange(transform);
}

template <class Request>
ResponseTo<Request> expected(const Request& request, const Snapshot& snapshot) {
  Context context = {snapshot, snapshot.stamp, frameOf(request.header), Drawing()};
  ResponseTo<Request> response;
  answer(request, context, response);
  return response;
}
GetSceneResponse expected(const GetSceneRequest& request, const Snapshot& snapshot) {
  GetSceneResponse response;
  answer(request, snapshot, snapshot.stamp, response);
  return response;
}

bool isMoved(const GetSceneRequest& /*request*/) {
  return false;
}
template <class Request>
bool isMoved(const Request& request) {
  return request.header.frame_id != kFixedFrame;
}

/// Whether the stamp is as new as the question, so that its transform may not be there yet.
bool isNewest(const Request& question, Tick asked) {
  return std::visit(
      [asked](const auto& request) {
        if constexpr (std::is_same_v<std::decay_t<decltype(request)>, GetSceneRequest>) {
          return false;
        } else {
          return isMoved(request) && tickAt(request.header.stamp) == asked;
        }
      },
      question);
}

bool isMet(const CastRayResponse& response) {
  return response.hit;
}
bool isMet(const CastRaysResponse& response) {
  return std::count(response.hits.begin(), response.hits.end(), 1) > 0;
}
bool isMet(const CheckSegmentResponse& response) {
  return response.blocked;
}
bool isMet(const CheckSegmentsResponse& response) {
  return response.first_blocked >= 0;
}
bool isMet(const FindIntersectionsResponse& response) {
  return !response.t_enter.empty();
}
bool isMet(const GetSceneResponse& response) {
  return !response.poses.empty();
}

/// Checks the answers from some scenes.
class Checker {
 public:
  Checker(const std::map<std::uint64_t, SceneFacts>& scenes, std::size_t oracle_step)
      : scenes_(scenes), oracle_step_(oracle_step) {}

  void check(const Answer& answer) {
    try {
      checkWhole(answer);
    } catch (const ros::serialization::StreamOverrunException&) {
      complain(answer, "is cut short");
    }
  }

  Verdict verdict() { return std::move(verdict_); }

 private:
  void checkWhole(const Answer& answer) {
    if (answer.lost) {
      return;
    }
    const Said said = readSaid(answer.response);
    const Request question = questionOf(answer.seed, answer.asked);
    if (!said.success) {
      if (isNewest(question, answer.asked) && said.message.find("No transform") == 0) {
        verdict_.refused.push_back(said.message);
      } else {
        complain(answer, "is a refusal: " + said.message);
      }
      return;
    }
    const auto scene = scenes_.find(answer.scene_id);
    if (scene == scenes_.end()) {
      ++verdict_.unknown_scenes;
      return;
    }
    const Snapshot& snapshot = rebuilder_.rebuild(scene->first, scene->second);
    std::visit([&](const auto& request) { compare(answer, request, snapshot); }, question);
  }

  template <class Request>
  void compare(const Answer& answer, const Request& request, const Snapshot& snapshot) {
    const auto got = messageFrom<ResponseTo<Request>>(answer.response);
    auto right = expected(request, snapshot);
    right.success = true;
    right.message = unknownNames(BoxFilter(request), snapshot);
    right.scene_age = got.scene_age;
    if (bytesOf(right).data != answer.response.data) {
      return complain(answer, "is not what the library answers from this scene");
    }
    if (got.scene_age < snapshot.age(answer.start) - kClockStep ||
        got.scene_age > snapshot.age(answer.end) + kClockStep) {
      return complain(answer, "has a scene_age that is not that of its time");
    }
    if (count_++ % oracle_step_ == 0) {
      const std::string problem = differenceFromExact(request, got, snapshot);
      if (!problem.empty()) {
        return complain(answer, "is not the exact one: " + problem);
      }
      ++verdict_.by_oracle;
    }
    ++verdict_.right[answer.service];
    verdict_.ages.push_back(1e3 * got.scene_age);
    const bool met = isMet(got);
    verdict_.complete += met && got.complete ? 1 : 0;
    verdict_.moved += met && isMoved(request) ? 1 : 0;
  }

  void complain(const Answer& answer, const std::string& what) {
    verdict_.wrong.push_back(std::string("answer of ") + services()[answer.service].name +
                             " to question " + std::to_string(answer.seed) + " at tick " +
                             std::to_string(answer.asked) + ", scene " +
                             std::to_string(answer.scene_id) + ", " + what);
  }

  const std::map<std::uint64_t, SceneFacts>& scenes_;
  const std::size_t oracle_step_;
  std::size_t count_ = 0;
  SceneRebuilder rebuilder_;
  Verdict verdict_;
};

void add(const Verdict& more, Verdict& sum) {
  for (std::size_t service = 0; service < kServices; ++service) {
    sum.right[service] += more.right[service];
  }
  sum.complete += more.complete;
  sum.moved += more.moved;
  sum.by_oracle += more.by_oracle;
  sum.unknown_scenes += more.unknown_scenes;
  sum.ages.insert(sum.ages.end(), more.ages.begin(), more.ages.end());
  sum.wrong.insert(sum.wrong.end(), more.wrong.begin(), more.wrong.end());
  sum.refused.insert(sum.refused.end(), more.refused.begin(), more.refused.end());
}

}  // namespace

std::size_t Verdict::rights() const {
  return std::accumulate(right.begin(), right.end(), std::size_t{0});
}

Verdict check(const std::vector<Answer>& answers, const std::map<std::uint64_t, SceneFacts>& scenes,
              std::size_t oracle_step, unsigned threads) {
  // In the order of the scenes, of which each is rebuilt once, or twice where threads share it.
  std::vector<const Answer*> ordered;
  for (const Answer& answer : answers) {
    ordered.push_back(&answer);
  }
  std::sort(ordered.begin(), ordered.end(),
            [](const Answer* a, const Answer* b) { return a->scene_id < b->scene_id; });
  std::vector<Verdict> verdicts(threads);
  std::vector<std::thread> workers;
  for (unsigned part = 0; part < threads; ++part) {
    workers.emplace_back([&, part] {
      Checker checker(scenes, oracle_step);
      for (std::size_t i = part * ordered.size() / threads;
           i < (part + 1) * ordered.size() / threads; ++i) {
        checker.check(*ordered[i]);
      }
      verdicts[part] = checker.verdict();
    });
  }
  Verdict sum;
  for (unsigned part = 0; part < threads; ++part) {
    workers[part].join();
    add(verdicts[part], sum);
  }
  return sum;
}

}  // namespace box_query::load
