// SPDX-License-Identifier: BSD-3-Clause
#include "load/waits.h"

#include "load/clients.h"
#include "ros/conversions.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <random>
#include <stdexcept>
#include <thread>

#include <ros/publisher.h>

namespace box_query::load {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kCastRay = 0;
constexpr std::size_t kCastRays = 1;
constexpr std::chrono::seconds kQuiet(2);
constexpr std::chrono::seconds kPatience(60);

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Asks for one ray again and again.
class Asker {
 public:
  /// The first look at where the pile is, or is not.
  void askOnce() {
    CastRayRequest request;
    request.header.frame_id = kFixedFrame;
    request.origin = toPoint({990.0, 0.0, 0.0});
    request.direction = toVector3({1.0, 0.0, 0.0});
    request.allow_incomplete = true;
    const Clock::time_point start = Clock::now();
    Bytes response;
    if (!caller_.call(kCastRay, bytesOf(request), response)) {
      throw std::runtime_error("a query was not answered");
    }
    longest_ms = std::max(longest_ms, millisecondsSince(start));
    answer = messageFrom<CastRayResponse>(response);
    oldest_ms = std::max(oldest_ms, 1e3 * answer.scene_age);
    ++queries;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  /// Forgets what was, and asks until then, or until it takes too long.
  template <class Done>
  void askUntil(const Done& done) {
    longest_ms = oldest_ms = 0.0;
    queries = 0;
    for (const Clock::time_point start = Clock::now(); queries == 0 || !done(); askOnce()) {
      if (Clock::now() - start > kPatience) {
        throw std::runtime_error("what was published, or asked, has not come to an end");
      }
    }
  }

  double longest_ms = 0.0;
  double oldest_ms = 0.0;
  std::size_t queries = 0;
  CastRayResponse answer;

 private:
  Caller caller_{true};
};

void askQuietly(Asker& asker) {
  const Clock::time_point end = Clock::now() + kQuiet;
  asker.askUntil([end] { return Clock::now() >= end; });
}

Bytes batchOf(std::uint32_t rays) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> sideways(-1.0, 1.0);
  CastRaysRequest request;
  request.header.frame_id = kFixedFrame;
  request.allow_incomplete = true;
  request.origins.push_back(toPoint({0.0, 0.0, 2.0}));
  for (std::uint32_t i = 0; i < rays; ++i) {
    request.directions.push_back(
        toVector3({sideways(random), sideways(random), 0.05 * sideways(random)}));
  }
  return bytesOf(request);
}

}  // namespace

QueriesBesideMessage askBesideMessage(std::uint32_t boxes) {
  ros::NodeHandle nh;
  const ros::Publisher publisher = advertise(nh, kPileTopic, rosType(Type::kCubes), 10);
  Asker asker;
  asker.askUntil([&publisher] { return publisher.getNumSubscribers() > 0; });
  QueriesBesideMessage result;
  askQuietly(asker);
  result.quiet_ms = asker.longest_ms;

  const Bytes pile = pileOf(boxes, ros::Time::now());
  const Clock::time_point start = Clock::now();
  publisher.publish(pile);
  asker.askUntil([&asker] { return asker.answer.hit; });
  result.taken_in_ms = millisecondsSince(start);
  result.longest_ms = asker.longest_ms;
  result.queries = asker.queries;

  publisher.publish(pileOf(0, ros::Time::now()));
  asker.askUntil([&asker] { return !asker.answer.hit; });
  return result;
}

MessagesBesideBatch askBesideBatch(std::uint32_t rays) {
  Asker asker;
  MessagesBesideBatch result;
  askQuietly(asker);
  result.quiet_ms = asker.oldest_ms;

  std::atomic<bool> answered{false};
  std::string problem;
  std::thread batch([&, request = batchOf(rays)] {
    Caller caller(true);
    const Clock::time_point start = Clock::now();
    Bytes response;
    if (!caller.call(kCastRays, request, response) || !readSaid(response).success) {
      problem = "a batch was not answered: " + readSaid(response).message;
    }
    result.batch_ms = millisecondsSince(start);
    answered = true;
  });
  asker.askUntil([&answered] { return answered.load(); });
  batch.join();
  if (!problem.empty()) {
    throw std::runtime_error(problem);
  }
  result.oldest_ms = asker.oldest_ms;
  result.queries = asker.queries;
  return result;
}

}  // namespace box_query::load
