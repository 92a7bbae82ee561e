// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/node.h"
#include "benchmark/node_client.h"
#include "benchmark/speed.h"
#include "ros/conversions.h"

#include <box_query/CastRay.h>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <thread>

namespace box_query::benchmark {
namespace {

/// How many sets of boxes come in turns: each is the one before a little elsewhere.
constexpr std::size_t kSets = 4;

/// What is published, and what is right when it is known.
struct BoxSet {
  std::vector<Box> boxes;
  visualization_msgs::MarkerArray message;
  double range = 0.0;
};

/// Every set with the range of one ray, which is another one in each set.
struct Sets {
  std::array<BoxSet, kSets> sets;
  CastRayRequest request;
};

/// @throws std::runtime_error if no ray tells the sets apart.
Sets makeSets(std::size_t boxes) {
  Sets result;
  const SpeedScene known = makeWorkload("sparse", boxes, 10000, 7).scenes.front();
  for (std::size_t i = 0; i < kSets; ++i) {
    std::vector<OrientedBox> moved = known.boxes;
    for (OrientedBox& box : moved) {
      box.center.x() += 0.01 * static_cast<double>(i);
    }
    result.sets[i].message = markersOf(moved);
    result.sets[i].boxes.assign(moved.begin(), moved.end());
  }
  const std::array<Scene, kSets> scenes = {Scene(result.sets[0].boxes), Scene(result.sets[1].boxes),
                                           Scene(result.sets[2].boxes),
                                           Scene(result.sets[3].boxes)};
  for (const Ray& ray : known.rays) {
    std::map<double, std::size_t> ranges;
    for (std::size_t i = 0; i < kSets; ++i) {
      result.sets[i].range = scenes[i].cast(ray).range;
      ranges[result.sets[i].range] = i;
    }
    if (ranges.size() == kSets && ranges.rbegin()->first < kInf) {
      result.request.header.frame_id = kFrame;
      result.request.origin = toPoint(ray.origin);
      result.request.direction = toVector3(ray.direction);
      return result;
    }
  }
  throw std::runtime_error("no ray tells the sets of boxes apart");
}

/// One of the two that hear boxes.
class Listener {
 public:
  Listener(ros::NodeHandle& nh, const BoxesTopic& topic, const std::string& service)
      : topic_(topic), client_(connect<CastRay>(nh, service + "cast_ray")) {
    topic_.clear();
  }

  /// Publishes and asks until the answer is from the new scene. @return how long it took [us]
  double publish(const BoxSet& set, const ros::Time& stamp, const RawMarkerArray& message,
                 const CastRayRequest& request) {
    right_[stamp] = set.range;
    const auto start = WallClock::now();
    topic_.publish(message);
    for (;;) {
      CastRayResponse response;
      call<CastRay>(client_, request, response);
      const auto took = WallClock::now() - start;
      judge(response);
      if (response.scene_stamp == stamp) {
        right_.erase(right_.begin(), right_.find(stamp));
        return microseconds(took);
      }
      if (took > std::chrono::seconds(30)) {
        throw std::runtime_error("no answer of " + client_.getService() + " is from new boxes");
      }
    }
  }

  std::size_t asked() const { return asked_; }
  std::size_t wrong() const { return wrong_; }

 private:
  /// What comes before the first set is not judged.
  void judge(const CastRayResponse& response) {
    const auto right = right_.find(response.scene_stamp);
    if (right == right_.end() && !heard_) {
      return;
    }
    heard_ = true;
    ++asked_;
    wrong_ += right != right_.end() && response.range == right->second ? 0 : 1;
  }

  const BoxesTopic& topic_;
  ros::ServiceClient client_;
  std::map<ros::Time, double> right_;  ///< ranges by the stamp of the scene
  bool heard_ = false;
  std::size_t asked_ = 0;
  std::size_t wrong_ = 0;
};

/// What has to be done in any case, each time as long after the last as messages are.
class DecodeAndBuild {
 public:
  void time(const BoxSet& set, const RawMarkerArray& message) {
    RawMarkerArray raw = message;
    auto start = WallClock::now();
    visualization_msgs::MarkerArray decoded;
    ros::serialization::IStream stream(raw.bytes.data(),
                                       static_cast<std::uint32_t>(raw.bytes.size()));
    ros::serialization::deserialize(stream, decoded);
    decode_.push_back(microseconds(WallClock::now() - start));
    std::vector<Box> boxes = set.boxes;
    start = WallClock::now();
    const Scene scene(std::move(boxes));
    build_.push_back(microseconds(WallClock::now() - start));
  }

  double decode() const { return quantile(decode_, 0.5); }
  double build() const { return quantile(build_, 0.5); }

 private:
  std::vector<double> decode_;
  std::vector<double> build_;
};

BoxesRow::Times timesOf(const std::vector<double>& times) {
  return {quantile(times, 0.5), quantile(times, 0.95), quantile(times, 1.0)};
}

BoxesRow measure(std::size_t boxes, double rate, double seconds, NodeClient& client) {
  BoxesRow row;
  row.boxes = boxes;
  row.rate = rate;
  Sets sets = makeSets(boxes);
  DecodeAndBuild alone;
  Listener node(client.nh, client.node_boxes, kNode);
  Listener plain(client.nh, client.plain_boxes, kPlain);
  std::vector<double> node_times;
  std::vector<double> plain_times;
  const auto period =
      std::chrono::duration_cast<WallClock::duration>(std::chrono::duration<double>(1.0 / rate));
  const auto messages = static_cast<std::size_t>(seconds * rate) + kSets;
  auto next = WallClock::now();
  for (std::size_t i = 0; i < messages; ++i, next += period) {
    BoxSet& set = sets.sets[i % kSets];
    const ros::Time stamp = ros::Time::now();
    setStamps(stamp, set.message);
    const RawMarkerArray message = RawMarkerArray::of(set.message);
    row.late += i > 0 && WallClock::now() > next ? 1 : 0;
    std::this_thread::sleep_until(next);
    std::array<double, 2> times{};
    for (const std::size_t turn : {i % 2, 1 - i % 2}) {
      times[turn] = (turn == 0 ? node : plain).publish(set, stamp, message, sets.request);
    }
    alone.time(set, message);
    if (i >= kSets) {  // when all is warm
      node_times.push_back(times[0]);
      plain_times.push_back(times[1]);
    }
  }
  row.messages = node_times.size();
  row.decode = alone.decode();
  row.build = alone.build();
  row.node = timesOf(node_times);
  row.plain = timesOf(plain_times);
  row.asked = node.asked() + plain.asked();
  row.wrong = node.wrong() + plain.wrong();
  return row;
}

}  // namespace

void measureBoxes(NodeClient& client, const BoxesOptions& options,
                  const std::function<void(const BoxesRow&)>& print) {
  for (const std::size_t boxes : options.boxes) {
    for (const double rate : options.rates) {
      std::ostringstream name;
      name << "boxes " << boxes << ' ' << rate;
      if (std::regex_search(name.str(), options.only)) {
        print(measure(boxes, rate, options.seconds, client));
      }
    }
  }
}

}  // namespace box_query::benchmark
