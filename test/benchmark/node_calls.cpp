// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/node.h"
#include "benchmark/node_client.h"
#include "benchmark/node_questions.h"
#include "benchmark/speed.h"

#include <box_query/CastRay.h>

#include <algorithm>
#include <array>
#include <sstream>

namespace box_query::benchmark {
namespace {

/// Where there are so many queries, a call is a long one.
constexpr std::size_t kMany = 1000;

/// The turns of three rounds: each comes once after each of the three, itself too, since who came
/// before has filled the caches, and has its threads still awake.
constexpr std::array<std::size_t, 9> kOrder = {0, 0, 1, 0, 2, 1, 1, 2, 2};

/// Puts the boxes into the node, and returns when it answers from them.
void show(const std::vector<OrientedBox>& boxes, NodeClient& node) {
  node.node_boxes.clear();
  visualization_msgs::MarkerArray array = markersOf(boxes);
  const ros::Time stamp = ros::Time::now();
  setStamps(stamp, array);
  node.node_boxes.publish(RawMarkerArray::of(array));
  ros::ServiceClient client = connect<CastRay>(node.nh, kNode + std::string("cast_ray"));
  CastRayRequest request;
  request.header.frame_id = kFrame;
  request.direction.x = 1.0;
  CastRayResponse response;
  const auto deadline = WallClock::now() + std::chrono::seconds(30);
  do {
    if (WallClock::now() > deadline) {
      throw std::runtime_error("the boxes do not come to the node");
    }
    call<CastRay>(client, request, response);
  } while (response.scene_stamp != stamp || !response.complete);
}

/// One question, put to all three in turns.
template <class Service>
class Calls {
 public:
  Calls(ros::NodeHandle& nh, const BatchQuestion<Service>& question, CallRow& row)
      : nh_(nh), question_(question), row_(row) {}

  void measure(int connections, int rounds) {
    std::array<std::vector<double>, 4> medians;
    for (int connection = 0; connection < connections; ++connection) {
      const auto [node, empty, library] = connectAndMeasure(rounds);
      const double figures[] = {node, empty, library, node / (empty + library)};
      for (std::size_t i = 0; i < medians.size(); ++i) {
        medians[i].push_back(figures[i]);
      }
    }
    row_.node = spreadOf(medians[0]);
    row_.empty = spreadOf(medians[1]);
    row_.library = spreadOf(medians[2]);
    row_.ratio = spreadOf(medians[3]);
  }

 private:
  /// Over one connection to each: lower quartiles, since what other programs add is not the node's.
  std::array<double, 3> connectAndMeasure(int rounds) {
    ros::ServiceClient node = connect<Service>(nh_, kNode + question_.service);
    ros::ServiceClient empty = connect<Service>(nh_, kPlain + question_.service);
    askNode(node);
    compareBytes(node, empty);
    std::array<std::vector<double>, 3> times;
    for (int round = 0; round < rounds; round += 3) {
      for (const std::size_t contender : kOrder) {
        times[contender].push_back(contender == 0   ? askNode(node)
                                   : contender == 1 ? askEmpty(empty)
                                                    : askLibrary());
      }
    }
    return {quantile(times[0], 0.25), quantile(times[1], 0.25), quantile(times[2], 0.25)};
  }

  double askNode(ros::ServiceClient& client) {
    typename Service::Response response;
    const double took = call<Service>(client, question_.request, response);
    row_.asked += question_.queries;
    row_.wrong += question_.wrong(response);
    return took;
  }
  double askEmpty(ros::ServiceClient& client) {
    typename Service::Response response;
    return call<Service>(client, question_.request, response);
  }
  double askLibrary() {
    const auto start = WallClock::now();
    question_.ask();
    return microseconds(WallClock::now() - start);
  }

  /// @throws std::logic_error if what does nothing does not send as much: nothing would be compared
  void compareBytes(ros::ServiceClient& node, ros::ServiceClient& empty) {
    typename Service::Response from_node;
    typename Service::Response from_empty;
    call<Service>(node, question_.request, from_node);
    call<Service>(empty, question_.request, from_empty);
    const auto length = ros::serialization::serializationLength(from_node);
    if (length != ros::serialization::serializationLength(from_empty)) {
      throw std::logic_error("the empty service does not send what the node sends");
    }
    row_.bytes = length + ros::serialization::serializationLength(question_.request);
  }

  ros::NodeHandle& nh_;
  const BatchQuestion<Service>& question_;
  CallRow& row_;
};

std::string nameOf(const CallRow& row) {
  std::ostringstream name;
  name << row.service << ' ' << row.asks << ' ' << row.boxes << ' ' << row.queries << ' '
       << row.threads;
  return name.str();
}

/// Measures those questions that are wanted.
class Questioner {
 public:
  Questioner(ros::NodeHandle& nh, const CallOptions& options,
             const std::function<void(const CallRow&)>& print)
      : nh_(nh), options_(options), print_(print) {}

  template <class Service>
  void ask(std::vector<BatchQuestion<Service>> questions, std::size_t boxes) {
    for (BatchQuestion<Service>& question : questions) {
      CallRow row;
      row.service = question.service;
      row.asks = question.asks;
      row.boxes = boxes;
      row.queries = question.queries;
      row.threads = options_.threads;
      if (std::regex_search(nameOf(row), options_.only)) {
        question.request.header.seq = ++number_;  // a new one to the empty service
        const int rounds = question.queries < kMany ? options_.rounds : (options_.rounds + 3) / 4;
        Calls<Service>(nh_, question, row).measure(options_.connections, rounds);
        print_(row);
      }
    }
  }

 private:
  ros::NodeHandle& nh_;
  const CallOptions& options_;
  const std::function<void(const CallRow&)>& print_;
  std::uint32_t number_ = 0;
};

}  // namespace

void measureCalls(NodeClient& client, const CallOptions& options,
                  const std::function<void(const CallRow&)>& print) {
  Questioner questioner(client.nh, options, print);
  const std::size_t most = *std::max_element(options.queries.begin(), options.queries.end());
  for (const std::size_t boxes : options.boxes) {
    const SpeedScene known = makeWorkload("sparse", boxes, most, 7).scenes.front();
    show(known.boxes, client);
    const Scene scene({known.boxes.begin(), known.boxes.end()});
    for (const std::size_t queries : options.queries) {
      const std::vector<Ray> rays(known.rays.begin(),
                                  known.rays.begin() + static_cast<std::ptrdiff_t>(queries));
      questioner.ask(rayQuestions(scene, rays, options.threads), boxes);
      questioner.ask(segmentQuestions(scene, rays, options.threads), boxes);
    }
  }
}

}  // namespace box_query::benchmark
